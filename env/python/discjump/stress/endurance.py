"""Ticks without pause: skiers on tiling hills, and players who fall until their ages stand still."""

from collections.abc import Callable
from typing import Any

import numpy as np

from discjump.simulator import Simulator
from discjump.stress import grounds
from discjump.stress.cases import Column, Setting, Start
from discjump.stress.checks import judge
from discjump.stress.expected import expected
from discjump.stress.extremes import anywhere
from discjump.stress.floor import Floor
from discjump.stress.play import Record, place, simulator
from discjump.stress.rules import OLDEST, Rows
from discjump.stress.starts import generator, keys
from discjump.terrains import generated

HEADER = {
    "player_ticks": "player-ticks",
    "samples": "ticks asked",
    "contacts": "with contact",
    "fell": "fell out, put back",
    "farthest": "farthest, m",
    "fastest": "fastest, m/s",
    "age": "oldest age",
}
SKIERS, FALLERS = 12, 4
HELD = 199
"""Ticks between two that are asked, in which the keys are held."""
JUDGED = 2000
"""Samples that are judged at once."""
ENGINE_FALL = 1000
"""Ticks of a second that are fallen in `engine`: it cuts a path into decimetres, and a fall of t seconds
takes t^2 / 2 of them."""
LOST = 500.0
"""So far below the lowest ground one is put back, m."""


def endure(column: Column, ticks: int, seed: int, done: Callable[[float], object]) -> dict[str, Any]:
    """Play a tier for so many ticks, and ask one in 200 all that the matrix asks."""
    skiers = ski(column, ticks, seed, lambda share: done(0.8 * share))
    fallen = min(ticks, ENGINE_FALL) if column.tier == "engine" else ticks
    age, wrong = fall(column, fallen)
    done(1.0)
    skiers["failures"] += wrong
    return {**skiers, "player_ticks": ticks * SKIERS + fallen * FALLERS, "age": age}


def ski(column: Column, ticks: int, seed: int, done: Callable[[float], object]) -> dict[str, Any]:
    """Skiers with drawn keys on a generated terrain; one of them begins 1e9 m away."""
    terrain = generated(7).with_surface(column.surface)
    setting = Setting()
    rng = generator(seed, "endurance")
    start = anywhere(rng, terrain, SKIERS, 1, within=900.0)
    tiles = np.floor(9.9e8 / np.array(terrain.size))
    start.position[0, :2] += tiles * terrain.size
    sim = simulator(terrain, column, setting, SKIERS)
    place(sim, start)
    fresh = sim.state()
    lowest = Floor(terrain).lowest - LOST
    samples: list[tuple[Rows, Rows, Rows]] = []
    seen = {"samples": 0, "contacts": 0, "fell": 0}
    farthest, fastest, failures = 0.0, 0.0, list[str]()
    for tick in range(0, ticks, HELD + 1):
        inputs = keys(rng, 1, SKIERS)[0]
        sim.step(inputs, HELD)
        before = sim.state()
        sim.step(inputs)
        after = sim.state()
        samples.append((before, after, inputs))
        fastest = max(fastest, float(np.abs(after["velocity"]).max()))
        farthest = max(farthest, float(np.abs(after["position"][1:, :2]).max()))
        seen["contacts"] += int(after["touched"].sum())
        lost = np.flatnonzero(after["position"][:, 2] < lowest)
        if lost.size:
            seen["fell"] += lost.size
            sim.set_state(fresh[lost], lost)
        if len(samples) == JUDGED or tick + HELD + 1 >= ticks:
            failures += judged(column, setting, sim, terrain, samples, start)
            seen["samples"] += len(samples) * SKIERS
            samples = []
            done((tick + HELD + 1) / ticks)
    # Who falls out of the world in the tiers that hold everybody is a failure, not a figure.
    if seen["fell"] and column.tier not in ("engine", "anyway", "swept"):
        failures.append(f"{seen['fell']} fell out of the world")
    return {**seen, "farthest": round(farthest), "fastest": round(fastest, 1), "failures": failures}


def judged(
    column: Column,
    setting: Setting,
    sim: Simulator,
    terrain: Any,
    samples: list[tuple[Rows, Rows, Rows]],
    start: Start,
) -> list[str]:
    """What was found in these ticks and is not expected."""
    before, after, inputs = (np.stack(rows) for rows in zip(*samples, strict=True))
    asked = Start(start.position, start.velocity, inputs)
    record = Record(
        column,
        setting,
        terrain,
        asked,
        np.concatenate([before[:1], after]),
        before,
        np.zeros(before.shape),
        sim.digest(),
    )
    return [
        f"{finding.check} by {finding.worst:.3g} in {finding.count} ticks"
        for finding in judge(record)
        if expected(column, "long/skiers", finding) is None
    ]


def fall(column: Column, ticks: int) -> tuple[int, list[str]]:
    """Players beside a map with nothing behind it, in ticks of a second: the last age, and what is wrong."""
    terrain = grounds.one_square("void").with_surface(column.surface)
    sim = simulator(terrain, column, Setting(tick_ms=1000), FALLERS)
    state = sim.state()
    state["position"][:, 0] = 1e4
    state["jump_age"][0] = OLDEST - 5
    sim.set_state(state)
    wrong: list[str] = []
    inputs = sim.inputs()
    pieces = 20
    last = state["jump_age"].astype(np.int64)
    for _ in range(pieces):
        sim.step(inputs, ticks // pieces)
        state = sim.state()
        age = state["jump_age"].astype(np.int64)
        step = 1 if column.tier == "engine" else 1000
        counted = np.minimum(last + step * (ticks // pieces), OLDEST)
        if (age != counted).any():
            wrong.append(f"ages {age.tolist()}, expected {counted.tolist()}")
        last = age
        numbers = [state[name] for name in ("position", "velocity", "energy", "friction", "jump_normal")]
        if not all(np.isfinite(values).all() for values in numbers):
            wrong.append("a number that is none while falling")
    return int(last.max()), wrong
