"""What explosions set off by hand may do, by the closed form of core/docs/physics.md, section 6."""

import numpy as np

from discjump.simulator import SCENES
from discjump.stress.checks import Finding, rules_of
from discjump.stress.floor import Floor
from discjump.stress.play import Record
from discjump.stress.rules import Bools, Floats

RADIUS, KICK, DAMAGE = 7.5, 150.0, 0.5
"""Of a disc."""
BURIED = 0.05
"""A point deeper below bare ground than this, m, is felt by nobody (section 12)."""
BESIDE = 1e-3
"""So near to where an explosion ends, m, it may be felt or not."""


def pushes(away: Floats, mass: float, width: float, height: float) -> tuple[Floats, Bools]:
    """Changes of speed (n, 3), m/s, of bodies with middles `away` from a point, and whether they are certain.

    The Tribes form: kick / mass times (1 - d / R) (c - B) / d with d = max(d0 - m, 1), for boxes that meet
    the cube of half side R, and d < R.

    >>> dv, sure = pushes(np.array([[0.0, 0.0, 1.15], [0.0, 0.0, 0.0]]), 9.0, 0.5, 2.3)
    >>> dv[:, 2].round(2).tolist(), sure.tolist()
    ([16.61, 0.0], [True, True])
    """
    d0 = np.linalg.norm(away, axis=1)
    d = np.maximum(d0 - min(2.0 * width, height), 1.0)
    edges = np.array([width, width, 0.5 * height]) + RADIUS
    over = (np.abs(away) - edges).max(axis=1)
    felt = (over <= 0.0) & (d < RADIUS)
    power = np.where(felt, (1.0 - d / RADIUS) / d, 0.0)
    sure = (np.abs(over) > BESIDE) | (d >= RADIUS + BESIDE)
    return away * (KICK / mass * power)[:, None], sure


def blasts(record: Record) -> Finding | None:
    """How far the push of an explosion is from the closed form, m/s; over solids, how far beyond it."""
    rules = rules_of(record)
    armor, eps = rules.armor, record.column.eps
    per_world = record.setting.players_per_world
    floor = Floor(record.terrain)
    solids = "solids" in SCENES[record.setting.scene].models
    found: list[tuple[int, int, float]] = []
    for tick, points in record.start.blasts.items():
        before, after = record.states[tick], record.begun[tick]
        got = after["velocity"].astype(np.float64) - before["velocity"].astype(np.float64)
        middle = before["position"] + (0.0, 0.0, 0.5 * armor.height)
        expected, sizes = np.zeros_like(got), np.zeros(len(got))
        sure = np.ones(len(got), bool)
        worlds = points.reshape(-1, per_world, 3)
        under = np.nan_to_num(floor.height(points[:, :2].copy()) - points[:, 2], nan=-1.0)
        under = under.reshape(-1, per_world)
        for k in range(per_world):
            at = np.repeat(worlds[:, k], per_world, axis=0)
            deep = np.repeat(under[:, k], per_world)
            push, certain = pushes(middle - at, armor.mass, armor.half_width, armor.height)
            push = np.where((deep > BURIED)[:, None] & ~np.array(solids), 0.0, push)
            expected += push
            size = np.linalg.norm(push, axis=1)
            sizes += size
            sure &= certain & ((np.abs(deep - BURIED) > BESIDE) | (size == 0.0))
        speed = np.linalg.norm(after["velocity"].astype(np.float64), axis=1)
        # A place is rounded, and a push grows by at most kick / mass for each metre.
        place = np.linalg.norm(before["position"] - [*_middle(record), 0.0], axis=1)
        slack = (
            eps * (16.0 * per_world**0.5 * (sizes + speed) + 8.0 * KICK / armor.mass * per_world * place)
            + 1e-9
        )
        off = np.linalg.norm(got, axis=1) - sizes if solids else np.linalg.norm(got - expected, axis=1)
        excess = np.where(sure | np.array(solids), off - slack, 0.0)
        worst = np.flatnonzero(excess > 0.0)
        found += [(tick, int(player), float(excess[player])) for player in worst]
    if not found:
        return None
    tick, player, _ = min(found)
    return Finding("blast", max(excess for *_, excess in found), len(found), tick, player)


def _middle(record: Record) -> list[float]:
    """Where local coordinates count from."""
    (west, south), (width, height) = record.terrain.origin, record.terrain.size
    return [west + 0.5 * width, south + 0.5 * height]
