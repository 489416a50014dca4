"""Keys by tick: structured arrays of dtype `INPUT` and shape (ticks, players).

Decided beforehand, without a look at the state, so that a tier's error is its own and not feedback's. Rates
and angles are float32 numbers, so that every tier is given the same.
"""

import numpy as np
from numpy.typing import NDArray

from discjump.simulator import INPUT

Inputs = NDArray[np.void]


def held(ticks: int, players: int, **keys: float) -> Inputs:
    """The same keys all the time.

    >>> held(2, 3, forward=1, jump=True)["forward"].tolist()
    [[1, 1, 1], [1, 1, 1]]
    """
    inputs = np.zeros((ticks, players), INPUT)
    for key, value in keys.items():
        inputs[key] = value
    return inputs


def turning(rng: np.random.Generator, inputs: Inputs, most: float = 0.4, every: int = 40) -> Inputs:
    """Curves: a rate of up to `most` rad/s, drawn anew every so many ticks, in 1/64 rad/s."""
    ticks, players = inputs.shape
    steps = int(64 * most)
    drawn = rng.integers(-steps, steps + 1, (-(-ticks // every), players)) / 64.0
    inputs["turn"] = np.repeat(drawn, every, axis=0)[:ticks]
    return inputs


def bursts(rng: np.random.Generator, inputs: Inputs) -> Inputs:
    """Jets in bursts: every 40 to 90 ticks, for 30 to 50% of the time; sideways keys change with them."""
    ticks, players = inputs.shape
    period = rng.integers(40, 91, players)
    burning = (period * rng.uniform(0.3, 0.5, players)).astype(np.int64)
    clock = np.arange(ticks)[:, None] + rng.integers(0, 90, players)
    inputs["jet"] = clock % period < burning
    sideways = rng.integers(-1, 2, (ticks // 40 + 3, players))
    inputs["strafe"] = np.take_along_axis(sideways, clock // period, axis=0)
    return inputs
