"""Section: instructions of a player-tick, exact and the same on a busy machine as on an idle one.

Counted by callgrind where valgrind is installed, one player at a time and eight side by side (AVX2). Tiers
without lanes are counted one at a time alone. callgrind takes seconds to start, so that a piece of work is
all tiers of a tick length and surface.
"""

from functools import partial
from typing import Any

from discjump.bench import instructions as counting
from discjump.bench import ways
from discjump.bench.clock import Unavailable
from discjump.bench.ways import Players
from discjump_training.tradeoff.grid import DECISION_MS, TRUTH, Config, Plan
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds
from discjump_training.tradeoff.speed import digits
from discjump_training.tradeoff.store import Store, build, code

NAME = "instructions"
LANES = (1, 8)
ALONE = (TRUTH.tier, "engine")
"""Tiers without lanes."""
PLAYERS, QUICK_PLAYERS = 256, 32
CALLS = 16
"""Decisions that are counted: 2 s of game."""

Cases = list[tuple[dict[str, Any], Players]]


class Instructions:
    """The section."""

    name = NAME

    def work(self, plan: Plan) -> int:
        """Counts."""
        return sum(len(group) for group in groups(plan))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Count what is not in the store; without valgrind nothing is, and the result says why."""
        rows: list[dict[str, Any]] = []
        for group in groups(plan):
            cases = [case for _, case in group]
            told: list[int] = []

            def one(units: int, told: list[int] = told) -> None:
                told.append(units)
                done(units)

            identity = {
                "cases": [repr(case) for case in cases],
                "calls": CALLS,
                "build": build(),
                "code": code(counting, ways),
            }
            make = partial(counting.count, cases, calls=CALLS, progress=one)
            try:
                counts = store.piece(self.name, identity, make)
            except Unavailable as why:
                return {"missing": str(why), "rows": []}
            done(len(cases) - sum(told))
            for (head, _), count in zip(group, counts, strict=True):
                per_second = count * 1000 / head["tick_ms"]
                rows.append({**head, "per_player_tick": count, "per_player_second": per_second})
        return {"rows": rows}

    def tables(self, made: Made) -> list[str]:
        """By configuration."""
        lines = ["## Instructions", ""]
        if "missing" in made:
            return [*lines, f"Not counted: {made['missing']}.", ""]
        lines += [
            f"Scene `ski`, random keys held for {DECISION_MS} ms, {CALLS * DECISION_MS / 1000:g} s of game, "
            "counted by callgrind: instructions of a player's tick, and thousands in a second of his game. "
            f"One player at a time, and {LANES[-1]} side by side.",
            "",
            "| configuration | tick | tick, side by side | thousand a second | side by side |",
            "|---|---|---|---|---|",
        ]
        cells: dict[Config, dict[int, dict[str, Any]]] = {}
        for row in made["rows"]:
            cells.setdefault(Config.of(row), {})[row["lanes"]] = row
        for config, of in cells.items():
            shown = [digits(of[lanes]["per_player_tick"]) if lanes in of else "" for lanes in LANES]
            shown += [digits(of[lanes]["per_player_second"] / 1e3) if lanes in of else "" for lanes in LANES]
            lines.append(f"| {config.name} | {' | '.join(shown)} |")
        return [*lines, ""]

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """None: its tables stand beside the clock's."""
        return []


def groups(plan: Plan) -> list[Cases]:
    """What is counted in one go, with the beginnings of its rows."""
    found: dict[tuple[int, str] | None, Cases] = {}
    for config in plan.configs():
        group = None if plan.quick else (config.tick_ms, config.surface)
        for lanes in LANES:
            if lanes == 1 or config.tier not in ALONE:
                head = {**config.keys, "lanes": lanes}
                found.setdefault(group, []).append((head, _case(config, lanes, plan)))
    return list(found.values())


def _case(config: Config, lanes: int, plan: Plan) -> Players:
    return Players(
        QUICK_PLAYERS if plan.quick else PLAYERS,
        1,
        lanes,
        fidelity=config.tier,
        tick_ms=config.tick_ms,
        surface=config.surface,
        ticks=DECISION_MS // config.tick_ms,
    )
