"""Section: how high a disc jump goes, by the time between the jump and the blast.

A light jumps from a plane with full energy and no other key; a disc bursts on the ground below him, 0 to
256 ms later, 0 being before the very tick of the jump. Heights of `reference` in ticks of 32 ms are those
of core/docs/physics.md, section 10.
"""

from functools import partial
from typing import Any

import numpy as np

from discjump._native import Terrain
from discjump.accuracy.scripts import TICK_MS as GAME_TICK_MS
from discjump.simulator import Simulator
from discjump_training.tradeoff.grid import Plan
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds
from discjump_training.tradeoff.store import Store, build, code

DELAYS_MS = tuple(GAME_TICK_MS * n for n in range(9))
"""Between the jump and the blast."""
SECONDS = 4.096
"""Played: the highest is up after 1.5 s."""


class Apex:
    """The section."""

    name = "apex"

    def work(self, plan: Plan) -> int:
        """Tiers times tick lengths."""
        return len(plan.tiers) * len(plan.tick_ms)

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Jump in what is not in the store."""
        base = {"build": build(), "code": code(__file__)}
        rows = []
        for tick_ms in plan.tick_ms:
            for tier in plan.tiers:
                identity = {**base, "tier": tier, "tick_ms": tick_ms}
                rows.append(store.piece(self.name, identity, partial(row, tier, tick_ms)))
                done(1)
        return {"delays_ms": list(DELAYS_MS), "rows": rows}

    def tables(self, made: Made) -> list[str]:
        """Heights by delay."""
        heads = [f"{delay}" for delay in made["delays_ms"]]
        lines = [
            "## Apex of a disc jump, m",
            "",
            "Light armor, from a plane, no jets; by the milliseconds between the jump and the blast on the "
            "ground below (0: before the very tick of the jump). Empty: no tick begins then.",
            "",
            f"| configuration | jump alone | {' | '.join(heads)} | best |",
            "|---" * (3 + len(heads)) + "|",
        ]
        for one in made["rows"]:
            heights = ["" if height is None else f"{height:.2f}" for height in one["apex"]]
            best = max(height for height in one["apex"] if height is not None)
            name = f"{one['tier']} {one['tick_ms']} ms"
            lines.append(f"| {name} | {one['jump_alone']:.2f} | {' | '.join(heights)} | {best:.2f} |")
        return [*lines, ""]

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """None."""
        return []


def row(tier: str, tick_ms: int) -> dict[str, Any]:
    """Heights over the plane, m, after the jump alone and for each delay; None where no tick begins."""
    fits = [delay % tick_ms == 0 for delay in DELAYS_MS]
    heights = apexes(tier, tick_ms, [delay for delay, fit in zip(DELAYS_MS, fits, strict=True) if fit])
    with_blast = iter(heights[1:])
    return {
        "tier": tier,
        "tick_ms": tick_ms,
        "jump_alone": heights[0],
        "apex": [next(with_blast) if fit else None for fit in fits],
    }


def apexes(tier: str, tick_ms: int, delays_ms: list[int]) -> list[float]:
    """The highest that feet get, m: after a jump alone, then for each delay of the blast."""
    plane = Terrain.from_heights(np.zeros((9, 9)))
    sim = Simulator(plane, 1 + len(delays_ms), "disc_jump", fidelity=tier, tick_ms=tick_ms)
    state = sim.state()
    # As if he had just touched the ground: he may jump at once.
    state["jump_age"] = 0
    sim.set_state(state)
    highest = np.zeros(sim.num_players)
    jump, none = sim.inputs(), sim.inputs()
    jump["jump"] = True
    for tick in range(round(1000 * SECONDS / tick_ms)):
        points = sim.state()["position"] * [1.0, 1.0, 0.0]
        points[0] = np.nan
        points[1:][[delay != tick * tick_ms for delay in delays_ms]] = np.nan
        sim.explode(points)
        sim.step(none if tick else jump)
        highest = np.maximum(highest, sim.state()["position"][:, 2])
    heights: list[float] = highest.tolist()
    return heights
