"""Every float32 tier against the plain Python model of the same name, one tick at a time, thousands of ticks.

`reference` is compared over whole runs in `test_article`; here rounding has no time to grow."""

import numpy as np
import pytest

import discjump

from .scripts import HELD, above, creased, plane, random_keys, rolling, rows
from .synced import Synced

TIERS = ("authentic", "swept", "anyway", "engine")


def rounded(terrain: discjump.Terrain) -> discjump.Terrain:
    """With heights that float32 holds exactly: both sides then mean the same ground."""
    heights = terrain.heights.astype(np.float32).astype(np.float64)
    return discjump.Terrain.from_heights(heights, terrain.square_size, terrain.origin, terrain.edge)


def launched(
    terrain: discjump.Terrain,
    fidelity: str,
    many: int,
    seed: int,
    spread: float,
    speed: float = 20.0,
    **others: object,
) -> Synced:
    """Players thrown at the ground and along it, from all heights up to 5 m."""
    terrain = rounded(terrain)
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-spread, spread, (many, 2))
    start = {
        "position": above(terrain, xy, rng.uniform(0.0, 5.0, many)),
        "velocity": rng.normal(0.0, speed, (many, 3)),
        "yaw": rng.uniform(-np.pi, np.pi, many),
    }
    return Synced(terrain, many, fidelity, **others, **start)  # type: ignore[arg-type]


def check(pair: Synced, flips: float, contacts: float) -> None:
    """At most this share of the ticks fell on a decision, at least that share had a contact."""
    assert pair.flips <= flips * pair.ticks, f"{pair.flips} of {pair.ticks}"
    assert pair.contacts >= contacts * pair.ticks, f"{pair.contacts} of {pair.ticks}"


@pytest.mark.parametrize("fidelity", TIERS)
@pytest.mark.parametrize(("degrees", "bearing"), [(0, 0.0), (25, 1.0), (60, -2.2)])
def test_planes(fidelity: str, degrees: float, bearing: float) -> None:
    pair = launched(plane(degrees, bearing), fidelity, 27, 1, 200.0)
    pair.run(iter([rows(HELD * 3)] * 60), 60)
    check(pair, 0.005, 0.05)


@pytest.mark.parametrize("fidelity", TIERS)
def test_rolling(fidelity: str) -> None:
    """Over seams and through odd copies of the map, all keys at random."""
    pair = launched(rolling(33, 26), fidelity, 40, 2, 900.0)
    pair.run(random_keys(np.random.default_rng(3), 40), 100)
    check(pair, 0.005, 0.05)


@pytest.mark.parametrize("fidelity", TIERS)
@pytest.mark.parametrize("kind", ["valley", "pit", "ridges"])
def test_creases(fidelity: str, kind: str) -> None:
    pair = launched(creased(kind, 60), fidelity, 16, 4, 30.0)
    pair.run(random_keys(np.random.default_rng(5), 16), 100)
    check(pair, 0.02, 0.1)


@pytest.mark.parametrize("fidelity", TIERS)
def test_fast_players(fidelity: str) -> None:
    """Many slices and many contacts in a tick."""
    pair = launched(creased("ridges", 50), fidelity, 40, 13, 60.0, speed=60.0)
    pair.run(random_keys(np.random.default_rng(14), 40), 25)
    check(pair, 0.02, 0.1)


@pytest.mark.parametrize(("armor", "energy_pack"), [("light", True), ("medium", False), ("heavy", True)])
@pytest.mark.parametrize("fidelity", ["swept", "engine"])
def test_armors(fidelity: str, armor: str, energy_pack: bool) -> None:
    pair = launched(rolling(33, 33), fidelity, 16, 6, 200.0, armor=armor, energy_pack=energy_pack)
    pair.run(random_keys(np.random.default_rng(7), 16), 100)
    check(pair, 0.005, 0.05)


@pytest.mark.parametrize(
    ("fidelity", "switches"),
    [
        ("swept", {"clamp_fixup": True}),
        ("swept", {"fixup_swept": True}),
        ("swept", {"ski_bug": True}),
        ("engine", {"ski_bug": False}),
        ("engine", {"hysteresis": False}),
    ],
)
def test_switches(fidelity: str, switches: dict[str, bool]) -> None:
    for kind in ("valley", "ridges"):
        pair = launched(creased(kind, 60), fidelity, 16, 8, 30.0, switches=switches)
        pair.run(random_keys(np.random.default_rng(9), 16), 60)
        check(pair, 0.02, 0.1)


@pytest.mark.parametrize("tick_ms", [16, 64])
@pytest.mark.parametrize("fidelity", ["swept", "engine"])
def test_tick_lengths(fidelity: str, tick_ms: int) -> None:
    pair = launched(rolling(33, 33), fidelity, 20, 11, 200.0, tick_ms=tick_ms)
    pair.run(random_keys(np.random.default_rng(12), 20), 60)
    check(pair, 0.005, 0.01)


@pytest.mark.parametrize("fidelity", ["swept", "engine"])
@pytest.mark.parametrize("degrees", [25.0, 60.0, 75.0])
def test_slow_players(fidelity: str, degrees: float) -> None:
    """Stop rule, crawling, friction's cap and memory, from many states."""
    rng = np.random.default_rng(10)
    many = 60
    terrain = rounded(plane(degrees))
    direction = rng.normal(0.0, 1.0, (many, 3))
    pair = Synced(
        terrain,
        many,
        fidelity,
        position=above(terrain, rng.uniform(-20.0, 20.0, (many, 2)), rng.choice([0.0, 0.01, 0.1], many)),
        velocity=rng.uniform(0.0, 1.5, (many, 1))
        * direction
        / np.linalg.norm(direction, axis=1, keepdims=True),
        touched=rng.random(many) < 0.7,
        friction=rng.uniform(0.0, 1.0, many),
    )
    pair.run(iter([pair.simulator.inputs()] * 40), 40)
    check(pair, 0.01, 0.3)


@pytest.mark.parametrize(("fidelity", "unit"), [("swept", 32), ("engine", 1)])
def test_jump_window(fidelity: str, unit: int) -> None:
    """Ages around 8 ticks, with jump, jets and both, and a normal that is not upright."""
    ages = [unit * n for n in range(12)]
    keys = [(1, 0, True, False, 0.0), (1, 1, True, True, 0.0), (0, 1, False, True, 0.0)]
    pair = Synced(
        plane(0.0),
        len(ages) * len(keys),
        fidelity,
        position=[0.0, 0.0, 500.0],
        jump_age=ages * len(keys),
        jump_normal=[0.0, 0.6, 0.8],
    )
    inputs = rows([key for key in keys for _ in ages])
    pair.run(iter([inputs] * 4), 4)
    check(pair, 0.0, 0.0)
