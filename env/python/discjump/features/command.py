"""The command `discjump features`."""

from pathlib import Path
from typing import Any

import click

from discjump._options import FiniteRange
from discjump._results import machine, save, versions
from discjump.features.measure import APART, FEATURES, ROUTES, SEEDS, measure


@click.command()
@click.option(
    "--starts", type=click.IntRange(4, 65536), default=256, show_default=True, help="Skiers of each route."
)
@click.option(
    "--seconds",
    type=FiniteRange(1.0, 600.0),
    default=60.0,
    show_default=True,
    help="How long they play, s.",
)
@click.option(
    "--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True, help="Draws the starts."
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("runs/features.json"),
    show_default=True,
    help="Where the figures go (JSON).",
)
def features(starts: int, seconds: float, seed: int, out: Path) -> None:
    """What leaving a feature out changes: the same scripted skiers with everything and without each.

    They are light, play in `authentic`, begin with a disc jump, hold jump and forward, steer to a beacon, and
    jet when slow or where the ground rises. `hills` goes 300 to 800 m over open ground, `bases` from before
    one base of the mission to the flag in the other. Arrival: alive within 8 m of the beacon. Path: distance
    from where the same skier is with everything, median (90th percentile), after 1, 5 and 20 s;
    and how many are then more than 1 m away.
    """
    skiers = len(ROUTES) * starts * (1 + len(FEATURES))
    with click.progressbar(length=skiers, label="skiers", show_pos=True) as bar:
        rows = measure(starts, seconds, seed, bar.update)
    click.echo(table(rows))
    here = {"machine": machine(), "versions": versions("discjump", "numpy"), "seeds": SEEDS}
    save(out, {**here, "starts": starts, "seconds": seconds, "seed": seed, "rows": rows})
    click.echo(out)


def table(rows: list[dict[str, Any]]) -> str:
    """The rows as Markdown: what there is with everything, and what changes without a feature.

    >>> row = {"route": "hills", "left_out": None, "arrived": 1.0, "seconds": 20.0, "seconds_changed": 0.0}
    >>> row |= {"top_speed": 40.0, "top_speed_changed": 0.0, "damage": 0.125, "killed": 0.0}
    >>> row["apart"] = {"1": {"median": 0.0, "p90": 2.0, "over_1_m": 0.25}}
    >>> print(table([row]).splitlines()[2])
    | hills | - | 100 | 20.0 (+0.0) | 40.0 (+0.0) | 0.125 | 0 | 0.0 (2.0) | 25 |
    """
    times = [f"{at:g}" for at in APART if f"{at:g}" in rows[0]["apart"]]
    path = " / ".join(times)
    lines = [
        "| route | without | arrive, % | time, s (change) | top speed, m/s (change) | damage | killed, % "
        f"| path after {path} s, m | over 1 m after {times[-1]} s, % |",
        "|---" * 9 + "|",
    ]
    for row in rows:
        apart = " / ".join(
            f"{row['apart'][at]['median']:.1f} ({row['apart'][at]['p90']:.1f})" for at in times
        )
        cells = [
            row["route"],
            row["left_out"] or "-",
            f"{100 * row['arrived']:.0f}",
            _changed(row["seconds"], row["seconds_changed"]),
            _changed(row["top_speed"], row["top_speed_changed"]),
            f"{row['damage']:.3f}",
            f"{100 * row['killed']:.0f}",
            apart,
            f"{100 * row['apart'][times[-1]]['over_1_m']:.0f}",
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _changed(value: float | None, change: float | None) -> str:
    """Of nobody there is neither."""
    shown = "-" if value is None else f"{value:.1f}"
    return shown if change is None else f"{shown} ({change:+.1f})"
