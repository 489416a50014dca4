"""The picture of a record: speed against each error, a panel for each.

What no other configuration beats in both is coloured and named in its place; the rest is grey, and of it
only the truth and the default are named. The number in a mark is its tick length.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from discjump.accuracy.plot import APART, COLOURS, spread_out
from discjump_training.tradeoff.grid import DEFAULT, TRUTH
from discjump_training.tradeoff.pareto import unbeaten
from discjump_training.tradeoff.section import Panel, Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLUMNS = 2
MARKS = {"triangles": "o", "bilinear": "s"}
BESIDE = {TRUTH: ": the truth", DEFAULT: ": the default"}
"""Named even where they are dominated."""
GREY, DARK = "0.80", "0.45"
"""Of dominated marks, and of what is written about them."""
LETTER = 0.0145
"""Width of a letter of a name, as a share of the panel's width."""
NEAREST = 0.045
"""Between names, as a share of the panel's height."""


def draw(panels: list[Panel], path: Path) -> None:
    """Draw the picture as a PNG."""
    from matplotlib.figure import Figure

    columns = min(COLUMNS, len(panels))
    lines = -(-len(panels) // columns)
    figure = Figure(figsize=(5.8 * columns, 4.7 * lines + 0.6), layout="constrained")
    grid = figure.subplots(lines, columns, squeeze=False)
    for axes, panel in zip(grid.flat, panels, strict=False):
        show(axes, panel)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    marks = "Circles: triangulated terrain; squares: bilinear." if _has_squares(panels) else ""
    figure.suptitle(
        "Right is faster, down is more accurate; what is grey is beaten in both by another.\n"
        f"The number is the tick in ms; the game's is {TRUTH.tick_ms}, others are other games. {marks}",
        fontsize=10,
    )
    figure.savefig(path, dpi=100)


def show(axes: "Axes", panel: Panel) -> None:
    """One panel."""
    from matplotlib.ticker import EngFormatter, NullFormatter

    best = unbeaten(panel)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(EngFormatter(sep=""))
    axes.yaxis.set_major_formatter(EngFormatter(unit=panel.unit))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_title(panel.title, loc="left", fontweight="bold", fontsize=10)
    axes.set_xlabel(f"player-seconds simulated a second ({panel.speed})", fontsize=9)
    axes.set_ylabel(panel.error, fontsize=9)
    axes.grid(color="0.94", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    _limits(axes, panel)
    for point, kept in zip(panel.points, best, strict=True):
        _mark(axes, panel, point, kept=bool(kept))
    marked = list(zip(panel.points, best, strict=True))
    _names(axes, panel, [(point, bool(kept)) for point, kept in marked if kept or point.config in BESIDE])


def _has_squares(panels: list[Panel]) -> bool:
    return any(MARKS[point.config.surface] == "s" for panel in panels for point in panel.points)


def _limits(axes: "Axes", panel: Panel) -> None:
    """Room for names at the right; the lower end is the panel's floor."""
    speeds = [point.speed[0] for point in panel.points]
    least, most = min(speeds), max(speeds)
    wide = max(most / least, 3.0)
    axes.set_xlim(least / wide**0.1, most * wide**0.62)
    top = max(max(point.error for point in panel.points), 10.0 * panel.floor)
    axes.set_ylim(panel.floor / 2.0, top * 2.5)


def _mark(axes: "Axes", panel: Panel, point: Point, *, kept: bool) -> None:
    """Median and quartiles of the speed, and the tick length."""
    colour = COLOURS[point.config.tier] if kept else GREY
    median, low, high = point.speed
    height = max(point.error, panel.floor)
    layer = 3 if kept else 1
    axes.plot([low, high], [height, height], color=colour, linewidth=1.2, zorder=layer)
    mark = MARKS[point.config.surface]
    axes.plot([median], [height], mark, color=colour, markeredgecolor="white", markersize=11, zorder=layer)
    axes.annotate(
        f"{point.config.tick_ms}",
        (median, height),
        ha="center",
        va="center_baseline",
        fontsize=6,
        color="white",
        zorder=layer + 0.1,
    )


def _names(axes: "Axes", panel: Panel, named: list[tuple[Point, bool]]) -> None:
    """Names at the right of their marks, of dominated ones at the left where there is room; apart."""
    low, high = np.log10(axes.get_ylim())
    left, right = np.log10(axes.get_xlim())

    def across(speed: float) -> float:
        return float((np.log10(speed) - left) / (right - left))

    heights = [float((np.log10(max(point.error, panel.floor)) - low) / (high - low)) for point, _ in named]
    scale = APART / NEAREST
    places = [place / scale for place in spread_out([height * scale for height in heights])]
    for (point, kept), height, place in zip(named, heights, places, strict=True):
        _, slow, fast = point.speed
        colour = COLOURS[point.config.tier] if kept else DARK
        text = point.config.name + BESIDE.get(point.config, "")
        if point.config == TRUTH and point.error == 0.0:
            text += " (0)"
        elif point.error <= panel.floor:
            text += f", below {panel.floor:g} {panel.unit}"
        to_left = not kept and across(slow) > LETTER * len(text) + 0.05
        end, side = (across(slow), -1) if to_left else (across(fast), 1)
        end += side * 0.016
        x = end + side * 0.022
        axes.plot([end, x], [height, place], color=colour, linewidth=0.6, transform=axes.transAxes)
        axes.text(
            x + side * 0.004,
            place,
            text,
            color=colour,
            fontsize=8.5,
            ha="right" if to_left else "left",
            va="center",
            transform=axes.transAxes,
            zorder=5,
        )
