"""Helpers of the environment tests: short episodes, random actions, comparison bit for bit."""

from typing import Any

import numpy as np

# Beacons so near and episodes so short that all ways to end turn up within a few hundred decisions.
SHORT: dict[str, Any] = {"terrain_seeds": [0, 1], "goal_distance": (20.0, 60.0), "time_limit": 4.0}


def random_actions(seed: int, steps: int, num_envs: int) -> np.ndarray:
    """(steps, num_envs, 5) int64; mostly forward, or hardly anybody would arrive."""
    rng = np.random.default_rng(seed)
    actions = rng.integers(0, [3, 3, 2, 2, 7], size=(steps, num_envs, 5))
    actions[..., 0] = np.where(rng.random((steps, num_envs)) < 0.8, 2, actions[..., 0])
    return actions


def same_bits(one: Any, other: Any, where: str = "") -> None:
    """Assert equality of nested dicts, tuples and arrays: types, dtypes, shapes and bits."""
    if isinstance(one, dict):
        assert isinstance(other, dict), where
        assert one.keys() == other.keys(), where
        for key in one:
            same_bits(one[key], other[key], f"{where}[{key!r}]")
    elif isinstance(one, tuple):
        assert isinstance(other, tuple), where
        for index, (left, right) in enumerate(zip(one, other, strict=True)):
            same_bits(left, right, f"{where}[{index}]")
    elif isinstance(one, np.ndarray) and one.dtype == object:
        assert other.dtype == object, where
        assert one.shape == other.shape, where
        for index, (left, right) in enumerate(zip(one, other, strict=True)):
            same_bits(left, right, f"{where}[{index}]")
    elif isinstance(one, np.ndarray):
        assert isinstance(other, np.ndarray), where
        assert one.dtype == other.dtype, f"{where}: {one.dtype} against {other.dtype}"
        assert one.shape == other.shape, where
        assert one.tobytes() == other.tobytes(), f"{where}: {one} against {other}"
    else:
        assert type(one) is type(other), where
        assert one == other, where
