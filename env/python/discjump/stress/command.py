"""The command `discjump stress`."""

import shlex
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import click
import numpy as np
from click.core import ParameterSource

from discjump._native import Terrain
from discjump._options import FiniteRange
from discjump._results import machine, require_matplotlib, save, versions
from discjump.simulator import ARMORS, SCENES
from discjump.stress import expected, extremes, matrix, own, report
from discjump.stress.cases import PRECISIONS, SURFACES, TIERS, Case, Column, Setting, columns
from discjump.stress.long import long_form
from discjump.stress.picture import draw
from discjump.stress.replay import address, parsed, replay

OUT = Path("runs/stress")


@dataclass(frozen=True)
class Asked:
    """The options that say what is played."""

    terrain: Path | None
    square_size: float
    edge: str
    seed: int | None
    scene: str
    armor: str
    quick: bool
    draws: int

    @property
    def own(self) -> bool:
        """Whether a ground was given."""
        return self.terrain is not None or self.seed is not None

    def ground(self) -> Terrain:
        """The ground that was given."""
        if self.seed is not None:
            return Terrain.raindance(self.seed)
        assert self.terrain is not None
        try:
            return Terrain.from_heights(np.load(self.terrain), self.square_size, edge=self.edge)
        except (EOFError, OSError, ValueError, TypeError) as error:
            raise click.ClickException(f"{self.terrain}: {error}") from error

    def cases(self) -> list[Case]:
        """What is played."""
        form = replace(extremes.QUICK if self.quick else extremes.FULL, seed=self.draws)
        if not self.own:
            return extremes.built_in(form)
        return own.cases_on(form, self.ground(), Setting(self.scene, self.armor))

    def words(self) -> list[str]:
        """The options as one types them."""
        words = [] if self.terrain is None else ["--terrain", str(self.terrain)]
        if self.terrain is not None:
            words += ["--square-size", f"{self.square_size:g}", "--edge", self.edge]
        words += [] if self.seed is None else ["--seed", str(self.seed)]
        words += ["--scene", self.scene, "--armor", self.armor] if self.own else []
        words += ["--quick"] if self.quick else []
        return words + (["--draws", str(self.draws)] if self.draws else [])


