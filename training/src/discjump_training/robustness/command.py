"""The command."""

import json
import shlex
import shutil
from pathlib import Path

import click

from discjump.envs.tasks import TASKS
from discjump_training.cli import clean_errors
from discjump_training.courses import course_of
from discjump_training.files import write_atomically
from discjump_training.judge import Conditions, Judged, Keep, entrants, judge
from discjump_training.judge.pieces import Pieces
from discjump_training.robustness import table
from discjump_training.robustness.conditions import CONDITIONS


@click.command()
@click.argument("policies", nargs=-1, required=True, metavar="POLICY...")
@click.option("--task", type=click.Choice(list(TASKS)), required=True, help="What they play.")
@click.option("--episodes", type=click.IntRange(min=1), default=256, show_default=True, help="Of each row.")
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder of the tables.")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
def main(policies: tuple[str, ...], task: str, episodes: int, out: Path, threads: int | None) -> None:
    """Play held-out episodes of a task under conditions that POLICY was not trained in.

    POLICY is what `discjump evaluate` takes, groups of training seeds included. The same command goes on
    where it was broken off.
    """
    with clean_errors():
        course = course_of(task, None)
        who = entrants(policies, course, with_baselines=False)
        met = [one for one in CONDITIONS if task in one.tasks]
        played: dict[str, list[Judged]] = {}
        work = out / f".{task}"
        for index, condition in enumerate(met):
            click.echo(f"{index + 1} of {len(met)}: {condition.name}", err=True)
            conditions = Conditions(
                course, episodes, condition.options(course), noise=condition.noise, threads=threads
            )
            played[condition.name] = judge(who, conditions, Keep(Pieces(work / str(index), resume=True)))
        words = ["python", "-m", "discjump_training.robustness", *policies, "--task", task]
        words += ["--episodes", str(episodes), "--out", str(out)]
        told = table.as_json(course, episodes, played)
        text = table.markdown(told, shlex.join(words))
        out.mkdir(parents=True, exist_ok=True)
        write_atomically(out / f"{task}.json", (json.dumps(told, indent=1) + "\n").encode())
        write_atomically(out / f"{task}.md", text.encode())
        shutil.rmtree(work)
        click.echo(text, nl=False)
