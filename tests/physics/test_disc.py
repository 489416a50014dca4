"""The plain Python disc launcher against the figures of core/docs/physics.md: sections 7, 11 and 12."""

import math

import numpy as np
import pytest

from .article import Keys, norm
from .disc import Disc, Launcher, aim, fly
from .ground import Ground, Incline, Vec, along, dot
from .models import standing
from .scripts import rolling
from .world import World

LEVEL = Incline(0.0)
HIGH: Vec = (0.0, 0.0, 10_000.0)
ENGINE = Launcher(disc="engine")


def flying(velocity: Vec = (0.0, 65.0, 0.0), position: Vec = HIGH, ahead: Vec = (0.0, 1.0, 0.0)) -> Disc:
    return Disc(position, velocity, ahead)


@pytest.mark.parametrize(("tick_ms", "ticks"), [(32, 56), (16, 79 + 16 + 16), (64, 20 + 4 + 4), (1, 1750)])
def test_cycle(tick_ms: int, ticks: int) -> None:
    """1.792 s with the trigger held, until 15 discs are gone. With other ticks each state is rounded up."""
    world = World(standing("sliced", HIGH), LEVEL, launcher=Launcher(tick_ms=tick_ms))
    assert world.launcher.cycle == ticks
    if tick_ms != 32:
        return
    shots = []
    for k in range(16 * 56):
        ammo = world.shooter.ammo
        world.step(Keys(), trigger=True)
        if world.shooter.ammo < ammo:
            shots.append(k)
    assert shots == [56 * n for n in range(15)]
    assert pytest.approx(1.792) == 56 * 0.032


@pytest.mark.parametrize("accel", ["none", "nominal", "mass"])
def test_life(accel: str) -> None:
    """203 steps; gone in the 204th tick, the shot's being the first."""
    disc = flying()
    ticks = 1
    while fly(disc, LEVEL, Launcher(accel=accel))[0]:
        ticks += 1
    assert ticks == 204
    assert disc.steps == 203


def test_engine_life() -> None:
    """About 422 m at a real speed of 65.66 m/s."""
    disc = flying()
    while fly(disc, LEVEL, ENGINE)[0]:
        pass
    assert disc.age == 204
    assert disc.position[1] == pytest.approx(422.0, abs=1.0)
    assert pytest.approx(65.66, abs=0.005) == 65 / 30 / 0.033


def test_engine_clock() -> None:
    """The first step 2 ticks after the shot's; from there one in every tick but each 33rd."""
    disc = flying()
    moved = []
    for _ in range(200):
        before = disc.position[1]
        assert fly(disc, LEVEL, ENGINE)[0]
        moved.append(disc.position[1] - before)
    assert moved[0] == moved[1] == 0.0
    assert [k for k in range(2, 200) if moved[k] == 0.0] == [34, 67, 100, 133, 166, 199]
    assert {round(m, 9) for m in moved} == {0.0, round(65 / 30, 9)}


@pytest.mark.parametrize(("accel", "seconds"), [("nominal", 3.0), ("mass", 6.0)])
def test_acceleration(accel: str, seconds: float) -> None:
    """From 65 to 80 m/s, and no further."""
    disc = flying()
    speeds = []
    for _ in range(200):
        fly(disc, LEVEL, Launcher(accel=accel))
        speeds.append(norm(disc.velocity))
    assert speeds.index(80.0) * 0.032 == pytest.approx(seconds, abs=0.04)
    assert max(speeds) == 80.0
    assert speeds[30] - speeds[29] == pytest.approx(15.0 / seconds * 0.032)


def test_muzzle_and_inheritance() -> None:
    """Right 0.2, forward 0.5, up 1.5 m; 65 m/s along the aim and half the shooter's velocity."""
    yaw, pitch = 0.7, -0.4
    player = standing("sliced", HIGH, (10.0, -4.0, 2.0), yaw=yaw)
    world = World(player, LEVEL, launcher=Launcher(accel="none"))
    world.step(Keys(), pitch, trigger=True)
    disc = world.shooter.discs[0]
    right, forward = (math.cos(yaw), math.sin(yaw), 0.0), (-math.sin(yaw), math.cos(yaw), 0.0)
    muzzle = along(along(along(HIGH, right, 0.2), forward, 0.5), (0.0, 0.0, 1.0), 1.5)
    velocity = along((5.0, -2.0, 1.0), aim(yaw, pitch), 65.0)
    assert disc.velocity == pytest.approx(velocity)
    assert disc.position == pytest.approx(along(muzzle, velocity, 0.032))
    assert norm(aim(yaw, pitch)) == pytest.approx(1.0)
    assert dot(aim(yaw, pitch), forward) == pytest.approx(math.cos(pitch))


