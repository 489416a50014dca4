"""Grenade launcher and mortar of the plain Python model against closed forms and the appendix's numbers."""

import math

import pytest

from .article import Keys, norm
from .disc import Launcher
from .ground import Incline, Vec, along, dot
from .models import standing
from .shell import SHELLS, bounced
from .world import World

LEVEL = Incline(0.0)


@pytest.mark.parametrize(("weapon", "reach", "cycle"), [("grenade_launcher", 150, 32), ("mortar", 275, 79)])
def test_reach(weapon: str, reach: float, cycle: int) -> None:
    """v^2/g at 45 degrees, which the speeds are made for; from 1.5 m up it is some metre more. By then it is
    armed and bursts. A tick moves it with the velocity of its end, which costs the way of one tick."""
    launcher = Launcher(weapon)
    assert launcher.cycle == cycle
    world = World(standing("sliced"), LEVEL, launcher=launcher)
    bursts = world.step(Keys(), math.radians(45.0), trigger=True)
    ticks = 1
    while not bursts:
        bursts = world.step(Keys(), 0.0)
        ticks += 1
    ((x, y, z),) = bursts
    assert x == pytest.approx(0.2)
    assert z == pytest.approx(0.0, abs=1e-9)
    lost = launcher.speed * math.cos(math.pi / 4) * 0.032
    assert y == pytest.approx(reach + 0.5 + 1.5 - lost, abs=0.1)
    assert ticks * 0.032 == pytest.approx(2.0 * launcher.speed * math.sin(math.pi / 4) / 20.0, abs=0.15)
    assert world.player.damage == 0.0


@pytest.mark.parametrize("weapon", list(SHELLS))
def test_bounce(weapon: str) -> None:
    """The part along the normal comes back with the elasticity, and a push of 1 mm/s; the rest is kept."""
    normal: Vec = (0.0, 0.6, 0.8)
    velocity: Vec = (3.0, -20.0, -5.0)
    after = bounced(velocity, normal, SHELLS[weapon].elasticity)
    assert dot(after, normal) == pytest.approx(0.001 - SHELLS[weapon].elasticity * dot(velocity, normal))
    kept = along(velocity, normal, -dot(velocity, normal))
    assert along(after, normal, -dot(after, normal)) == pytest.approx(kept)


@pytest.mark.parametrize(("weapon", "armed"), [("grenade_launcher", 32), ("mortar", 63)])
def test_arming(weapon: str, armed: int) -> None:
    """Shot at the ground before the feet it bounces, never under the ground, and bursts at its first contact
    after 1 or 2 s."""
    world = World(standing("sliced"), LEVEL, launcher=Launcher(weapon))
    bursts: list[Vec] = world.step(Keys(), -1.0, trigger=True)
    k = 0
    heights = []
    while not bursts:
        (shell,) = world.shooter.discs
        heights.append(shell.position[2])
        bursts = world.step(Keys())
        k += 1
    assert min(heights) > -1e-9
    assert k >= armed
    assert k < armed + 60
    assert bursts[0][2] == pytest.approx(0.0, abs=1e-9)
    assert norm(along(bursts[0], (0.0, 0.0, 0.0), -1.0)) > 1.0
