"""The command `discjump replay`."""

import json
from pathlib import Path

import click

from discjump import replays
from discjump.replays.card import card
from discjump.replays.errors import ReplayError


@click.command()
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(exists=True, path_type=Path), metavar="FILE..."
)
@click.option("--verify", is_flag=True, help="Play it again, and fail at the first digest that differs.")
@click.option(
    "--render",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="PNG",
    help="Draw the episode's path on the command map (one FILE alone).",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON: one object for each file.")
def replay(files: tuple[Path, ...], verify: bool, render: Path | None, as_json: bool) -> None:
    """What a replay is, and whether it still happens.

    FILE is a replay, or a folder of them. Without --verify a card of each is printed; with it each is played
    again, and compared: digests of state and of observations, rewards, flags and info, the final state, the
    outcome. Opening a replay runs nothing that is in it, wherever it comes from.

    Exit status: 0 all is as recorded, 1 something differs, cannot be read, or needs another version of
    discjump.
    """
    paths = [path for file in files for path in (sorted(file.glob("*.replay")) if file.is_dir() else [file])]
    if not paths:
        raise click.ClickException(f"expected replays (*.replay) in {', '.join(map(str, files))}, got none")
    if render is not None and len(paths) > 1:
        raise click.UsageError(f"--render: expected one replay, got {len(paths)}")
    failed = 0
    for path in paths:
        try:
            found = replays.load(path)
            told = card(found, path.stat().st_size)
            mismatch = found.verify() if verify else None
            if render is not None:
                from discjump.replays.picture import draw

                draw(found, render)
        except (ReplayError, OSError) as error:
            failed += 1
            message = str(error) if str(path) in str(error) else f"{path}: {error}"
            click.echo(
                json.dumps({"file": str(path), "error": message}) if as_json else message, err=not as_json
            )
            continue
        failed += mismatch is not None
        if as_json:
            verdict = {"verified": mismatch is None, "mismatch": mismatch and str(mismatch)} if verify else {}
            click.echo(json.dumps({"file": str(path), **told, **verdict}))
        elif verify:
            click.echo(f"{path}: {'as recorded' if mismatch is None else mismatch}")
        else:
            click.echo("\n".join([str(path), *(f"  {name:<12}{value}" for name, value in told.items())]))
    if verify and len(paths) > 1 and not as_json:
        click.echo(f"{len(paths) - failed} of {len(paths)} replays are as recorded")
    if render is not None and not failed:
        click.echo(str(render))
    raise SystemExit(1 if failed else 0)