@click.command()
@click.option(
    "--terrain",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Heights of your own ground, m: a .npy of shape (rows y, columns x).",
)
@click.option("--square-size", type=float, default=8.0, show_default=True, help="Of --terrain, m.")
@click.option(
    "--edge",
    type=click.Choice(["tile", "clamp", "void"]),
    default="clamp",
    show_default=True,
    help="What lies beyond the rim of --terrain.",
)
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), help="The generated terrain of this seed instead.")
@click.option(
    "--scene",
    type=click.Choice(list(SCENES)),
    default="sandbox",
    show_default=True,
    help="What is modelled on a ground of your own.",
)
@click.option(
    "--armor",
    type=click.Choice(list(ARMORS)),
    default="light",
    show_default=True,
    help="On a ground of your own.",
)
@click.option(
    "--tiers",
    type=click.Choice(list(TIERS)),
    multiple=True,
    help="A tier; may be given several times. All if absent.",
)
@click.option(
    "--precisions",
    type=click.Choice(list(PRECISIONS)),
    multiple=True,
    help="An arithmetic; may be given twice. Both if absent.",
)
@click.option(
    "--surfaces",
    type=click.Choice(list(SURFACES)),
    multiple=True,
    help="A surface; may be given twice. Both if absent.",
)
@click.option(
    "--extremes", "only", multiple=True, metavar="NAME", help="Only these rows; may be given several times."
)
@click.option("--quick", is_flag=True, help="Fewer cases, players and ticks: about a minute.")
@click.option(
    "--long",
    "long",
    is_flag=True,
    help="Instead of the matrix: ten million ticks without pause in every tier, a million episodes.",
)
@click.option(
    "--scale",
    type=FiniteRange(0.0, 1000.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Of --long: how much of that is played.",
)
@click.option(
    "--draws",
    type=click.IntRange(0, 2**32 - 1),
    default=0,
    show_default=True,
    help="Seed that draws starts and keys; the grounds stay the same.",
)
@click.option(
    "--replay",
    "again",
    metavar="CASE",
    help="Play one player again and show the tick: tier/precision/surface/extreme/case/player.",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="Directory for figures (JSON), report (Markdown) and picture (PNG).",
)
def stress(
    terrain: Path | None,
    square_size: float,
    edge: str,
    seed: int | None,
    scene: str,
    armor: str,
    tiers: tuple[str, ...],
    precisions: tuple[str, ...],
    surfaces: tuple[str, ...],
    only: tuple[str, ...],
    quick: bool,
    long: bool,
    scale: float,
    draws: int,
    again: str | None,
    out: Path,
) -> None:
    """Whether the simulator stands its extremes, in every tier, precision and surface.

    Every tick of every player is asked: are all numbers finite and within their bounds, did nobody go
    through the ground, did no energy come from nothing, did nobody stop dead, are the bits the same when
    repeated among others, in other lanes, on other threads and whole tiles away. Lengths in m, speeds in
    m/s, energies per mass in (m/s)^2.

    Fails where anything fails that is not expected (core/docs/stress.md), and, in the full form on the
    suite's own grounds, where an expected failure is no longer there.
    """
    if terrain is not None and seed is not None:
        raise click.BadParameter("expected --terrain or --seed, got both", param_hint="--terrain")
    asked = Asked(terrain, square_size, edge, seed, scene, armor, quick, draws)
    if again is not None:
        text, found = replay(parsed(again, asked.cases()))
        click.echo(text)
        raise SystemExit(1 if found else 0)
    if long:
        _refuse_with_long("terrain", "seed", "tiers", "precisions", "surfaces", "only", "quick")
        raise SystemExit(long_form(out, scale, draws))
    require_matplotlib("discjump stress")
    chosen = columns(
        tuple(dict.fromkeys(tiers)) or TIERS,
        tuple(dict.fromkeys(precisions)) or PRECISIONS,
        tuple(dict.fromkeys(surfaces)) or SURFACES,
    )
    if not chosen:
        raise click.BadParameter(
            "expected float64 among the precisions of `reference`", param_hint="--precisions"
        )
    words = [*asked.words(), *_repeated("--tiers", tiers), *_repeated("--precisions", precisions)]
    words += [*_repeated("--surfaces", surfaces), *_repeated("--extremes", only)]
    words += [] if out == OUT else ["--out", str(out)]
    record = measured(asked, chosen, only, shlex.join(["discjump", "stress", *words]))
    text = report.render(record)
    figures, page, picture = (out / f"stress.{ending}" for ending in ("json", "md", "png"))
    save(figures, record)
    page.write_text(text)
    draw(record, picture)
    click.echo(text)
    click.echo(f"{figures}\n{page}\n{picture}")
    statuses = {cell["status"] for cell in record["cells"]}
    bad = {matrix.FAIL} | (set() if quick or asked.own else {matrix.UNEXPECTED_PASS})
    raise SystemExit(1 if statuses & bad else 0)


def measured(asked: Asked, chosen: list[Column], only: tuple[str, ...], command: str) -> dict[str, Any]:
    """Play, with a progress bar: everything that report and picture show."""
    cases = asked.cases()
    names = list(dict.fromkeys(case.extreme for case in cases))
    for name in only:
        if name not in names:
            raise click.BadParameter(
                f"expected some of {', '.join(map(repr, names))}, got {name!r}", param_hint="--extremes"
            )
    cases = [case for case in cases if not only or case.extreme in only]
    began = time.perf_counter()
    with click.progressbar(length=matrix.work(cases, chosen), show_pos=True) as bar:

        def done(label: str) -> None:
            bar.label = f"{label[:28]:<28}"
            bar.update(1)

        cells = matrix.run(
            cases,
            chosen,
            crowd=not asked.quick,
            strict=not asked.own,
            setting=Setting(asked.scene, asked.armor),
            done=done,
        )
    options = asked.words()
    return {
        "command": command,
        "machine": machine(),
        "versions": versions("discjump", "numpy"),
        "took_seconds": round(time.perf_counter() - began, 1),
        "ground": "its own" if not asked.own else str(asked.terrain or f"generated, seed {asked.seed}"),
        "player_ticks": sum(cell.player_ticks for cell in cells),
        "reasons": expected.REASONS,
        "extremes": list(dict.fromkeys(cell.extreme for cell in cells)),
        "cells": [_figures(cell, options) for cell in cells],
    }


def _figures(cell: matrix.Cell, options: list[str]) -> dict[str, Any]:
    """A cell as JSON; each finding with the command that plays it again."""

    def again(finding: dict[str, Any]) -> str | None:
        if cell.extreme == matrix.NOT_NUMBERS:
            return None
        where = address(cell.column, cell.extreme, finding["case"], finding["player"])
        return shlex.join(["discjump", "stress", *options, "--replay", where])

    return {
        "tier": cell.column.tier,
        "precision": cell.column.precision,
        "surface": cell.column.surface,
        "extreme": cell.extreme,
        "status": cell.status,
        "cases": cell.cases,
        "player_ticks": cell.player_ticks,
        "findings": [{**finding, "replay": again(finding)} for finding in cell.findings],
    }


def _refuse_with_long(*names: str) -> None:
    """The long form plays grounds, tiers and lengths of its own: what it would not heed is refused.

    Raises:
        click.UsageError: one of these options was given.
    """
    ctx = click.get_current_context()
    for param in ctx.command.params:
        if param.name in names and ctx.get_parameter_source(param.name) is ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{param.opts[0]}: expected it without --long, got both")


def _repeated(option: str, values: tuple[str, ...]) -> list[str]:
    return [word for value in values for word in (option, value)]
