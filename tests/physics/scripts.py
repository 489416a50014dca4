"""What players do, where they start and on what ground, for the comparisons."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

import discjump

from .pair import Pair

TEN_SECONDS = 312

#: forward, strafe, jump, jet, turn
HELD: list[tuple[int, int, bool, bool, float]] = [
    (0, 0, False, False, 0.0),  # nothing
    (1, 0, True, False, 0.0),  # ski forward
    (1, 0, True, False, 0.4),  # ... in a curve
    (0, 0, True, False, 0.0),  # jump only
    (1, 0, False, False, 0.0),  # walk
    (-1, 1, False, False, -1.3),
    (0, 0, False, True, 0.0),  # jets straight up, and on the empty tank
    (1, -1, False, True, 0.7),
    (1, 0, True, True, -0.2),
]


def rows(values: list[tuple[Any, ...]], **fixed: Any) -> NDArray[np.void]:
    inputs = np.zeros(len(values), discjump.simulator.INPUT)
    for i, name in enumerate(("forward", "strafe", "jump", "jet", "turn")):
        inputs[name] = [value[i] for value in values]
    for name, value in fixed.items():
        inputs[name] = value
    return inputs


def random_keys(rng: np.random.Generator, num_players: int) -> Iterator[NDArray[np.void]]:
    """Every key is drawn anew every ten ticks or so, for each player at another tick."""
    inputs = np.zeros(num_players, discjump.simulator.INPUT)
    while True:
        drawn = {
            "forward": rng.integers(-1, 2, num_players),
            "strafe": rng.integers(-1, 2, num_players),
            "jump": rng.random(num_players) < 0.6,
            "jet": rng.random(num_players) < 0.4,
            "turn": rng.uniform(-2.0, 2.0, num_players),
        }
        for name, values in drawn.items():
            inputs[name] = np.where(rng.random(num_players) < 0.1, values, inputs[name])
        yield inputs.copy()


def plane(degrees: float, bearing: float = 0.0) -> discjump.Terrain:
    """Falls towards `bearing` (0 is +y); level beyond 1024 m."""
    axis = 8.0 * np.arange(257) - 1024.0
    down = -np.sin(bearing) * axis[None, :] + np.cos(bearing) * axis[:, None]
    return discjump.Terrain.from_heights(
        -np.tan(np.radians(degrees)) * down, 8.0, (-1024.0, -1024.0), "clamp"
    )


def rolling(rows: int, columns: int, height: float = 12.0) -> discjump.Terrain:
    """Waves that meet at the seams of a (rows - 1) x (columns - 1) map."""
    y, x = np.meshgrid(np.linspace(0, 2 * np.pi, rows), np.linspace(0, 2 * np.pi, columns), indexing="ij")
    heights = height * (np.sin(2 * x + np.cos(y)) + np.sin(3 * y - x) + 0.4 * np.cos(5 * x + 4 * y))
    heights[-1], heights[:, -1] = heights[0], heights[:, 0]
    return discjump.Terrain.from_heights(heights, 8.0, (-100.0, 36.0), "tile")


def creased(kind: str, degrees: float) -> discjump.Terrain:
    axis = 8.0 * np.arange(33) - 128.0
    x, y = np.meshgrid(axis, axis)
    distance = {
        "valley": np.abs(x),
        "diagonal": np.abs(x - y) / np.sqrt(2.0),
        "pit": np.maximum(np.abs(x), np.abs(y)),
        "ridges": np.abs(x) % 16.0,
    }[kind]
    return discjump.Terrain.from_heights(
        distance * np.tan(np.radians(degrees)), 8.0, (-128.0, -128.0), "clamp"
    )


def above(terrain: discjump.Terrain, xy: NDArray[np.float64], height: Any) -> NDArray[np.float64]:
    return np.column_stack([xy, terrain.height(xy) + height])


def held_pair(terrain: discjump.Terrain, start: tuple[float, float], spread: float, seed: int) -> Pair:
    """Each of `HELD` three times: from rest on the ground, at 60 m/s along the view, landing at 40 m/s."""
    rng = np.random.default_rng(seed)
    many = len(HELD)
    xy = np.asarray(start) + rng.uniform(-spread, spread, (3 * many, 2))
    height = np.repeat([0.0, 1.0, 6.0], many)
    yaw = rng.uniform(-np.pi, np.pi, 3 * many)
    yaw[:many] = 0.0
    ahead = np.column_stack([-np.sin(yaw), np.cos(yaw), np.zeros(3 * many)])
    speed = np.repeat([0.0, 60.0, 20.0], many)[:, None]
    velocity = speed * ahead + np.repeat([0.0, 0.0, 1.0], many)[:, None] * [0.0, 0.0, -36.0]
    return Pair(terrain, 3 * many, position=above(terrain, xy, height), velocity=velocity, yaw=yaw)
