"""The command `discjump leaderboard`."""

import json
import sys
from pathlib import Path

import click
from rich.console import Console

from discjump_training.courses import course as course_named
from discjump_training.errors import clean_errors


@click.command()
@click.argument(
    "places",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, path_type=Path),
    metavar="FOLDER_OR_FILE...",
)
@click.option(
    "--course", metavar="NAME", help="Full name: replays of other courses are refused.  [default: all]"
)
@click.option("--episodes", type=click.IntRange(min=1), help="Of the course's first so many.  [default: all]")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs") / "leaderboard",
    show_default=True,
    help="Folder for leaderboard.json and leaderboard.md.",
)
def leaderboard(places: tuple[Path, ...], course: str | None, episodes: int | None, out: Path) -> None:
    """Rank replays, every one played again before its score is shown.

    Rows are policies by name and course. A replay that does not come out as recorded, or is not the episode
    that it claims to be, is refused, and the reason given. Episodes without a replay count as failures.

    Exit status: 0 also where replays were refused; 1 if there are none at all, or no course of that name.
    """
    with clean_errors():
        only = None if course is None else course_named(course)
        from discjump_training.files import write_atomically
        from discjump_training.judge.leaderboard import found, show
        from discjump_training.judge.leaderboard import leaderboard as ranked

        files = found(places)
        click.echo(f"{len(files)} replays are played again ...", err=True)

        def tell(count: int) -> None:
            if sys.stderr.isatty():
                click.echo(f"  {count} of {len(files)}\r", nl=False, err=True)

        made = ranked(files, only, episodes, tell)
        out.mkdir(parents=True, exist_ok=True)
        write_atomically(out / "leaderboard.json", (json.dumps(show.as_json(made), indent=1) + "\n").encode())
        write_atomically(out / "leaderboard.md", show.markdown(made).encode())
        console = Console(width=None if sys.stdout.isatty() else 160)
        for table in show.tables(made):
            console.print(table.title)
            console.print(table.rich())
        click.echo(show.NOTE)
        click.echo(f"{len(made.runs)} of {len(files)} replays count.")
        for suffix in ("json", "md"):
            click.echo(str(out / f"leaderboard.{suffix}"))
