"""The command `discjump accuracy`."""

import shlex
import time
from pathlib import Path
from typing import Any

import click

from discjump._results import machine, require_matplotlib, save, versions
from discjump.accuracy import measure, report
from discjump.accuracy.plot import draw
from discjump.accuracy.situations import SITUATIONS

STARTS, QUICK_STARTS = 256, 16
OUT = Path("runs/accuracy")


@click.command()
@click.option(
    "--starts",
    type=click.IntRange(1, 65536),
    help=f"Starts for each situation; {STARTS} if absent, {QUICK_STARTS} with --quick.",
)
@click.option(
    "--tiers",
    type=click.Choice(["reference", *measure.TIERS]),
    multiple=True,
    help="A tier to measure; may be given several times. All but reference if absent.",
)
@click.option(
    "--situations",
    type=click.Choice(list(SITUATIONS)),
    multiple=True,
    help="A situation to play; may be given several times. All if absent.",
)
@click.option(
    "--seed",
    type=click.IntRange(0, 2**32 - 1),
    default=0,
    show_default=True,
    help="Draws starts and keys; the grounds stay the same.",
)
@click.option("--quick", is_flag=True, help=f"{QUICK_STARTS} starts and 5 s: whether it runs.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="Directory for figures (JSON), table (Markdown) and picture (PNG).",
)
def accuracy(
    starts: int | None,
    tiers: tuple[str, ...],
    situations: tuple[str, ...],
    seed: int,
    quick: bool,
    out: Path,
) -> None:
    """How far each fidelity tier strays from `reference`, by situation, after 1, 5 and 20 s.

    Position errors in m, speed errors in m/s: median and 95th percentile over the starts, and the share of
    starts that are off by more than 1 cm, 10 cm and 1 m. All tiers play the same starts and the same keys,
    which do not look at the state. `anyway` is there to be measured only; `nudged` is no tier but
    `reference` from a start 1 mm aside: what the situation itself makes of a millimetre.
    """
    require_matplotlib("discjump accuracy")
    made = record(
        starts or (QUICK_STARTS if quick else STARTS),
        tuple(dict.fromkeys(tiers)) or measure.TIERS,
        tuple(dict.fromkeys(situations)) or tuple(SITUATIONS),
        seed,
        measure.SECONDS[1] if quick else measure.SECONDS[-1],
    )
    made = {"command": _command(starts, tiers, situations, seed, quick, out), **made}
    text = report.render(made)
    out.mkdir(parents=True, exist_ok=True)
    figures, page, picture = (out / f"accuracy.{ending}" for ending in ("json", "md", "png"))
    save(figures, made)
    page.write_text(text)
    draw(made, picture)
    click.echo(text)
    click.echo(f"took {made['took_seconds']:.0f} s\n{figures}\n{page}\n{picture}")


def record(
    starts: int, tiers: tuple[str, ...], situations: tuple[str, ...], seed: int, seconds: float
) -> dict[str, Any]:
    """Measure, with a progress bar: everything that the report and the picture show."""
    ticks = measure.ticks_of(seconds)
    drawn = measure.curve_ticks(ticks)
    rows: list[dict[str, Any]] = []
    curves: list[dict[str, Any]] = []
    began = time.perf_counter()
    work = len(situations) * (1 + len(tiers)) * starts * ticks
    with click.progressbar(length=work, show_pos=True) as bar:
        for name in situations:
            bar.label = f"{name:<8}"
            plays = SITUATIONS[name].plays(seed, starts, ticks)
            errors = measure.compare(plays, tiers, bar.update)
            for tier in tiers:
                rows += measure.rows(name, tier, errors[tier])
                curves.append({"situation": name, "tier": tier, **measure.curve(errors[tier], drawn)})
    return {
        "machine": machine(),
        "versions": versions("discjump", "numpy"),
        "starts": starts,
        "seed": seed,
        "seconds": seconds,
        "tick_ms": 32,
        "took_seconds": round(time.perf_counter() - began, 1),
        "tiers": list(tiers),
        "situations": {
            name: {"what": SITUATIONS[name].what, "grounds": list(SITUATIONS[name].grounds())}
            for name in situations
        },
        "rows": rows,
        "curve_seconds": [round(tick * measure.TICK, 3) for tick in drawn],
        "curves": curves,
    }


def _command(
    starts: int | None,
    tiers: tuple[str, ...],
    situations: tuple[str, ...],
    seed: int,
    quick: bool,
    out: Path,
) -> str:
    """The command line that gives the same figures again."""
    words = ["discjump", "accuracy"]
    words += [] if starts is None else ["--starts", str(starts)]
    words += [word for tier in tiers for word in ("--tiers", tier)]
    words += [word for name in situations for word in ("--situations", name)]
    words += ["--seed", str(seed)] if seed else []
    words += ["--quick"] if quick else []
    words += ["--out", str(out)] if out != OUT else []
    return shlex.join(words)
