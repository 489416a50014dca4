"""The command `discjump`.

Other packages add subcommands through the entry-point group `discjump.commands`: each names a click command.
"""

from importlib.metadata import EntryPoint, entry_points
from typing import Any

import click

from discjump import __version__
from discjump.accuracy.command import accuracy
from discjump.bench.command import bench
from discjump.bisect.command import bisect
from discjump.cards.command import card
from discjump.falloff_command import falloff
from discjump.features.command import features
from discjump.replays.command import replay
from discjump.stress.command import stress
from discjump.terrain_command import terrain
from discjump.theory.command import theory
from discjump.verify.command import verify

GROUP = "discjump.commands"

TRAINING = {
    "train": "Train an agent.",
    "evaluate": "Judge an agent or a baseline on terrain it never saw.",
    "plan": "Plan episodes by simulation: an upper bound.",
    "export": "Pack a trained policy: ONNX, zip, recipe and card.",
    "compare": "Compare two policies on the same episodes.",
    "leaderboard": "Rank replays, each played again before its score is shown.",
    "tradeoff": "Measure speed against accuracy, and draw it.",
}
"""Subcommands of the package discjump-training, named here so that one learns where they are."""


class Commands(click.Group):
    """Our own subcommands and those of other packages, loaded only when asked for."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the subcommand; a file that cannot be read or written is named, without a traceback."""
        try:
            return super().invoke(ctx)
        except OSError as error:
            if error.filename is None:
                raise
            raise click.ClickException(f"{error.filename}: {error.strerror}") from error

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All names in alphabetical order."""
        return sorted({*super().list_commands(ctx), *_entries(), *TRAINING})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name; for one that cannot be had, a command that says why and fails."""
        own = super().get_command(ctx, cmd_name)
        if own is not None:
            return own
        entry = _entries().get(cmd_name)
        if entry is not None:
            return _loaded(entry)
        if cmd_name in TRAINING:
            return _missing(
                cmd_name,
                TRAINING[cmd_name],
                "needs the package discjump-training, which is not installed: pip install discjump-training",
            )
        return None


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="discjump")
def main() -> None:
    """The movement of Tribes 1 (skiing, jetting, disc jumping), batched for reinforcement learning.

    Units are SI: metres, seconds, metres per second, radians, unless an option says otherwise.
    """


main.add_command(accuracy)
main.add_command(bench)
main.add_command(bisect)
main.add_command(card)
main.add_command(falloff)
main.add_command(features)
main.add_command(replay)
main.add_command(stress)
main.add_command(terrain)
main.add_command(theory)
main.add_command(verify)


def _entries() -> dict[str, EntryPoint]:
    return {entry.name: entry for entry in entry_points(group=GROUP)}


def _loaded(entry: EntryPoint) -> click.Command:
    try:
        command = entry.load()
    except (ImportError, AttributeError) as error:
        return _missing(
            entry.name, f"Not available ({entry.value}).", f"cannot be loaded from {entry.value}: {error}"
        )
    if not isinstance(command, click.Command):
        return _missing(
            entry.name, f"Not available ({entry.value}).", f"is no click command in {entry.value}"
        )
    return command


def _missing(name: str, summary: str, why: str) -> click.Command:
    @click.command(
        name, help=summary, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
    )
    @click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
    def missing(arguments: tuple[str, ...]) -> None:
        raise click.ClickException(f"discjump {name} {why}")

    return missing
