"""The Markdown of a record: everything in it comes from the JSON beside it."""

from collections import Counter
from typing import Any

MARKS = {"pass": "·", "expected failure": "x", "FAIL": "**FAIL**", "unexpectedly passes": "?"}
MOST_SHOWN = 40
"""Failures in the report."""


def render(record: dict[str, Any]) -> str:
    """The whole report."""
    machine, versions = record["machine"], record["versions"]
    described = ", ".join(f"{name} {number}" for name, number in versions.items())
    counts = Counter(cell["status"] for cell in record["cells"])
    lines = [
        "# Stress matrix",
        "",
        f"    {record['command']}",
        "",
        f"{machine['processor']}, {machine['cores']} cores, Python {machine['python']}, {described}; "
        f"{record['player_ticks']:,} player-ticks in {record['took_seconds']:.0f} s. "
        f"Ground: {record['ground']}.",
        "",
        f"Of {len(record['cells'])} cells: "
        + ", ".join(f"{counts[status]} {status}" for status in MARKS)
        + ".",
        "",
        *table(record),
        "",
        "· passes, x fails as expected (below), **FAIL** fails, ? passes although it was expected to fail. "
        "32, 64: float32, float64; T, B: triangles, bilinear.",
    ]
    lines += reasons(record)
    lines += failures(record)
    return "\n".join([*lines, ""])


def table(record: dict[str, Any]) -> list[str]:
    """A row for each extreme, a column for each tier, precision and surface."""
    columns = list(
        dict.fromkeys((cell["tier"], cell["precision"], cell["surface"]) for cell in record["cells"])
    )
    of = {
        (cell["extreme"], (cell["tier"], cell["precision"], cell["surface"])): cell["status"]
        for cell in record["cells"]
    }
    names = [f"{tier} {precision[5:]}{surface[0].upper()}" for tier, precision, surface in columns]
    lines = [f"| extreme | {' | '.join(names)} |", "|---|" + ":-:|" * len(columns)]
    for extreme in record["extremes"]:
        marks = " | ".join(MARKS[of[extreme, column]] for column in columns)
        lines.append(f"| {extreme} | {marks} |")
    return lines


def reasons(record: dict[str, Any]) -> list[str]:
    """The expected failures: why, and the worst of each tier and extreme."""
    worst: dict[str, dict[tuple[str, str, str], float]] = {}
    for cell in record["cells"]:
        for finding in cell["findings"]:
            if finding["reason"] is not None:
                of = worst.setdefault(finding["reason"], {})
                key = (cell["tier"], finding["check"], cell["extreme"])
                of[key] = max(of.get(key, 0.0), finding["worst"])
    if not worst:
        return []
    lines = ["", "## Expected failures", ""]
    for reason, of in worst.items():
        lines.append(f"- {record['reasons'][reason]}")
        metres = ", ".join(f"{extreme} {number(value)}" for (_, _, extreme), value in of.items())
        lines.append(f"  Deepest beyond the bound, m: {metres}.")
    return lines


def failures(record: dict[str, Any]) -> list[str]:
    """What was not expected, each with the command that plays it again."""
    lines = []
    for cell in record["cells"]:
        for finding in cell["findings"]:
            if finding["reason"] is None:
                lines.append(f"- {sentence(cell, finding)}")
                lines.append(f"  `{finding['replay']}`" if finding["replay"] else "")
    if len(lines) > 2 * MOST_SHOWN:
        lines = [*lines[: 2 * MOST_SHOWN], f"- and {len(lines) // 2 - MOST_SHOWN} more, in the JSON"]
    return ["", "## Failures", "", *lines] if lines else []


def sentence(cell: dict[str, Any], finding: dict[str, Any]) -> str:
    """One finding in words."""
    where = f"{cell['tier']} {cell['precision']} {cell['surface']}"
    return (
        f"{where}, {cell['extreme']}/{finding['case']}: {finding['check']} by {number(finding['worst'])} in "
        f"{finding['count']} player-ticks, first in tick {finding['tick']} of player {finding['player']}"
    )


def number(value: float) -> str:
    """Two significant digits.

    >>> [number(value) for value in (0.0123, 3.14, 12345.0)]
    ['0.012', '3.1', '1.2e+04']
    """
    return f"{value:.2g}"
