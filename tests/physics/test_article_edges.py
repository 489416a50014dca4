"""Thresholds, ties and degenerate starts of the `article` model, against the plain Python one.

Where the page gives a number, that is asserted too: agreement alone would hold if nothing happened."""

import itertools

import numpy as np
import pytest

import discjump

from .pair import Pair
from .scripts import above, creased, plane, rolling, rows

IN_THE_AIR = [0.0, 0.0, 500.0]


def around(*values: float) -> list[float]:
    """Each value with its neighbours, 1 ulp either side."""
    return [x for v in values for x in (np.nextafter(v, -np.inf), v, np.nextafter(v, np.inf))]


def test_jump_window() -> None:
    """By age: 224 is the last one of a game that counts from 0; the test is c < 256."""
    ages = [0, 31, 32, 33, 224, 255, 256, 257, 288]
    pair = Pair(plane(0.0), len(ages), position=IN_THE_AIR, jump_age=ages)
    pair.step(rows([(0, 0, True, False, 0.0)] * len(ages)))
    climbs = pair.simulator.state()["velocity"][:, 2] > 0.0
    assert climbs.tolist() == [age < 256 for age in ages]


def test_jump_after_landing() -> None:
    """A landing at 60 m/s leaves the player in the air; contact in tick k allows a jump in k+1 .. k+8."""
    many = 9
    pair = Pair(plane(0.0), many, position=[0.0, 0.0, 0.9], velocity=[0.0, 0.0, -60.0])
    pair.step(pair.inputs())
    assert pair.contacts.tolist() == [1] * many
    jumped = np.zeros(many, bool)
    for k in range(many):
        inputs = pair.inputs()
        inputs["jump"][k] = True
        pair.step(inputs)
        jumped |= pair.simulator.state()["velocity"][:, 2] > 1.0
    assert jumped.tolist() == [k < 8 for k in range(many)]


def test_jump_and_sideways_thrust_in_one_tick() -> None:
    keys = [(1, 0, jump, True, 0.0) for jump in (False, True)]
    pair = Pair(plane(20.0), 2, jump_age=0)
    pair.step(rows(keys))
    forward = pair.simulator.state()["velocity"][:, 1]
    assert forward[0] == pytest.approx(0.0, abs=1e-9)
    assert forward[1] > 0.6
    pair.step(rows(keys), 30)


@pytest.mark.parametrize("hysteresis", [False, True])
def test_energy_thresholds(hysteresis: bool) -> None:
    energies = [0.0, 0.4, *around(1.0, 5.0), 0.8, 1.2, 59.9, 60.0]
    cases = list(itertools.product(energies, [False, True], [False, True]))
    energy, jetting, key = (np.array(column) for column in zip(*cases, strict=True))
    pair = Pair(
        plane(0.0), len(cases), hysteresis=hysteresis, position=IN_THE_AIR, energy=energy, jetting=jetting
    )
    inputs = pair.inputs()
    inputs["jet"] = key
    pair.step(inputs)
    expected = key & (np.where(jetting, energy > 1.0, energy >= 5.0) if hysteresis else energy > 0.0)
    assert pair.simulator.state()["jetting"].tolist() == expected.tolist()
    inputs["jet"] = ~key
    pair.step(inputs, 3)
    inputs["jet"] = True
    pair.step(inputs, 60)


def test_empty_tank() -> None:
    """Key held, a tank of 60: 8 of 25 ticks once it is empty."""
    pair = Pair(plane(0.0), 1, position=IN_THE_AIR)
    inputs = pair.inputs()
    inputs["jet"] = True
    pair.step(inputs, 120)
    on = 0
    for _ in range(250):
        pair.step(inputs)
        on += int(pair.simulator.state()["jetting"][0])
    assert on == pytest.approx(80, abs=1)


def test_sideways_share() -> None:
    """From 0.8 up to 4.4 m/s, linearly to 0 at 22 m/s; nothing is taken from faster players."""
    speeds = np.array([-30.0, *around(0.0, 4.4, 22.0), 10.0, 22.5, 60.0])
    velocity = np.column_stack([np.full(len(speeds), 3.0), speeds, np.zeros(len(speeds))])
    pair = Pair(plane(0.0), len(speeds), position=IN_THE_AIR, velocity=velocity)
    pair.step(rows([(1, 0, False, True, 0.0)] * len(speeds)))
    share = np.clip(1.0 - speeds / 22.0, 0.0, 0.8)
    gain = pair.simulator.state()["velocity"][:, 1] - speeds
    np.testing.assert_allclose(gain, share * 236.0 / 9.0 * 0.032, atol=1e-9)
    pair.step(rows([(1, 0, False, True, 0.0)] * len(speeds)), 100)


