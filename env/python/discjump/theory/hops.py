"""Skiing on planes: period of a hop and acceleration, against the laws of section 10."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.theory import forms
from discjump.theory.lab import TICK_MS, Floats, State, Tier, exact32, incline, play

SLOPES = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0)
"""Degrees."""
KEYS: dict[str, dict[str, int]] = {"forward": {"jump": 1, "forward": 1}, "none": {"jump": 1}}
"""Held in every tick: jump, with the downhill key or without any."""
SPEED = 40.0
"""At the start, m/s along the plane: far above the walk speed, from which on the key would pull."""
SECONDS = 12.8
ENGINE_LATE = 0.7
"""Ticks that section 10 adds to the engine's hop."""


def measure(
    tier: Tier, degrees: float, keys: str, tick_ms: int = TICK_MS, starts: int = 16, seed: int = 0
) -> dict[str, Any]:
    """Period and acceleration of all whole hops within `SECONDS`, beside the law's.

    Returns:
        `period`, `acceleration`: means over the starts.
        `low`, `high`: ends of the acceleration over the starts.
        `law`: period and acceleration by section 10.
        `hop_error`: what a hop gains along the plane beyond 20 sin T and its own loss, the largest of all
        starts, m/s: 0 but for rounding if that account of a hop is complete.
    """
    forward = keys == "forward"
    dt = tick_ms / 1000.0
    law = forms.hop(degrees, forward, dt)
    late = ENGINE_LATE * dt if tier.model == "engine" else 0.0
    period = law.period + late
    sin, cos = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))

    rng = np.random.default_rng(seed)
    y = -1200.0 + rng.uniform(0.0, 8.0, starts)
    above = exact32(rng.uniform(0.0, 0.2, starts))
    terrain = incline(degrees)
    fields = {
        "position": np.column_stack([np.zeros(starts), y, -np.tan(np.radians(degrees)) * y + above]),
        "velocity": exact32(np.tile([0.0, SPEED * cos, -SPEED * sin], (starts, 1))),
    }
    states = list(play(tier, terrain, fields, KEYS[keys], round(SECONDS / dt), tick_ms=tick_ms))
    touched, along = _series(states, cos, sin)
    periods, gains, errors = [], [], []
    for player in range(starts):
        # The engine's sphere still overlaps the plane in the tick that jumps off: a contact begins once.
        ticks = np.flatnonzero(touched[1:, player] & ~touched[:-1, player]) + 1
        first, last = ticks[1], ticks[-1]
        hops, seconds = len(ticks) - 2, (last - first) * dt
        gained = along[last, player] - along[first, player]
        periods.append(seconds / hops)
        gains.append(gained / seconds)
        errors.append((gained - forms.GRAVITY * sin * seconds) / hops + law.lost)
    return {
        "slope": degrees,
        "keys": keys,
        "tick_ms": tick_ms,
        "tier": tier.name,
        "period": float(np.mean(periods)),
        "acceleration": float(np.mean(gains)),
        "low": float(np.min(gains)),
        "high": float(np.max(gains)),
        "law": {"period": period, "acceleration": forms.GRAVITY * sin - law.lost / period},
        "hop_error": float(np.max(np.abs(errors))),
    }


def _series(states: list[State], cos: float, sin: float) -> tuple[NDArray[np.bool_], Floats]:
    """Whether each player touched the ground, and his speed along the plane, (ticks + 1, n)."""
    touched: NDArray[np.bool_] = np.array([state["touched"] for state in states])
    velocity = np.array([state["velocity"] for state in states], np.float64)
    return touched, velocity[..., 1] * cos - velocity[..., 2] * sin
