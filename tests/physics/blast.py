"""Explosions in plain float64 Python, from the text of core/docs/physics.md alone (sections 6 and 12)."""

import math
from dataclasses import dataclass

from .article import Armor, Player
from .ground import Surface, Vec, along, dot

#: Meets the peak of `tribes` at 2 m, for a radius of 7.5 m and a light player.
LINEAR_BOOST = 26.0 / 11.0
#: m below the surface from which on the ground covers everyone.
COVER_DEPTH = 0.05


@dataclass(frozen=True)
class Charge:
    """An explosion's strength: appendix and section 6."""

    damage: float
    radius: float
    kick: float
    kind: int = 0
    """Which of an armor's factors counts: explosion, shrapnel, mortar."""


DISC = Charge(0.5, 7.5, 150.0)
GRENADE = Charge(0.4, 15.0, 150.0, kind=1)
MORTAR = Charge(1.0, 20.0, 250.0, kind=2)


def min_box(armor: Armor) -> float:
    return min(2.0 * armor.half_width, armor.height)


def eased(d0: float, m: float) -> float:
    """The distance that counts: at least 1 m, the smallest side of the box already taken off."""
    return max(d0 - m, 1.0)


def power(d0: float, formula: str, radius: float, m: float, cutoff: str = "engine") -> float:
    """Share of the kick at distance `d0` from the box's centre."""
    if cutoff == "radius" and d0 > radius:
        return 0.0
    if formula == "tribes":
        d = eased(d0, m)
        return d0 / d - d0 / radius if d < radius else 0.0
    boost = {"basic": 1.0, "linear_boosted": LINEAR_BOOST}[formula]
    return max(0.0, boost * (1.0 - d0 / radius))


def harm(d0: float, charge: Charge, m: float, cutoff: str = "engine") -> float:
    """Damage before the armor's factor."""
    d = eased(d0, m)
    if d >= charge.radius or (cutoff == "radius" and d0 > charge.radius):
        return 0.0
    return charge.damage * (1.0 - d / charge.radius)


def covered(point: Vec, ground: Surface | None) -> bool:
    if ground is None:
        return False
    x, y, z = point
    return z < ground.plane_at(x, y).height(x, y) - COVER_DEPTH


def in_reach(point: Vec, feet: Vec, armor: Armor, radius: float) -> bool:
    """Whether the box meets the cube around the point."""
    return all(
        feet[axis] + low <= point[axis] + radius and feet[axis] + high >= point[axis] - radius
        for axis, low, high in (
            (0, -armor.half_width, armor.half_width),
            (1, -armor.half_width, armor.half_width),
            (2, 0.0, armor.height),
        )
    )


def explode(
    player: Player,
    armor: Armor,
    point: Vec,
    ground: Surface | None,
    charge: Charge = DISC,
    formula: str = "tribes",
    cutoff: str = "engine",
) -> None:
    """Change a player's velocity and damage."""
    if covered(point, ground) or not in_reach(point, player.position, armor, charge.radius):
        return
    centre = along(player.position, (0.0, 0.0, 1.0), 0.5 * armor.height)
    away = along(centre, point, -1.0)
    d0 = math.sqrt(dot(away, away))
    m = min_box(armor)
    player.damage += harm(d0, charge, m, cutoff) * armor.blast_scales[charge.kind]
    if d0 > 0.0:
        dv = charge.kick * power(d0, formula, charge.radius, m, cutoff) / armor.mass
        player.velocity = along(player.velocity, away, dv / d0)