def test_friction_cap_and_memory() -> None:
    """Speeds around the cap of 1.28 m/s, memories around full traction; then 2 s on three kinds of ground."""
    speeds = [0.0, 0.05, *around(1.28), 1.3, 9.72, 11.0, 12.28, 40.0]
    memories = [0.0, 0.05, 0.1, 0.3, *around(1.0 / 3.0), 0.6, 1.0]
    cases = np.array(list(itertools.product(speeds, memories)))
    velocity = cases[:, :1] * [0.0, 1.0, 0.0]
    for terrain, forward in [(plane(0.0), 1), (plane(82.0), 0), (creased("valley", 82.0), 1)]:
        start = above(terrain, np.array([[3.0, 1.0]]), 0.0)
        pair = Pair(
            terrain, len(cases), position=start, velocity=velocity, touched=True, friction=cases[:, 1]
        )
        pair.step(rows([(forward, 0, False, False, 0.0)] * len(cases)), 30)


@pytest.mark.parametrize("degrees", [0.0, 25.0, 60.0, 75.0])
def test_stop_rule(degrees: float) -> None:
    """Whether |v| is under 0.75 m/s and the player crawled, from many slow starts."""
    terrain = plane(degrees)
    rng = np.random.default_rng(10)
    many = 40
    speed = np.concatenate([np.linspace(0.0, 1.2, many - 6), around(0.1, 0.75)])
    direction = rng.normal(0.0, 1.0, (many, 3))
    velocity = speed[:, None] * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    pair = Pair(
        terrain,
        many,
        position=above(terrain, rng.uniform(-20.0, 20.0, (many, 2)), rng.choice([0.0, 0.01, 0.1], many)),
        velocity=velocity,
        touched=rng.random(many) < 0.7,
        friction=rng.uniform(0.0, 1.0, many),
    )
    pair.step(pair.inputs(), 60)
    resting = (pair.simulator.state()["velocity"] == 0.0).all(axis=1)
    assert resting.any()


def test_landing_damage() -> None:
    """Free up to 25 m/s; two faces of a crease in one tick hurt twice."""
    speeds = np.array([24.0, *around(25.0), 26.0, 60.0])
    velocity = (speeds - 0.64)[:, None] * [0.0, 0.0, -1.0]
    pair = Pair(plane(0.0), len(speeds), position=[1.0, 2.0, 0.3], velocity=velocity)
    pair.step(pair.inputs())
    expected = 0.005 * np.maximum(0.0, speeds - 25.0)
    np.testing.assert_allclose(pair.simulator.state()["damage"], expected, atol=1e-12)

    terrain = creased("valley", 60.0)
    xy = np.column_stack([np.linspace(0.1, 0.6, 6), np.full(6, 3.0)])
    crease = Pair(terrain, 6, position=above(terrain, xy, 0.5), velocity=[0.0, 0.0, -59.36])
    crease.step(crease.inputs())
    assert (crease.contacts > 1).all()
    # The normal part of 60 m/s, 30 m/s, and of what is left, 60 cos 60 at 60 degrees to the other face.
    first, second = 60.0 * 0.5, 60.0 * np.sin(np.radians(60.0)) * np.sin(np.radians(60.0))
    expected = 0.005 * (first - 25.0 + second - 25.0)
    np.testing.assert_allclose(crease.simulator.state()["damage"], expected, atol=1e-4)


@pytest.mark.parametrize("edge", ["tile", "clamp"])
def test_edges_diagonals_and_vertices(edge: str) -> None:
    """Falls on to, and runs along and across the lines of the grid, seams included.

    An ulp beside them, or inside a diagonal, the rounding of local coordinates chooses the side."""
    waves = rolling(17, 17, height=4.0)
    terrain = discjump.Terrain.from_heights(waves.heights, 8.0, (-64.0, -64.0), edge)
    lines = [-80.0, -64.0, 0.0, 4.0, 8.0, 12.0, 64.0, 200.0]
    xy = np.array(list(itertools.product(lines, lines)))
    for velocity in [(0.0, 0.0, -30.0), (0.0, 20.0, -9.0), (-20.0, 0.0, -9.0)]:
        pair = Pair(terrain, len(xy), position=above(terrain, xy, 0.1), velocity=velocity)
        pair.step(pair.inputs())
        assert pair.contacts.sum() >= len(xy) // 2


def test_starts_under_the_ground() -> None:
    """Hits at once, wherever the path enters a triangle from below; leaving upwards is free."""
    terrain = rolling(33, 33)
    rng = np.random.default_rng(11)
    xy = rng.uniform(-100.0, 100.0, (20, 2))
    pair = Pair(
        terrain,
        20,
        position=above(terrain, xy, -rng.uniform(0.0, 3.0, 20)),
        velocity=rng.normal(0.0, 20.0, (20, 3)),
    )
    pair.step(pair.inputs(), 60)
    assert pair.contacts.sum() > 20