def test_terminal_snap() -> None:
    """A shooter at 30 m/s along the aim has an 80 m/s disc, without its sideways part; one at 29 has not."""
    for speed, snapped in ((29.0, False), (30.0, True), (60.0, True)):
        player = standing("sliced", HIGH, (8.0, speed, 0.0))
        world = World(player, LEVEL, launcher=ENGINE)
        for _ in range(3):
            world.step(Keys(), trigger=True)
        velocity = world.shooter.discs[0].velocity
        assert velocity == pytest.approx((0.0, 80.0, 0.0) if snapped else (4.0, 65.0 + 0.5 * speed, 0.0))


def test_backwards() -> None:
    """Faster than 130 m/s backwards: the disc flies backwards."""
    world = World(standing("sliced", HIGH, (0.0, -140.0, 0.0)), LEVEL, launcher=Launcher(accel="none"))
    world.step(Keys(), trigger=True)
    assert world.shooter.discs[0].velocity == pytest.approx((0.0, -5.0, 0.0))


def test_disc_at_the_feet() -> None:
    """Straight down (88 degrees): in its first tick it bursts on the surface, 0.5 m ahead. The engine's
    bursts two ticks later, where it is: at the muzzle."""
    world = World(standing("sliced"), LEVEL)
    (point,) = world.step(Keys(), -1.6, trigger=True)
    assert point == pytest.approx((0.2, 0.5 + 1.5 / math.tan(math.radians(88.0)), 0.0))
    assert world.player.damage == pytest.approx(0.4333, abs=5e-5)
    assert world.player.velocity[2] > 10.0

    world = World(standing("sliced"), LEVEL, launcher=ENGINE)
    bursts = [world.step(Keys(), -1.6, trigger=True) for _ in range(3)]
    assert bursts[:2] == [[], []]
    assert bursts[2] == [pytest.approx((0.2, 0.5, 1.5))]
    assert world.player.velocity[1] < -1.0


def test_blast_is_felt_from_the_next_tick_on() -> None:
    world, quiet = World(standing("sliced"), LEVEL), World(standing("sliced"), LEVEL)
    world.step(Keys(), -1.6, trigger=True)
    quiet.step(Keys(), -1.6)
    assert world.player.position == quiet.player.position
    assert norm(world.player.velocity) > 10.0


def test_no_disc_slips_through() -> None:
    """From the air on rolling ground, at all angles: where it bursts the ground is, and nowhere before."""
    ground = Ground(rolling(33, 33))
    rng = np.random.default_rng(5)
    burst = 0
    for _ in range(150):
        x, y = rng.uniform(-100.0, 300.0, 2)
        yaw, pitch = rng.uniform(-np.pi, np.pi), rng.uniform(-1.5, 0.1)
        ahead = aim(yaw, pitch)
        start = (x, y, ground.plane_at(x, y).height(x, y) + 3.0)
        disc = flying(along((0.0, 0.0, 0.0), ahead, 65.0), start, ahead)
        while True:
            alive, point = fly(disc, ground, Launcher())
            if not alive:
                break
            assert ground.plane_at(*disc.position[:2]).distance(disc.position) > 0.0
        if point is not None:
            burst += 1
            assert ground.plane_at(*point[:2]).distance(point) == pytest.approx(0.0, abs=1e-9)
    assert burst > 120


def test_from_below() -> None:
    """A start under the ground bursts on the way out; on the surface counts as below it."""
    for depth in (1.0, 0.0):
        alive, point = fly(flying((0.0, 0.0, 65.0), (0.0, 0.0, -depth), (0.0, 0.0, 1.0)), LEVEL, Launcher())
        assert not alive
        assert point == pytest.approx((0.0, 0.0, 0.0))
    alive, _ = fly(flying((0.0, 0.0, -65.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0)), LEVEL, Launcher())
    assert alive
