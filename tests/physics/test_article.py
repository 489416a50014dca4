"""Whole runs of `reference` against the plain Python model: all fields, all ticks, 1e-6 m and 1e-6 m/s.

Contacts are part of the comparison (touched, jump normal and age, damage): one contact more or less, or in
another order, fails. Creases are no exception: section 12 allows a tick of slack there, which float64 on
both sides does not need, as they differ by some 1e-12 m when the contacts are decided."""

import numpy as np
import pytest

import discjump

from .pair import Pair
from .scripts import HELD, TEN_SECONDS, above, creased, held_pair, plane, random_keys, rolling, rows


@pytest.mark.parametrize(("degrees", "bearing"), [(0, 0.0), (20, 1.0), (45, -2.2), (60, 0.3), (80, 0.0)])
def test_planes(degrees: float, bearing: float) -> None:
    """80 degrees is beyond the steepest ground that one can jump from."""
    pair = held_pair(plane(degrees, bearing), (500 * np.sin(bearing), -500 * np.cos(bearing)), 30.0, seed=1)
    pair.step(rows(HELD * 3), TEN_SECONDS)
    assert np.count_nonzero(pair.contacts) > 20


@pytest.mark.parametrize(("north", "east"), [(65, 65), (50, 33), (9, 9)])
def test_rolling_tiles(north: int, east: int) -> None:
    """Over the seams, in copies far from the first; an odd side breaks the checkerboard there."""
    terrain = rolling(north, east)
    start = (-100.0, 36.0) if north == 65 else (-1900.0, 2500.0)
    pair = held_pair(terrain, start, 40.0, seed=2)
    pair.step(rows(HELD * 3), TEN_SECONDS)
    assert pair.contacts.sum() > 500


def test_raindance() -> None:
    pair = held_pair(discjump.Terrain.raindance(3), (0.0, 0.0), 900.0, seed=3)
    pair.step(rows(HELD * 3), TEN_SECONDS)
    assert pair.contacts.sum() > 1000


def test_random_keys() -> None:
    """Over the map's rim too."""
    rng = np.random.default_rng(4)
    many = 30
    terrain = discjump.Terrain.raindance(3)
    xy = rng.uniform(-1100.0, 1100.0, (many, 2))
    pair = Pair(
        terrain,
        many,
        position=above(terrain, xy, rng.uniform(-0.5, 5.0, many)),
        velocity=rng.normal(0.0, 25.0, (many, 3)),
        yaw=rng.uniform(-np.pi, np.pi, many),
    )
    keys = random_keys(rng, many)
    for _ in range(TEN_SECONDS):
        pair.step(next(keys))
    assert pair.contacts.min() > 0


@pytest.mark.parametrize(("armor", "energy_pack"), [("light", True), ("medium", False), ("heavy", True)])
def test_armors(armor: str, energy_pack: bool) -> None:
    terrain = rolling(33, 33)
    rng = np.random.default_rng(6)
    pair = Pair(
        terrain,
        8,
        armor=armor,
        energy_pack=energy_pack,
        position=above(terrain, rng.uniform(0.0, 200.0, (8, 2)), 3.0),
        velocity=rng.normal(0.0, 30.0, (8, 3)),
    )
    keys = random_keys(rng, 8)
    for _ in range(TEN_SECONDS):
        pair.step(next(keys))
    assert pair.contacts.sum() > 50


@pytest.mark.parametrize(("degrees", "ski_bug"), [(60, False), (75, False), (75, True)])
@pytest.mark.parametrize("kind", ["valley", "diagonal", "pit", "ridges"])
def test_creases(kind: str, degrees: float, ski_bug: bool) -> None:
    """Several contacts in a tick, up to the bump limit; a third of the players neither jump nor jet."""
    terrain = creased(kind, degrees)
    rng = np.random.default_rng(7)
    many = 9
    xy = rng.uniform(-30.0, 30.0, (many, 2))
    pair = Pair(
        terrain,
        many,
        ski_bug=ski_bug,
        position=above(terrain, xy, rng.uniform(0.0, 10.0, many)),
        velocity=rng.normal(0.0, 20.0, (many, 3)),
        yaw=rng.uniform(-np.pi, np.pi, many),
    )
    keys = random_keys(rng, many)
    for _ in range(TEN_SECONDS // 2):
        inputs = next(keys)
        inputs["jump"][: many // 3] = inputs["jet"][: many // 3] = False
        pair.step(inputs)
    assert pair.most_contacts > 1
    if kind != "pit" and degrees >= 60:
        assert pair.most_contacts == 4


def test_huge_speeds() -> None:
    """4 km/s: 128 slices a tick."""
    terrain = discjump.Terrain.raindance(3)
    rng = np.random.default_rng(8)
    direction = rng.normal(0.0, 1.0, (10, 3)) * [1.0, 1.0, 0.1]
    velocity = 4000.0 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    pair = Pair(
        terrain, 10, position=above(terrain, rng.uniform(-500.0, 500.0, (10, 2)), 20.0), velocity=velocity
    )
    pair.step(pair.inputs(), 8)
    assert pair.contacts.sum() >= 5


@pytest.mark.parametrize(("tick_ms", "apex"), [(16, 1.669), (32, 1.603), (64, 1.480)])
def test_tick_lengths(tick_ms: int, apex: float) -> None:
    """A run on waves, and section 11's jump from level ground: v^2/2g - v dt/2, to a tick's rounding."""
    terrain = rolling(65, 65)
    rng = np.random.default_rng(9)
    pair = Pair(
        terrain,
        9,
        tick_ms=tick_ms,
        position=above(terrain, rng.uniform(0.0, 400.0, (9, 2)), 2.0),
        velocity=rng.normal(0.0, 20.0, (9, 3)),
    )
    pair.step(rows(HELD), 10_000 // tick_ms)
    assert pair.contacts.sum() > 50

    jump = Pair(plane(0.0), 1, tick_ms=tick_ms, jump_age=0)
    inputs = jump.inputs()
    inputs["jump"] = True
    heights: list[float] = []
    while not heights or jump.simulator.state()["velocity"][0, 2] > 0.0:
        jump.step(inputs)
        heights.append(jump.simulator.state()["position"][0, 2])
    assert max(heights) == pytest.approx(apex, abs=0.001 if tick_ms < 64 else 0.005)
