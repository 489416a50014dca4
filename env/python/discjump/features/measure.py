"""Outcomes of the same skiers in the whole game and with each feature left out."""

from collections.abc import Callable
from typing import Any

import numpy as np

from discjump._native import Terrain
from discjump.features.skier import TICK, Floats, Route, Run, run
from discjump.terrains import generated

SEEDS = (1000, 1001, 1002, 1003)
"""Of the terrains: none that anybody trains on by default."""
FEATURES = ("solids", "discs", "energy", "landing_damage", "jet", "jump")
"""What is left out in turn. `blast` is not among them (over bare ground nothing but discs explodes), nor is
`bump_limits` (a count that nothing reads)."""
APART = (1.0, 5.0, 20.0)
"""When paths are compared, s."""
BEACON = (300.0, 800.0)
"""How far away beacons are on the hills, m."""
CLEARANCE = 0.25
"""Of the feet above the ground at the start, m."""


def hills(rng: np.random.Generator, terrain: Terrain, count: int) -> Route:
    """From anywhere in the mission area to a beacon anywhere, 300 to 800 m away."""
    low, high = (np.array(corner) for corner in terrain.play_area)
    xy = rng.uniform(low, high, (count, 2)).astype(np.float32).astype(np.float64)
    bearing = rng.uniform(-np.pi, np.pi, count)
    away = rng.uniform(*BEACON, count)[:, None] * np.column_stack([np.sin(bearing), np.cos(bearing)])
    return Route(terrain, _above(terrain, xy), xy + away)


def bases(rng: np.random.Generator, terrain: Terrain, count: int) -> Route:
    """From 40 m before one base to the flag in the other: past the bridge, and in through the open side."""
    mission = terrain.mission
    assert mission is not None, "generated terrains have one"
    flags = mission["flags"][:, :2]
    way = np.arange(count) % 2
    to = flags[1 - way] - flags[way]
    ahead = to / np.linalg.norm(to, axis=1, keepdims=True)
    xy = flags[way] + 40.0 * ahead + rng.uniform(-8.0, 8.0, (count, 2))
    return Route(terrain, _above(terrain, xy.astype(np.float32).astype(np.float64)), flags[1 - way])


ROUTES: dict[str, Callable[[np.random.Generator, Terrain, int], Route]] = {"hills": hills, "bases": bases}
"""By name."""


def measure(starts: int, seconds: float, seed: int, done: Callable[[int], object]) -> list[dict[str, Any]]:
    """A row for each route and feature.

    Args:
        starts: skiers of each route, shared out among the terrains.
        seconds: how long they play.
        seed: draws the starts.
        done: is told the skiers of each batch that has played.
    """
    ticks = round(seconds / TICK)
    rows = []
    for name, make in ROUTES.items():
        runs: dict[str | None, list[Run]] = {feature: [] for feature in (None, *FEATURES)}
        for k, terrain in enumerate(SEEDS):
            count = starts // len(SEEDS) + (k < starts % len(SEEDS))
            route = make(np.random.default_rng([seed, k]), generated(terrain), count)
            for feature, of in runs.items():
                of.append(run(route, ticks, feature))
                done(count)
        for feature, of in runs.items():
            rows.append({"route": name, "left_out": feature, **compared(runs[None], of)})
    return rows


def compared(whole: list[Run], without: list[Run]) -> dict[str, Any]:
    """What the same skiers have without a feature, and how far that is from what they had with everything.

    Differences are medians over the skiers; those of times over who arrives in both.
    """
    arrived, before = (np.concatenate([run.arrived for run in runs]) for runs in (without, whole))
    both = (arrived >= 0) & (before >= 0)
    top, top_before = (_tops(runs) for runs in (without, whole))
    harm = np.concatenate([run.damage[-1] for run in without])
    apart = np.hstack([_apart(a, b) for a, b in zip(whole, without, strict=True)])
    return {
        "skiers": len(arrived),
        "arrived": float((arrived >= 0).mean()),
        "seconds": _median(TICK * arrived[arrived >= 0]),
        "seconds_changed": _median(TICK * (arrived - before)[both]),
        "top_speed": _median(top),
        "top_speed_changed": _median(top - top_before),
        "damage": _median(harm),
        "killed": float(np.concatenate([run.killed for run in without]).mean()),
        "apart": {
            f"{at:g}": _spread(apart[round(at / TICK)]) for at in APART if round(at / TICK) < len(apart)
        },
    }


def _apart(a: Run, b: Run) -> Floats:
    distance: Floats = np.linalg.norm(a.position - b.position, axis=2)
    return distance


def _tops(runs: list[Run]) -> Floats:
    return np.concatenate([run.speed.max(axis=0) for run in runs])


def _median(values: Floats) -> float | None:
    return float(np.median(values)) if len(values) else None


def _spread(values: Floats) -> dict[str, float]:
    median, ninth = np.quantile(values, [0.5, 0.9]).tolist()
    return {"median": median, "p90": ninth, "over_1_m": float((values > 1.0).mean())}


def _above(terrain: Terrain, xy: Floats) -> Floats:
    return np.column_stack([xy, terrain.height(xy) + CLEARANCE])
