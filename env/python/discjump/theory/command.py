"""The command `discjump theory`."""

import json
import shlex
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import click

from discjump._results import machine, require_matplotlib, save, versions
from discjump.theory import blasts, bumps, convergence, figures, hops, report
from discjump.theory.forms import ARMORS
from discjump.theory.lab import TIERS, Tier, twin
from discjump.theory.plot import draw

OUT = Path("runs/theory")
LIMIT_SLOPE = 20.0
"""Degrees on which skiing is measured at every length of the tick."""


@click.command()
@click.option("--quick", is_flag=True, help="Fewer starts, slopes, squares and bearings: whether it runs.")
@click.option(
    "--ledger",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Figures (JSON) of the core's example `ledger`, to be shown with the others.",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="Directory for figures (JSON), tables (Markdown) and picture (PNG).",
)
def theory(quick: bool, ledger: Path | None, out: Path) -> None:
    """The simulator against closed forms, where the model has any, in every fidelity tier.

    Order of convergence in the length of the tick; apexes, burns, stopping distances; explosions by
    distance; skiing on planes by slope; and speed lost on smooth slopes that are cut into triangles.
    """
    require_matplotlib("discjump theory")
    energy = None if ledger is None else _ledger(ledger)
    made = {"command": _command(quick, ledger, out), **record(quick), "ledger": energy}
    text = report.render(made)
    out.mkdir(parents=True, exist_ok=True)
    numbers, page, picture = (out / f"theory.{ending}" for ending in ("json", "md", "png"))
    save(numbers, made)
    page.write_text(text)
    draw(made, picture)
    click.echo(text)
    click.echo(f"took {made['took_seconds']:.0f} s\n{numbers}\n{page}\n{picture}")


def record(quick: bool) -> dict[str, Any]:
    """Measure, with a progress bar: everything that the report and the picture show."""
    slopes = hops.SLOPES[1::3] if quick else hops.SLOPES
    squares = bumps.SQUARES[:2] if quick else bumps.SQUARES
    bearings = bumps.BEARINGS[::3] if quick else bumps.BEARINGS
    starts = 8 if quick else 32
    points = 34 * (2 if quick else 25) + 1
    ticks_ms = convergence.TICKS_MS[3:] if quick else convergence.TICKS_MS
    work: dict[str, list[Callable[[], Any]]] = {
        "convergence": [
            partial(_converge, name, tier, starts) for name in convergence.CASES for tier in TIERS
        ],
        "figures": [partial(figure.row, TIERS) for figure in figures.figures()],
        "blasts": [
            partial(blasts.measure, tier, armor, formula, points)
            for armor in ARMORS
            for formula in blasts.FORMULAS
            for tier in TIERS
        ],
        "hops": [
            partial(hops.measure, tier, slope, keys)
            for slope in slopes
            for keys in hops.KEYS
            for tier in TIERS
        ],
        "limit": [
            partial(hops.measure, TIERS[0], LIMIT_SLOPE, keys, tick_ms)
            for keys in hops.KEYS
            for tick_ms in ticks_ms
        ],
        "bumps": [
            partial(bumps.measure, tier, name, square, bearings, ground)
            for name in bumps.SURFACES
            for ground in bumps.GROUNDS
            for tier in TIERS
            for square in squares
        ],
    }
    began = time.perf_counter()
    made: dict[str, Any] = {}
    with click.progressbar(length=sum(map(len, work.values())), show_pos=True) as bar:
        for part, tasks in work.items():
            bar.label = f"{part:<11}"
            made[part] = []
            for task in tasks:
                made[part].append(task())
                bar.update(1)
    return {
        "machine": machine(),
        "versions": versions("discjump", "numpy"),
        "took_seconds": round(time.perf_counter() - began, 1),
        "models": {tier.name: tier.model for tier in TIERS},
        **made,
    }


def _converge(name: str, tier: Tier, starts: int) -> dict[str, Any]:
    other = twin(tier)
    double = None if other is None else convergence.errors(convergence.CASES[name], other, starts)
    return convergence.measure(name, tier, starts, double)


def _ledger(path: Path) -> dict[str, Any]:
    try:
        figures = json.loads(path.read_text())
        rows = figures["rows"]
        rows[0]["terms"]
    except (ValueError, LookupError, TypeError) as error:
        raise click.BadParameter(
            f"{path}: expected the JSON of the core's example `ledger`, got {error!r}", param_hint="--ledger"
        ) from error
    return dict(figures)


def _command(quick: bool, ledger: Path | None, out: Path) -> str:
    """The command line that gives the same figures again."""
    words = ["discjump", "theory"]
    words += ["--quick"] if quick else []
    words += [] if ledger is None else ["--ledger", str(ledger)]
    words += ["--out", str(out)] if out != OUT else []
    return shlex.join(words)
