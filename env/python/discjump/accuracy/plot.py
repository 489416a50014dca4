"""The picture of a record: position error over time, a panel for each situation, a line for each tier."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = {
    "reference": "black",
    "authentic": "#0072b2",
    "swept": "#009e73",
    "fast": "#d55e00",
    "engine": "#cc79a7",
    "anyway": "#b8860b",
    "nudged": "0.45",
}
"""Of the tiers; told apart by colour-blind eyes too."""
LOWEST, HIGHEST = 1e-5, 1e3
"""Ends of the axis of errors, m: what is smaller lies on its lower end."""
LENGTHS = {
    1e-5: "10 µm",
    1e-4: "0.1 mm",
    1e-3: "1 mm",
    1e-2: "1 cm",
    1e-1: "10 cm",
    1e0: "1 m",
    1e1: "10 m",
    1e2: "100 m",
    1e3: "1 km",
}
"""Marks of the axis of errors."""
COLUMNS = 4
APART = 0.42
"""Between names at the right of a panel, in powers of ten."""


def draw(record: dict[str, Any], path: Path) -> None:
    """Draw the picture as a PNG."""
    from matplotlib.figure import Figure  # the command alone needs it

    names = list(record["situations"])
    columns = min(COLUMNS, len(names))
    lines = -(-len(names) // columns)
    figure = Figure(figsize=(3.9 * columns + 0.6, 3.3 * lines + 0.9), layout="constrained")
    grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    for axes, name in zip(grid.flat, names, strict=False):
        of = [curve for curve in record["curves"] if curve["situation"] == name]
        panel(axes, record["curve_seconds"], of)
        axes.set_title(name, loc="left", fontweight="bold")
    for axes in grid.flat[len(names) :]:
        axes.set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("position error")
    for column in range(columns):
        last = max(line for line in range(lines) if line * columns + column < len(names))
        grid[last, column].set_xlabel("time, s")
        grid[last, column].xaxis.set_tick_params(labelbottom=True)
    figure.suptitle(
        f"How far each tier is from reference: median of {record['starts']} starts (solid) "
        "and 95th percentile (dotted)"
    )
    figure.savefig(path, dpi=100)


def panel(axes: "Axes", seconds: list[float], curves: list[dict[str, Any]]) -> None:
    """The tiers in one situation, each named at its end."""
    from matplotlib.ticker import NullLocator

    axes.set_yscale("log")
    axes.set_ylim(LOWEST, HIGHEST)
    axes.set_yticks(list(LENGTHS), list(LENGTHS.values()))
    axes.yaxis.set_minor_locator(NullLocator())
    end = seconds[-1]
    # Room for the names.
    axes.set_xlim(0.0, 1.42 * end)
    axes.set_xticks(np.linspace(0.0, end, 5))
    for length in LENGTHS:
        axes.plot([0.0, end], [length, length], color="0.9", linewidth=0.7, zorder=0)
    for curve in curves:
        colour = COLOURS[curve["tier"]]
        style = "dashed" if curve["tier"] == "nudged" else "solid"
        axes.plot(seconds, np.maximum(curve["median"], LOWEST), color=colour, linestyle=style, linewidth=1.7)
        p95 = np.maximum(curve["p95"], LOWEST)
        axes.plot(seconds, p95, color=colour, linestyle="dotted", linewidth=1.0)
    heights = [np.log10(max(curve["median"][-1], LOWEST)) for curve in curves]
    for curve, height, label in zip(curves, heights, spread_out(heights), strict=True):
        colour = COLOURS[curve["tier"]]
        axes.plot([end, 1.04 * end], [10.0**height, 10.0**label], color=colour, linewidth=0.7)
        axes.text(1.05 * end, 10.0**label, curve["tier"], color=colour, fontsize=8.5, va="center")
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines["bottom"].set_bounds(0.0, end)


def spread_out(heights: list[float]) -> list[float]:
    """Heights at least `APART` from each other, in the same order, as near to those given as that allows.

    >>> spread_out([3.0, 1.0]), [round(h, 2) for h in spread_out([0.0, 0.0])]
    ([3.0, 1.0], [-0.21, 0.21])
    """
    order = np.argsort(heights, kind="stable")
    # Groups of names that touch share the middle of the places they would like to have.
    groups: list[list[float]] = []
    for wanted in np.asarray(heights, np.float64)[order]:
        groups.append([float(wanted)])
        while len(groups) > 1 and _bottom(groups[-1]) - _top(groups[-2]) < APART:
            last = groups.pop()
            groups[-1] += last
    placed = np.empty(len(heights))
    placed[order] = [_bottom(group) + APART * k for group in groups for k in range(len(group))]
    return placed.tolist()


def _bottom(group: list[float]) -> float:
    return sum(group) / len(group) - 0.5 * APART * (len(group) - 1)


def _top(group: list[float]) -> float:
    return _bottom(group) + APART * (len(group) - 1)
