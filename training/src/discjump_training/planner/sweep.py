"""Many settings of the planner on the same episodes, and one table.

    python -m discjump_training.planner.sweep SWEEP.toml --out FOLDER

SWEEP.toml names task, course, number of episodes and policies to compare with, and has a [[plan]] for each
row: fields of `Settings`, and `guides` and `values` as `plan` has them. What is planned once is kept in
`--work`.
"""

import json
import shlex
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from discjump_training import intervals
from discjump_training.cli import clean_errors
from discjump_training.courses import COURSES
from discjump_training.errors import TrainingError
from discjump_training.files import write_atomically
from discjump_training.intervals import Estimate
from discjump_training.judge import Conditions, entrants, judge
from discjump_training.markdown import cell, table
from discjump_training.planner import report
from discjump_training.planner.play import plan
from discjump_training.planner.settings import Settings
from discjump_training.policy import Floats


@dataclass(frozen=True)
class Sweep:
    """What is swept.

    Attributes:
        task, course, episodes: what all of them play.
        references: policies that play it too; the first is compared with.
        plans: keyword arguments of `plan` by name.
    """

    task: str
    course: str
    episodes: int
    references: list[str]
    plans: dict[str, dict[str, Any]]

    @classmethod
    def load(cls, path: Path) -> "Sweep":
        """From a file.

        Raises:
            TrainingError: if it cannot be read or has something else in it.
        """
        try:
            read = tomllib.loads(path.read_text(encoding="utf-8"))
            rows = read.pop("plan")
            plans = {row.pop("name"): _arguments(row) for row in rows}
            return cls(plans=plans, **read)
        except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError) as error:
            raise TrainingError(f"cannot read the sweep {path}: {error!r}") from error


def _arguments(row: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {key: row.pop(key) for key in ("guides", "values") if key in row}
    return {**found, "settings": Settings(**row)}


@click.command()
@click.argument("source", type=click.Path(exists=True, dir_okay=False, path_type=Path), metavar="SWEEP.toml")
@click.option("--out", required=True, type=click.Path(file_okay=False, path_type=Path), help="For the table.")
@click.option(
    "--work",
    default=Path("runs/planner"),
    show_default=True,
    type=click.Path(path_type=Path),
    help="For plans and replays.",
)
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
def main(source: Path, out: Path, work: Path, threads: int | None) -> None:
    """Plan with every setting of SWEEP.toml; write SWEEP.json and SWEEP.md to the folder after each one."""
    with clean_errors():
        sweep = Sweep.load(source)
        course = COURSES[sweep.course]
        played: dict[str, Floats] = {}
        entered = entrants(tuple(sweep.references), course, with_baselines=False)
        for judged in judge(entered, Conditions(course, sweep.episodes, threads=threads)):
            played[judged.name] = judged.episodes.seconds
        rows: list[dict[str, Any]] = []
        out.mkdir(parents=True, exist_ok=True)
        for name, arguments in sweep.plans.items():
            folder = work / f"{sweep.course}-{sweep.episodes}-{name}"
            planned = plan(
                sweep.task,
                sweep.course,
                episodes=sweep.episodes,
                threads=threads,
                out=folder,
                resume=True,
                quiet=not sys.stderr.isatty(),
                **arguments,
            )
            ratio = intervals.mean_ratio(planned.seconds, played[sweep.references[0]])
            rows.append(
                {
                    "name": name,
                    "what": report.describe(planned),
                    "settings": planned.settings.as_dict(),
                    "guides": list(planned.guides),
                    "values": list(planned.values),
                    "ratio": ratio.as_dict(),
                    **report.figures(planned),
                    "episode_seconds": planned.seconds.tolist(),
                }
            )
            click.echo(f"{name}: {planned.seconds.mean():.3f} s", err=True)
            _write(sweep, source, out, played, rows)


def _write(
    sweep: Sweep, source: Path, out: Path, played: dict[str, Floats], rows: list[dict[str, Any]]
) -> None:
    # The script's own path is the machine's.
    command = shlex.join(["python", "-m", "discjump_training.planner.sweep", *sys.argv[1:]])
    told = {
        "schema_version": 1,
        "command": command,
        "task": sweep.task,
        "course": sweep.course,
        "episodes": sweep.episodes,
        "references": {name: seconds.tolist() for name, seconds in played.items()},
        "plans": rows,
    }
    write_atomically(out / f"{source.stem}.json", (json.dumps(told, indent=1) + "\n").encode())
    first = sweep.references[0]
    heading = ["name", *report.HEADING, f"time / {first}'s"]
    body = [
        [row["name"], *report.row(row["what"], row), cell(Estimate(**row["ratio"]), "", 3)] for row in rows
    ]
    references = ", ".join(f"{name} {seconds.mean():.2f} s" for name, seconds in played.items())
    text = (
        table(heading, body)
        + f"\n{sweep.course}: its first {sweep.episodes} episodes; on the same: {references}. In brackets "
        f"95% intervals over episodes. Wall time is that of a shared machine.\n\n    {command}\n"
    )
    write_atomically(out / f"{source.stem}.md", text.encode())


if __name__ == "__main__":
    main()
