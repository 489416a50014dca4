"""Plays every tier and compares it with `reference`, tick by tick."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discjump.accuracy.grounds import Floats
from discjump.accuracy.plays import Play
from discjump.simulator import Simulator

TICK = 0.032
"""s."""
SECONDS = (1.0, 5.0, 20.0)
"""When errors are told, s: at the nearest tick."""
SHARES = (0.01, 0.1, 1.0)
"""Position errors, m, of which it is told how many starts exceed them."""
NUDGE = 0.001
"""How far east of its start the tier `nudged` begins, m."""
TIERS = ("authentic", "swept", "fast", "engine", "anyway", "nudged")
"""What is measured by default.

`nudged` is no tier but the yardstick: `reference` from a start `NUDGE` aside, so what the situation itself
makes of a millimetre. `reference` against itself can be asked for, and must give zeros.
"""


@dataclass(frozen=True)
class Path:
    """Where one batch was after every tick, the start included."""

    #: (ticks + 1, n, 3), m; fewer where not every tick was asked for.
    position: Floats
    #: (ticks + 1, n), m/s.
    speed: Floats


@dataclass(frozen=True)
class Errors:
    """Of all starts of a situation in one tier against `reference`, after every tick."""

    #: Distance between the positions, (ticks + 1, n), m.
    position: Floats
    #: Difference of the speeds without sign, (ticks + 1, n), m/s.
    speed: Floats


def ticks_of(seconds: float) -> int:
    """The tick nearest to a time.

    >>> [ticks_of(seconds) for seconds in SECONDS]
    [31, 156, 625]
    """
    return round(seconds / TICK)


def run(play: Play, tier: str, every: int = 1, precision: str | None = None) -> Path:
    """Play a batch in one tier.

    Args:
        play: what is played.
        tier: one of the tiers, or `nudged`.
        every: how many ticks from one place of the path to the next.
        precision: "float32" or "float64"; None for the tier's own.
    """
    nudged = tier == "nudged"
    fidelity = "reference" if nudged else tier
    sim = Simulator(
        play.terrain,
        len(play.position),
        play.scene,
        fidelity=fidelity,
        precision=precision,
        tick_ms=play.tick_ms,
    )
    state = sim.state()
    for name in ("position", "velocity", "yaw"):
        state[name] = getattr(play, name)
    state["position"][:, 0] += NUDGE if nudged else 0.0
    sim.set_state(state)
    ticks = len(play.inputs)
    position = np.empty((ticks // every + 1, *play.position.shape))
    velocity = np.empty_like(position)
    for tick in range(ticks + 1):
        if tick % every == 0:
            state = sim.state()
            position[tick // every], velocity[tick // every] = state["position"], state["velocity"]
        if tick < ticks:
            if tick in play.blasts:
                sim.explode(play.blasts[tick])
            sim.step(play.inputs[tick])
    return Path(position, np.linalg.norm(velocity, axis=-1))


def compare(plays: Sequence[Play], tiers: Sequence[str], done: Callable[[int], object]) -> dict[str, Errors]:
    """Errors of each tier over all plays.

    Args:
        plays: the batches of one situation, all equally long.
        tiers: names of tiers.
        done: is told the player-ticks of each batch that was played.
    """
    position: dict[str, list[Floats]] = {tier: [] for tier in tiers}
    speed: dict[str, list[Floats]] = {tier: [] for tier in tiers}
    for play in plays:
        truth = run(play, "reference")
        done(play.inputs.size)
        for tier in tiers:
            path = run(play, tier)
            position[tier].append(np.linalg.norm(path.position - truth.position, axis=-1))
            speed[tier].append(np.abs(path.speed - truth.speed))
            done(play.inputs.size)
    return {tier: Errors(np.hstack(position[tier]), np.hstack(speed[tier])) for tier in tiers}


def rows(situation: str, tier: str, errors: Errors) -> list[dict[str, Any]]:
    """The figures of one tier in one situation, one row for each of `SECONDS` that was played."""
    made = []
    for seconds in SECONDS:
        tick = ticks_of(seconds)
        if tick < len(errors.position):
            position, speed = errors.position[tick], errors.speed[tick]
            made.append(
                {
                    "situation": situation,
                    "tier": tier,
                    "seconds": seconds,
                    "ticks": tick,
                    "position": spread(position),
                    "speed": spread(speed),
                    "over": {f"{limit:g}": float((position > limit).mean()) for limit in SHARES},
                }
            )
    return made


def spread(errors: Floats) -> dict[str, float]:
    """Median, 95th percentile and largest.

    >>> spread(np.arange(101.0))
    {'median': 50.0, 'p95': 95.0, 'largest': 100.0}
    """
    median, p95, largest = np.quantile(errors, [0.5, 0.95, 1.0])
    return {"median": float(median), "p95": float(p95), "largest": float(largest)}


def curve_ticks(ticks: int, points: int = 50) -> list[int]:
    """At most so many ticks from 1 to `ticks`, evenly spaced.

    >>> curve_ticks(9, points=5)
    [1, 3, 5, 7, 9]
    """
    return [int(tick) for tick in np.unique(np.linspace(1, ticks, points).round())]


def curve(errors: Errors, ticks: list[int]) -> dict[str, list[float]]:
    """Medians and 95th percentiles of the position error at these ticks, m."""
    median, p95 = np.quantile(errors.position[ticks], [0.5, 0.95], axis=1)
    return {"median": median.tolist(), "p95": p95.tolist()}
