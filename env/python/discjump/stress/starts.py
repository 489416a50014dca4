"""Starts and keys, drawn from fixed seeds. All numbers are float32, so that every precision begins alike."""

import zlib

import numpy as np

from discjump._native import Terrain
from discjump.simulator import INPUT
from discjump.stress.cases import Start
from discjump.stress.floor import Floor
from discjump.stress.rules import Floats, Rows

Generator = np.random.Generator


def generator(seed: int, *names: str) -> Generator:
    """Random numbers of their own for every name."""
    return np.random.default_rng([seed, *(zlib.crc32(name.encode()) for name in names)])


def single(values: Floats) -> Floats:
    """Rounded to float32."""
    return np.asarray(values, np.float32).astype(np.float64)


def directions(rng: Generator, count: int) -> Floats:
    """Unit vectors (count, 3), any way alike."""
    drawn = rng.normal(size=(count, 3))
    unit: Floats = drawn / np.linalg.norm(drawn, axis=1, keepdims=True)
    return unit


def keys(rng: Generator, ticks: int, players: int, hold: int = 6) -> Rows:
    """Keys drawn anew every few ticks; a third of the players ski: jump and forward held."""
    inputs = np.zeros((ticks, players), INPUT)
    for tick in range(0, ticks, hold):
        rows = inputs[tick : tick + hold]
        rows["forward"], rows["strafe"] = rng.integers(-1, 2, (2, players))
        rows["jump"], rows["jet"], rows["fire"] = rng.random((3, players)) < 0.5
        rows["turn"] = rng.choice([0.0, 1.0, -2.5, 40.0], players)
        rows["pitch"] = rng.choice([0.0, -1.5, -0.5, 0.5, 1e300], players)
    skiers = inputs[:, ::3]
    skiers["forward"], skiers["strafe"], skiers["jump"], skiers["jet"] = 1, 0, True, False
    skiers["turn"] = 0.0
    return inputs


def lifted(floor: Floor, xy: Floats, above: Floats) -> Floats:
    """Positions so high above the ground, (n, 3): never below it by rounding, also where ground is none."""
    xy = single(xy)
    height = np.nan_to_num(floor.height(xy))
    z = single(height + above)
    low = z < height
    z[low] = np.nextafter(z[low].astype(np.float32), np.float32(np.inf)).astype(np.float64)
    return np.column_stack([xy, z])


def start(
    rng: Generator,
    terrain: Terrain,
    xy: Floats,
    above: Floats,
    velocity: Floats,
    ticks: int,
    **fields: Floats,
) -> Start:
    """A start at these places with drawn keys, looking any way."""
    players = len(xy)
    fields.setdefault("yaw", single(rng.uniform(-3.1, 3.1, players)))
    position = lifted(Floor(terrain), xy, above)
    return Start(position, single(velocity), keys(rng, ticks, players), fields)
