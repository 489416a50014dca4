"""The commands `python -m discjump_training.bounds apex` and `... markers`."""

import json
import shlex
import sys
import time
from pathlib import Path
from typing import Any

import click

from discjump.simulator import ARMORS
from discjump_training import baselines
from discjump_training.bounds import report
from discjump_training.bounds.apex import search as apexes
from discjump_training.bounds.markers import search as find
from discjump_training.bounds.reachable import made
from discjump_training.cli import clean_errors
from discjump_training.courses import course_of
from discjump_training.episodes import Stage
from discjump_training.files import write_atomically
from discjump_training.tradeoff.store import build

OUT = click.option(
    "--out",
    default=Path("training/results/bounds"),
    show_default=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder for the results.",
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
def main() -> None:
    """What disc jumps reach, by exhaustive search."""


@main.command("apex")
@OUT
def apex(out: Path) -> None:
    """How high jump, jets and discs lead from rest on a plane: apex.json and apex.md. Takes 4 minutes."""
    with clean_errors():
        begun = time.process_time()
        rows = []
        for armor in ARMORS:
            for ticks in (1, 2):
                click.echo(f"{armor}, decisions of {ticks} ...", err=True)
                rows.append(apexes(armor, ticks))
        told = {"rows": rows, "cost_of_two_ticks": report.costs(rows)}
        _write(out, "apex", told, report.apex_tables(rows), time.process_time() - begun)


@main.command("markers")
@click.option("--course", default="held-out", show_default=True, help="Of the disc-jump task.")
@click.option("--episodes", type=click.IntRange(min=1), help="The course's first so many.  [default: all]")
@click.option("--keep", is_flag=True, help="Write what is reachable beside this module, for evaluations.")
@OUT
def markers(course: str, episodes: int | None, keep: bool, out: Path) -> None:
    """Which markers of a course the search reaches, and the scripted jumper: markers.json and markers.md."""
    with clean_errors():
        begun = time.process_time()
        chosen = course_of("disc-jump", course)
        found = find(chosen, episodes, quiet=not sys.stderr.isatty())
        seconds = time.process_time() - begun
        stage = Stage(chosen, len(found), baselines.options("disc-jump"), threads=1)
        played = stage.play(baselines.make("jumper", stage))
        stage.close()
        figures = report.marker_figures(found, played.success, played.seconds)
        result = made(chosen, {}, found)
        if keep:
            path = Path(__file__).with_name(f"{chosen.name}.json")
            write_atomically(path, result.to_text().encode())
            click.echo(f"Reachable: {path}")
        told = {"course": chosen.name, "course_digest": chosen.digest(), **figures}
        _write(out, "markers", told, report.marker_tables(figures, chosen.name), seconds)


def _write(out: Path, name: str, told: dict[str, Any], text: str, seconds: float) -> None:
    command = shlex.join(["python", "-m", "discjump_training.bounds", *sys.argv[1:]])
    data = {
        "schema_version": 1,
        "command": command,
        "build": build(),
        "cpu_seconds": round(seconds, 1),
        **told,
    }
    out.mkdir(parents=True, exist_ok=True)
    write_atomically(out / f"{name}.json", (json.dumps(data, indent=1) + "\n").encode())
    ending = f"\nSearched in {seconds:.0f} s of CPU time.\n\n    {command}\n"
    write_atomically(out / f"{name}.md", (text + ending).encode())
    click.echo(text + ending)


if __name__ == "__main__":
    main()
