"""Grenade launcher and mortar in plain float64 Python, from the appendix of core/docs/physics.md.

The page gives the numbers; how a shell flies within a tick it leaves open. Here: velocity first, then the
place; the rest of a tick after a bounce is flown with the new velocity, up to four bounces; the ground is met
from above only, so that a shell that leaves it is free; a bounce pushes out as a player's contact does."""

import math
from dataclasses import dataclass

from .article import OUTWARD_PUSH
from .blast import GRENADE, MORTAR, Charge
from .ground import Surface, Vec, along, dot

GRAVITY = 20.0
MAX_BOUNCES = 4


@dataclass(frozen=True)
class Shell:
    """A row of the appendix."""

    speed: float
    elasticity: float
    arm_ms: int
    cycle_ms: tuple[int, ...]
    charge: Charge


SHELLS = {
    "grenade_launcher": Shell(math.sqrt(150.0 * 20.0), 0.45, 1000, (500, 500), GRENADE),
    "mortar": Shell(math.sqrt(275.0 * 20.0), 0.1, 2000, (2000, 500), MORTAR),
}


def bounced(velocity: Vec, normal: Vec, elasticity: float) -> Vec:
    return along(velocity, normal, OUTWARD_PUSH - (1.0 + elasticity) * dot(velocity, normal))


def fly(
    position: Vec, velocity: Vec, shell: Shell, armed: bool, ground: Surface, dt: float
) -> tuple[Vec, Vec, bool]:
    """One tick: where it is or burst, its velocity, and whether it burst."""
    velocity = along(velocity, (0.0, 0.0, -GRAVITY), dt)
    left = dt
    for _ in range(MAX_BOUNCES):
        path = (velocity[0] * left, velocity[1] * left, velocity[2] * left)
        hit = ground.sweep(position, path)
        if hit is None:
            return along(position, path, 1.0), velocity, False
        position = along(position, path, hit.fraction)
        if armed:
            return position, velocity, True
        velocity = bounced(velocity, hit.normal, shell.elasticity)
        left *= 1.0 - hit.fraction
    return position, velocity, False
