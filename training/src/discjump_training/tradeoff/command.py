"""The command `discjump tradeoff`."""

import shlex
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import click

from discjump.terrains import SURFACES
from discjump_training.cli import INTERRUPTED, clean_errors
from discjump_training.tradeoff.grid import FRAME_SKIPS, QUICK, TICK_MS, TIERS, Plan

OUT = Path("runs/tradeoff")
SECTIONS = ("speed", "instructions", "errors", "outcomes", "apex", "transfer", "training")


class Several(click.ParamType[tuple[Any, ...]]):
    """Some of a few choices, separated by commas, as a tuple in the order of the choices.

    Args:
        choices: strings or numbers.
    """

    name = "list"

    def __init__(self, choices: Sequence[Any]) -> None:
        self.choices = {str(choice): choice for choice in choices}

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[Any, ...]:
        """The tuple; fails with the choices where one is unknown."""
        if isinstance(value, tuple):
            return value
        given = [word.strip() for word in value.split(",")]
        for word in given:
            if word not in self.choices:
                known = ", ".join(self.choices)
                self.fail(f"{word!r} is none of {known} (several are separated by commas).", param, ctx)
        return tuple(choice for word, choice in self.choices.items() if word in given)

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """The choices."""
        return "[" + ",".join(self.choices) + "]"


@click.command()
@click.option("--sections", type=Several(SECTIONS), help="What to measure.  [default: all]")
@click.option("--tiers", type=Several(TIERS), help="Fidelity tiers.  [default: all]")
@click.option("--tick-ms", type=Several(TICK_MS), help="Lengths of a tick, ms.  [default: all]")
@click.option("--surfaces", type=Several(SURFACES), help="Surfaces of the terrain.  [default: all]")
@click.option(
    "--frame-skips",
    type=Several(FRAME_SKIPS),
    help="Ticks a decision, where they make sense.  [default: all]",
)
@click.option(
    "--starts", type=click.IntRange(4, 65536), help=f"Starts of a situation.  [default: {Plan.starts}]"
)
@click.option(
    "--episodes", type=click.IntRange(2, 512), help=f"Episodes of a skier.  [default: {Plan.episodes}]"
)
@click.option(
    "--repeats",
    type=click.IntRange(3, 1000),
    help=f"Rounds in which every configuration is timed.  [default: {Plan.repeats}]",
)
@click.option(
    "--seeds", type=click.IntRange(2, 100), help=f"Trainings in each physics.  [default: {Plan.seeds}]"
)
@click.option(
    "--steps", type=click.IntRange(min=1), help=f"Decisions of a training.  [default: {Plan.steps:,}]"
)
@click.option("--quick", is_flag=True, help="A small grid in a minute or two: whether it runs.")
@click.option("--anew", is_flag=True, help="Measure the sections again, whatever the folder has of them.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="Folder for figures (JSON), tables (Markdown), picture (PNG) and all finished work (pieces/).",
)
def tradeoff(sections: tuple[str, ...] | None, quick: bool, anew: bool, out: Path, **asked: Any) -> None:
    """What speed costs in accuracy: every tier x tick length x terrain surface x frame skip.

    speed: player-ticks and agent steps a second. instructions: of a player-tick (needs valgrind). errors:
    distance in m from the truth (`reference`, ticks of 32 ms, triangles) after the same keys, by situation.
    outcomes: what a scripted skier notices, in s, m/s and damage. apex: height of a disc jump, m.
    transfer: policies trained in each physics and judged in the task (a minute and a half for each of 45
    trainings, kept in OUT/runs). training: how long they take.

    Ctrl-C at any time: what is finished stays, and the same command goes on. What an earlier run left in the
    folder is shown together with the sections measured now, if it was made with the same options, versions
    and code. Figures of speed are those of a quiet machine only if it was quiet.
    """
    given = {name: value for name, value in asked.items() if value is not None}
    plan = replace(QUICK if quick else Plan(), **given)
    words = _words(sections, quick, anew, out, given)
    with clean_errors():
        try:
            _measure(plan, sections or SECTIONS, anew, out, words)
        except KeyboardInterrupt:
            again = shlex.join([word for word in words if word != "--anew"])
            click.echo(f"\nStopped; what is finished is in {out}. Go on with: {again}", err=True)
            sys.exit(INTERRUPTED)


def _measure(plan: Plan, wanted: tuple[str, ...], anew: bool, out: Path, words: list[str]) -> None:
    # Imported late: --help should not wait for scipy and matplotlib.
    from discjump._results import machine, versions
    from discjump_training.tradeoff import record as recording
    from discjump_training.tradeoff.store import Store

    store = Store(out)
    made = recording.measure(plan, wanted, store, anew=anew)
    record = {
        "command": shlex.join(words),
        "machine": machine(),
        "versions": versions("discjump", "numpy", "scipy", "gymnasium", "stable-baselines3", "torch"),
        "plan": asdict(plan),
        "configs": [config.keys for config in plan.configs()],
        "sections": made,
    }
    for path in recording.write(record, out):
        click.echo(path)


def _words(
    sections: tuple[str, ...] | None, quick: bool, anew: bool, out: Path, given: dict[str, Any]
) -> list[str]:
    """The command line that does the same again."""
    words = ["discjump", "tradeoff"]
    words += ["--sections", ",".join(sections)] if sections else []
    for name, value in given.items():
        text = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
        words += [f"--{name.replace('_', '-')}", text]
    words += ["--quick"] if quick else []
    words += ["--anew"] if anew else []
    return words + (["--out", str(out)] if out != OUT else [])
