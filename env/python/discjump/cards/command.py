"""The command `discjump card`."""

import json
from pathlib import Path

import click

from discjump.cards.card import card as made
from discjump.envs.tasks import TASKS


@click.command()
@click.argument("task", type=click.Choice(list(TASKS)), required=False)
@click.option(
    "--scores",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="JSON of reference scores by task.",
)
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), help="Folder where each card becomes TASK.md."
)
def card(task: str | None, scores: Path | None, out: Path | None) -> None:
    """Print the card of a task, or of all: observation, action, reward, start, end, scores."""
    known = json.loads(scores.read_text(encoding="utf-8")) if scores else {}
    for name in [task] if task else TASKS:
        text = made(TASKS[name], known.get(name))
        if out is None:
            click.echo(text, nl=False)
        else:
            out.mkdir(parents=True, exist_ok=True)
            (out / f"{name}.md").write_text(text, encoding="utf-8")
