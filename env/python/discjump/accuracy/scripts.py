"""Keys by tick: structured arrays of dtype `INPUT` and shape (ticks, players).

Decided beforehand, without a look at the state, so that a tier's error is its own and not feedback's. Rates
and angles are float32 numbers, so that every tier is given the same.
"""

import numpy as np
from numpy.typing import NDArray

from discjump.simulator import INPUT

Inputs = NDArray[np.void]

TICK_MS = 32
"""Length of the game's tick, ms: scripts and explosions are written in these."""


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


def resampled(inputs: Inputs, tick_ms: int) -> Inputs:
    """The same keys, as functions of time, in ticks of another length.

    In shorter ticks every key is held on. A longer tick takes the keys of its beginning and the mean of the
    turn rates, so that the yaw at its end is the script's; a trigger that is pulled within a tick counts in
    the next one, since an event cannot act before it happens.

    Args:
        inputs: (ticks, players) in ticks of `TICK_MS`.
        tick_ms: a divisor or a multiple of `TICK_MS` that divides the length of the script.

    Raises:
        ValueError: another tick length.

    >>> inputs = held(4, 1)
    >>> inputs["turn"][:, 0], inputs["fire"][:, 0] = [1.0, 2.0, 3.0, 4.0], [False, True, False, False]
    >>> longer = resampled(inputs, 64)
    >>> longer["turn"][:, 0].tolist(), longer["fire"][:, 0].tolist()
    ([1.5, 3.5], [False, True])
    >>> resampled(inputs, 16)["turn"][:, 0].tolist()
    [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0]
    """
    if tick_ms >= 1 and TICK_MS % tick_ms == 0:
        return np.repeat(inputs, TICK_MS // tick_ms, axis=0)
    ticks, players = inputs.shape
    if tick_ms < 1 or (TICK_MS * ticks) % tick_ms or tick_ms % TICK_MS:
        raise ValueError(
            f"tick_ms: expected a divisor of {TICK_MS}, or a multiple of it that divides the script's "
            f"{TICK_MS * ticks} ms, got {tick_ms}"
        )
    of_tick = inputs.reshape(-1, tick_ms // TICK_MS, players)
    longer = of_tick[:, 0].copy()
    longer["turn"] = of_tick["turn"].mean(axis=1)
    longer["fire"][1:] |= of_tick["fire"][:-1, 1:].any(axis=1)
    return longer
