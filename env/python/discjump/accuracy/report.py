"""The Markdown of a record: everything in it comes from the JSON beside it."""

from collections.abc import Callable
from typing import Any

Row = dict[str, Any]

NOTES = {
    "reference": "float64, sliced: the truth, here against itself",
    "authentic": "float32, sliced: the default",
    "swept": "float32, one sweep and a fix-up",
    "fast": "float32, one contact a tick",
    "engine": "float32, the 1998 loop: another model, whose paths are not meant to agree",
    "anyway": "float32, the literal reading, which tunnels: for measurement only",
    "nudged": "no tier but the yardstick: `reference` from a start 1 mm further east",
}
"""What each tier is, in a line."""


def render(record: dict[str, Any]) -> str:
    """The whole report."""
    rows = record["rows"]
    limits = list(rows[0]["over"])
    machine, versions = record["machine"], record["versions"]
    described = ", ".join(f"{name} {number}" for name, number in versions.items())
    return "\n".join(
        [
            "# Accuracy of the fidelity tiers",
            "",
            f"    {record['command']}",
            "",
            f"{machine['processor']}, {machine['cores']} cores, Python {machine['python']}, {described}. "
            f"{record['starts']} starts for each situation, seed {record['seed']}, ticks of "
            f"{record['tick_ms']} ms.",
            "",
            "Every tier plays the same starts, float32 numbers, with the same keys, decided beforehand. An "
            "error is what it is away from `reference` at the same tick: the distance between the positions, "
            "and the difference of the speeds without its sign.",
            "",
            *[f"- `{tier}`: {NOTES[tier]}" for tier in record["tiers"]],
            "",
            *[f"- **{name}**: {about['what']}" for name, about in record["situations"].items()],
            "",
            "## Position error, m: median (95th percentile)",
            "",
            *table(rows, lambda row: _pair(row["position"])),
            "",
            "## Speed error, m/s: median (95th percentile)",
            "",
            *table(rows, lambda row: _pair(row["speed"])),
            "",
            f"## Starts with a position error of more than {' / '.join(limits)} m, %",
            "",
            *table(rows, lambda row: " / ".join(f"{100 * row['over'][limit]:.0f}" for limit in limits)),
            "",
        ]
    )


def table(rows: list[Row], cell: Callable[[Row], str]) -> list[str]:
    """Lines of a table: a row for each situation and tier, a column for each time.

    >>> rows = [{"situation": "ski", "tier": "fast", "seconds": s, "x": s * s} for s in (1.0, 5.0)]
    >>> print(*table(rows, lambda row: number(row["x"])), sep="\\n")
    | situation | tier | 1 s | 5 s |
    |---|---|---|---|
    | ski | fast | 1 | 25 |
    """
    times = list(dict.fromkeys(row["seconds"] for row in rows))
    lines = [
        f"| situation | tier | {' | '.join(f'{seconds:g} s' for seconds in times)} |",
        "|---|---|" + "---|" * len(times),
    ]
    cells: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        cells.setdefault((row["situation"], row["tier"]), []).append(cell(row))
    lines += [f"| {situation} | {tier} | {' | '.join(of)} |" for (situation, tier), of in cells.items()]
    return lines


def number(value: float) -> str:
    """Two significant digits; a whole number from 10 on.

    >>> [number(value) for value in (0.0, 3.14159e-7, 0.0314159, 3.14159, 314.159)]
    ['0', '3.1e-07', '0.031', '3.1', '314']
    """
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def _pair(spread: dict[str, float]) -> str:
    return f"{number(spread['median'])} ({number(spread['p95'])})"
