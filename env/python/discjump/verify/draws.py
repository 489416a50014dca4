"""Actions by plain integer arithmetic: no generator whose stream may change, and no library's sine."""

from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

WORD = 2**64
HOLD = 5
"""Decisions for which an action that was drawn is held."""
SKI_KEYS = [3, 3, 2, 2, 7]
"""Forward, strafe, jump, jet, turn; with a launcher fire and pitch follow."""

Driver = Callable[[int, int, NDArray[Any]], Any]
"""(environment's seed, decision, its observation) to its action."""


def mix(*words: int) -> int:
    """64 well-mixed bits of some integers (SplitMix64's finaliser, word by word).

    >>> mix(1, 2) != mix(2, 1), 0 <= mix(7) < WORD
    (True, True)
    """
    state = 0
    for word in words:
        state = (state + word * 0x9E3779B97F4A7C15 + 0x9E3779B97F4A7C15) % WORD
        state = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) % WORD
        state = ((state ^ (state >> 27)) * 0x94D049BB133111EB) % WORD
        state ^= state >> 31
    return state


def share(*words: int) -> float:
    """A number in [0, 1): a multiple of 2**-32, so that sums and halves of it are exact."""
    return (mix(*words) >> 32) / 2**32


@cache
def shuffled(count: int, *words: int) -> NDArray[np.int64]:
    """The numbers below `count` in an order of their own for these words."""
    order = np.array(sorted(range(count), key=lambda index: mix(*words, index)), np.int64)
    order.flags.writeable = False
    return order


def drawn(space: spaces.Space[Any], *words: int) -> Any:
    """An element of a space.

    Raises:
        TypeError: a space of another kind than Discrete, MultiDiscrete, MultiBinary and Box.
    """
    if isinstance(space, spaces.Discrete):
        return np.int64(int(space.start) + mix(*words) % int(space.n))
    if isinstance(space, spaces.MultiDiscrete):
        bins = space.nvec.ravel().tolist()
        numbers = [mix(*words, key) % size for key, size in enumerate(bins)]
        return (np.array(numbers).reshape(space.nvec.shape) + space.start).astype(space.dtype)
    if isinstance(space, spaces.MultiBinary):
        bits = [mix(*words, key) % 2 for key in range(int(np.prod(space.shape)))]
        return np.array(bits, space.dtype).reshape(space.shape)
    if isinstance(space, spaces.Box):
        shares = [share(*words, key) for key in range(int(np.prod(space.shape)))]
        low, high = space.low.astype(np.float64), space.high.astype(np.float64)
        return (low + np.reshape(shares, space.shape) * (high - low)).astype(space.dtype)
    raise TypeError(f"action_space: expected Discrete, MultiDiscrete, MultiBinary or Box, got {space}")


def driver(space: spaces.Space[Any], layout: Sequence[Any]) -> Driver:
    """Who acts in an environment: at random, and where there is a goal half of them ski to it.

    Args:
        space: of one action.
        layout: fields of the observation with `name` and `slice`; empty where nothing is known of them.
    """
    fields = {field.name: field.slice for field in layout}
    skis = isinstance(space, spaces.MultiDiscrete) and space.nvec[: len(SKI_KEYS)].tolist() == SKI_KEYS
    directions = [fields[name] for name in ("beacon_direction", "goal_direction") if name in fields]
    if not skis or not directions or "speed" not in fields:
        return lambda seed, decision, observation: drawn(space, seed, decision // HOLD)
    [towards], speed = directions, fields["speed"]

    @lru_cache(HOLD)
    def held(seed: int, block: int) -> Any:
        return drawn(space, seed, block)

    def ski(seed: int, decision: int, observation: NDArray[Any]) -> Any:
        action = held(seed, decision // HOLD).copy()
        if seed % 4 == 3:
            return action
        action[:3] = 2, 1, 1
        if seed % 4 == 2:
            return action
        ahead, right = observation[towards].tolist()
        bins = sum(abs(right) > least for least in (0.03, 0.1, 0.3)) if ahead > 0 else 3
        action[3] = action[3] if seed % 4 else float(observation[speed][0]) < 0.75
        action[4] = 3 - bins if right > 0 else 3 + bins
        if not seed % 4:
            # Who shoots at his feet does not come far.
            action[len(SKI_KEYS) : len(SKI_KEYS) + 1] = 0
        return action

    return ski
