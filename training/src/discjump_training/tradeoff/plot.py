"""The picture of a record: speed against each error, a panel for each.

What no other configuration beats in both is coloured and named in its place; the rest is grey, and of it
only the truth and what ships as default are named.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from discjump.accuracy.plot import COLOURS
from discjump_training.tradeoff.grid import TRUTH, Config
from discjump_training.tradeoff.pareto import undominated
from discjump_training.tradeoff.section import Panel, Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLUMNS = 2
GREY = "0.72"
NAMED = (TRUTH, Config("authentic"))
"""Named even where they are dominated."""
APART = 0.038
"""Between names, as a share of the panel's height."""


def draw(panels: list[Panel], path: Path) -> None:
    """Draw the picture as a PNG."""
    from matplotlib.figure import Figure

    columns = min(COLUMNS, len(panels))
    lines = -(-len(panels) // columns)
    figure = Figure(figsize=(5.6 * columns, 4.6 * lines + 0.5), layout="constrained")
    grid = figure.subplots(lines, columns, squeeze=False)
    for axes, panel in zip(grid.flat, panels, strict=False):
        show(axes, panel)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    figure.suptitle(
        "Faster is to the right, more accurate is down: grey is beaten in both by another",
        fontsize=11,
    )
    figure.savefig(path, dpi=110)


def show(axes: "Axes", panel: Panel) -> None:
    """One panel."""
    best = undominated([point.speed[0] for point in panel.points], [point.error for point in panel.points])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_title(panel.title, loc="left", fontweight="bold", fontsize=10)
    axes.set_xlabel(f"player-seconds simulated a second, {panel.speed}", fontsize=9)
    axes.set_ylabel(panel.error, fontsize=9)
    axes.grid(color="0.93", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    for point, kept in zip(panel.points, best, strict=True):
        colour = COLOURS[point.config.tier] if kept else GREY
        median, low, high = point.speed
        height = max(point.error, panel.floor)
        axes.plot([low, high], [height, height], color=colour, linewidth=1.0, zorder=1 + kept)
        axes.plot([median], [height], "o", color=colour, markersize=6 if kept else 4, zorder=2 + kept)
    _room(axes, panel)
    told = [
        (point, bool(kept))
        for point, kept in zip(panel.points, best, strict=True)
        if kept or point.config in NAMED
    ]
    _names(axes, panel, told)


def _room(axes: "Axes", panel: Panel) -> None:
    """Limits that leave room for names at the right; the lower end is `floor`."""
    speeds = [point.speed[0] for point in panel.points]
    least, most = min(speeds), max(speeds)
    wide = max(most / least, 1.5)
    axes.set_xlim(least / wide**0.08, most * wide**0.55)
    top = max(max(point.error for point in panel.points), 10.0 * panel.floor)
    axes.set_ylim(panel.floor / 1.6, top * 2.0)
    axes.axhline(panel.floor, color="0.8", linewidth=0.8, linestyle="dotted", zorder=0)


def _names(axes: "Axes", panel: Panel, told: list[tuple[Point, bool]]) -> None:
    """Names to the right of their points, moved apart where they would touch."""
    axes.figure.canvas.draw_idle()
    low, high = np.log10(axes.get_ylim())
    left, right = np.log10(axes.get_xlim())
    heights = [(np.log10(max(p.error, panel.floor)) - low) / (high - low) for p, _ in told]
    places = apart(heights, APART)
    for (point, kept), place in zip(told, places, strict=True):
        colour = COLOURS[point.config.tier] if kept else "0.45"
        x = (np.log10(point.speed[0]) - left) / (right - left)
        name = point.config.name
        if point.error <= panel.floor:
            name += ": the truth" if point.config == TRUTH else f" (at most {panel.floor:g})"
        elif point.config in NAMED:
            name += " (the default)" if point.config != TRUTH else ""
        axes.annotate(
            name,
            (point.speed[0], max(point.error, panel.floor)),
            (x + 0.03, place),
            textcoords="axes fraction",
            color=colour,
            fontsize=8.5,
            va="center",
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.6, "shrinkB": 2},
        )


def apart(heights: list[float], least: float) -> list[float]:
    """Heights at least so far apart, in the same order, as near to those given as that allows.

    >>> [round(height, 2) for height in apart([0.5, 0.5, 0.1], 0.1)]
    [0.45, 0.55, 0.1]
    """
    from discjump.accuracy.plot import APART as UNIT
    from discjump.accuracy.plot import spread_out

    return [height * least / UNIT for height in spread_out([height * UNIT / least for height in heights])]
