"""The picture of a record: a row for each extreme, a column for each tier, precision and surface."""

from pathlib import Path
from typing import Any

COLOURS = {
    "pass": "#cfe8d5",
    "expected failure": "#f3d9a4",
    "FAIL": "#c0392b",
    "unexpectedly passes": "#8fb7e3",
}
"""Of the cells."""
SIGNS = {"pass": "", "expected failure": "x", "FAIL": "FAIL", "unexpectedly passes": "?"}
"""In the cells, for eyes that cannot tell the colours."""


def draw(record: dict[str, Any], path: Path) -> None:
    """Draw the picture as a PNG."""
    from matplotlib.figure import Figure  # the command alone needs it
    from matplotlib.patches import Patch, Rectangle

    cells = record["cells"]
    columns = list(dict.fromkeys((cell["tier"], cell["precision"], cell["surface"]) for cell in cells))
    rows = record["extremes"]
    figure = Figure(figsize=(2.6 + 0.46 * len(columns), 2.2 + 0.27 * len(rows)), layout="constrained")
    axes = figure.subplots()
    for cell in cells:
        x = columns.index((cell["tier"], cell["precision"], cell["surface"]))
        y = rows.index(cell["extreme"])
        axes.add_patch(
            Rectangle((x, y), 1, 1, facecolor=COLOURS[cell["status"]], edgecolor="white", linewidth=1.2)
        )
        axes.text(x + 0.5, y + 0.5, SIGNS[cell["status"]], ha="center", va="center", fontsize=7)
    axes.set_xlim(0, len(columns))
    axes.set_ylim(len(rows), 0)
    axes.set_yticks([y + 0.5 for y in range(len(rows))], rows, fontsize=8)
    axes.set_xticks(
        [x + 0.5 for x in range(len(columns))],
        [f"f{precision[5:]} {surface[:3]}" for _, precision, surface in columns],
        fontsize=7,
        rotation=90,
    )
    axes.tick_params(length=0)
    axes.xaxis.tick_top()
    axes.spines[:].set_visible(False)
    tiers = [tier for tier, _, _ in columns]
    for tier in dict.fromkeys(tiers):
        first, count = tiers.index(tier), tiers.count(tier)
        axes.text(
            first + 0.5 * count,
            len(rows) + 0.25,
            tier,
            ha="center",
            va="top",
            fontsize=9,
            fontweight="bold",
        )
        if first:
            axes.plot([first, first], [0, len(rows)], color="0.4", linewidth=1.0)
    present = dict.fromkeys(cell["status"] for cell in cells)
    axes.legend(
        handles=[
            Patch(color=COLOURS[status], label=f"{status} {SIGNS[status]}".strip()) for status in present
        ],
        loc="upper center",
        bbox_to_anchor=(0.5, -0.03),
        ncols=len(present),
        frameon=False,
        fontsize=8,
    )
    figure.savefig(path, dpi=110)
