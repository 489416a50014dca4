"""Section: how far a path is from the truth, from the same start with the same keys."""

from collections.abc import Iterator
from functools import partial
from typing import Any

import discjump.accuracy
from discjump.accuracy.measure import NUDGE
from discjump.accuracy.report import number
from discjump.accuracy.situations import SITUATIONS
from discjump_training.tradeoff import paths as measuring
from discjump_training.tradeoff.grid import TRUTH, Config, Plan
from discjump_training.tradeoff.paths import LIMITS, NUDGED, SAMPLE_MS, SEED, TOLD, Paths, compared, told
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds, points
from discjump_training.tradeoff.store import Store, build, code

FLOOR = 1e-4
"""Of the picture's error axis, m."""


class Errors:
    """The section."""

    name = "errors"

    def work(self, plan: Plan) -> int:
        """Plays: of a situation in a configuration."""
        return len(list(pieces(plan)))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Play what is not in the store, and compare."""
        paths = Paths(plan)
        base = {
            "starts": plan.starts,
            "seconds": plan.seconds,
            "seed": SEED,
            "build": build(),
            "code": code(discjump.accuracy, measuring),
        }
        rows: list[dict[str, Any]] = []
        for situation, config in pieces(plan):
            identity = {**base, "situation": situation, **config.keys}
            rows += store.piece(self.name, identity, partial(compared, paths, situation, config))
            done(1)
        return {
            "truth": TRUTH.keys,
            "starts": plan.starts,
            "seconds": [round(sample * SAMPLE_MS / 1000, 3) for _, sample in told(plan.seconds)],
            "nudge": NUDGE,
            "situations": {name: SITUATIONS[name].what for name in _situations(plan)},
            "rows": rows,
        }

    def tables(self, made: Made) -> list[str]:
        """Errors from the truth and within the own game, then when limits are passed."""
        last = f"{made['seconds'][-1]:g}"
        times = " / ".join(f"{seconds:g}" for seconds in made["seconds"])
        lines = [
            "## Trajectory error",
            "",
            f"{made['starts']} starts a situation; the same keys, as functions of time, which do not look at "
            f"the state. `{NUDGED}` is no tier but the yardstick: the truth from a start {1000 * NUDGE:g} mm "
            "aside.",
            "",
            *[f"- **{name}**: {what}" for name, what in made["situations"].items()],
            "",
        ]
        rows = {error: [row for row in made["rows"] if row["error"] == error] for error in TOLD}
        lines += [f"### Position error {TOLD['truth']} after {times} s, m: median", ""]
        lines += _grid(rows["truth"], _medians)
        for error, said in TOLD.items():
            lines += ["", f"### Position error {said}, after {last} s, m: median (95th percentile)", ""]
            lines += _grid(rows[error], _spread)
        lines.append("")
        limits = " / ".join(_length(limit) for limit in LIMITS)
        lines += [
            f"### Seconds until {limits} from the truth: median over starts (share that got there, %)",
            "",
            f"\u201c>{last}\u201d: fewer than half of the starts got there in the {last} s played.",
            "",
            *_grid(
                rows["truth"],
                lambda row: " / ".join(_until(row["until"][f"{limit:g}"], last) for limit in LIMITS),
            ),
            "",
        ]
        return lines

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """Median and 95th percentile at the end of `ski`."""
        rows = [
            row
            for row in made["rows"]
            if (row["situation"], row["error"]) == ("ski", "truth") and row["tier"] != NUDGED
        ]
        if not rows:
            return []
        seconds = made["seconds"][-1]
        return [
            Panel(
                f"Path of a skier after {seconds:.0f} s: {said}",
                "physics alone",
                "distance from the truth",
                "m",
                points({Config.of(row): row["at"][-1]["position"][name] for row in rows}, speeds.physics),
                FLOOR,
            )
            for name, said in (("median", "median"), ("p95", "95th percentile"))
        ]


def pieces(plan: Plan) -> Iterator[tuple[str, Config]]:
    """Situations and configurations, those next to each other that are compared with the same paths."""
    for situation in _situations(plan):
        yield situation, Config(NUDGED)
        for config in plan.configs():
            yield situation, config


def _situations(plan: Plan) -> tuple[str, ...]:
    return plan.situations or tuple(SITUATIONS)


def _grid(rows: list[dict[str, Any]], cell: Any) -> list[str]:
    """A line for each configuration, a column for each situation."""
    names = list(dict.fromkeys(row["situation"] for row in rows))
    cells: dict[Config, list[str]] = {}
    for row in rows:
        cells.setdefault(Config.of(row), []).append(cell(row))
    return [
        f"| configuration | {' | '.join(names)} |",
        "|---" * (1 + len(names)) + "|",
        *(f"| {NUDGED if c.tier == NUDGED else c.name} | {' | '.join(of)} |" for c, of in cells.items()),
    ]


def _medians(row: dict[str, Any]) -> str:
    return " / ".join(number(at["position"]["median"]) for at in row["at"])


def _spread(row: dict[str, Any]) -> str:
    position = row["at"][-1]["position"]
    return f"{number(position['median'])} ({number(position['p95'])})"


def _until(times: dict[str, float | None], last: str) -> str:
    median, share = times["median"], times["share"]
    assert share is not None
    return f"{f'>{last}' if median is None else f'{median:.1f}'} ({100 * share:.0f})"


def _length(limit: float) -> str:
    """1 cm, 10 cm, 1 m.

    >>> [_length(limit) for limit in LIMITS]
    ['1 cm', '10 cm', '1 m']
    """
    return f"{limit:g} m" if limit >= 1.0 else f"{100 * limit:g} cm"
