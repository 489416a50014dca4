"""Reference scores of all tasks, from the results that are committed, in one table.

    python -m discjump_training.scores training/results

reads TASK/evaluation.json (of `discjump evaluate`) and, where they are there, TASK/plan.json (of `discjump
plan`) and TASK/runs/SEED/run.json (of `discjump train`), adds what an exhaustive search reaches where there
was one (`discjump_training.bounds`), and writes scores.json, which the cards of the tasks show, and
scores.md.
"""

import json
from pathlib import Path
from typing import Any

import click
import numpy as np

from discjump.envs.tasks import TASKS, Task
from discjump_training import intervals
from discjump_training.bounds import reachable
from discjump_training.cli import clean_errors
from discjump_training.courses import course_of
from discjump_training.errors import TrainingError
from discjump_training.files import write_atomically
from discjump_training.intervals import Estimate
from discjump_training.markdown import cell, table
from discjump_training.runs import PARTS, shares

#: Commands that the figures come from; `N` is each training seed.
COMMAND = "discjump evaluate ppo=runs/{name}-N,... --task {name} --planner training/results/{name}/plan.json"


def read(path: Path) -> dict[str, Any] | None:
    """A file of results; None where there is none.

    Raises:
        TrainingError: it is damaged.
    """
    if not path.is_file():
        return None
    try:
        loaded: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise TrainingError(f"{path}: expected JSON, got something else: {error}") from None
    return loaded


def rows(task: Task, folder: Path) -> list[list[str]]:
    """Policy, success, time, percent of the planner's: a row each, baselines first.

    Raises:
        TrainingError: a file is damaged.
    """
    made = read(folder / task.name / "evaluation.json")
    if made is None:
        return []
    found: list[list[str]] = []
    try:
        for one in made["policies"]:
            runs = len(one["members"])
            name = one["name"] if runs == 1 else f"{one['name']}, {runs} training seeds"
            success, seconds = (Estimate(**one[key]) for key in ("success", "seconds"))
            percent = one["percent_of_planner"]
            found.append(
                [
                    name,
                    f"{one['episodes']}",
                    cell(success, "%", 1),
                    cell(seconds, "s", 2),
                    "" if percent is None else f"{percent['value']:.1f}",
                ]
            )
        kinds = [one["kind"] for one in made["policies"]]
        found = [found[index] for index in sorted(range(len(found)), key=lambda i: kinds[i] != "baseline")]
        if (plan := read(folder / task.name / "plan.json")) is not None:
            success = intervals.proportion(np.array([one["success"] for one in plan["episodes"]], np.bool_))
            seconds = intervals.mean(np.array([one["seconds"] for one in plan["episodes"]]))
            count = len(plan["episodes"])
            found.append(["planner", f"{count}", cell(success, "%", 1), cell(seconds, "s", 2), "100"])
        if (searched := reachable.load(course_of(task.name, None))) is not None:
            share = intervals.proportion(searched.reached)
            found.append(["exhaustive search", f"{len(searched.reached)}", cell(share, "%", 1), "", ""])
    except (KeyError, TypeError, AttributeError) as error:
        raise TrainingError(
            f"{folder / task.name}: no results of this version: {type(error).__name__}: {error}"
        ) from None
    return found


def training(folder: Path) -> list[list[str]]:
    """Task, seeds, decisions, minutes, decisions/s and what the time went into: a row for each task.

    Raises:
        TrainingError: a file is damaged.
    """
    found = []
    for name in TASKS:
        told = [read(path) for path in sorted((folder / name / "runs").glob("*/run.json"))]
        runs = [one for one in told if one is not None]
        if not runs:
            continue
        try:
            minutes = [one["steps"] / one["steps_per_second"] / 60 for one in runs]
            found.append(
                [
                    name,
                    ", ".join(str(one["seed"]) for one in runs),
                    f"{np.mean([one['steps'] for one in runs]) / 1e6:.1f} M",
                    f"{np.median(minutes):.1f} ({min(minutes):.1f} to {max(minutes):.1f})",
                    f"{np.median([one['steps_per_second'] for one in runs]):,.0f}",
                    ", ".join(f"{share:.0%}" for share in shares(runs).values()),
                ]
            )
        except (KeyError, TypeError, ZeroDivisionError) as error:
            raise TrainingError(
                f"{folder / name}: no runs of this version: {type(error).__name__}: {error}"
            ) from None
    return found


TRAINING = ["task", "seeds", "decisions", "minutes (range)", "decisions/s", ", ".join(PARTS)]
"""Heading of `training`."""


def heading(task: Task) -> list[str]:
    """Of the columns."""
    return ["policy", "episodes", "success, %", f"time to {task.goal}, s", "of the planner's, %"]


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
def main(folder: Path) -> None:
    """Gather the results in FOLDER into scores.json and scores.md."""
    with clean_errors():
        gathered: dict[str, Any] = {}
        text = []
        for name, task in TASKS.items():
            if cells := rows(task, folder):
                course = course_of(name, None).name
                command = COMMAND.format(name=name)
                gathered[name] = {
                    "course": course,
                    "command": command,
                    "heading": heading(task),
                    "rows": cells,
                }
                text.append(f"`{task.id}`, `{course}`:\n\n{table(heading(task), cells)}")
        if not gathered:
            raise TrainingError(f"{folder}: expected results of `discjump evaluate` in TASK/evaluation.json")
        if trained := training(folder):
            text.append(f"Training:\n\n{table(TRAINING, trained)}")
        write_atomically(folder / "scores.json", (json.dumps(gathered, indent=1) + "\n").encode())
        write_atomically(folder / "scores.md", "\n".join(text).encode())
        click.echo("\n".join(text))


if __name__ == "__main__":
    main()
