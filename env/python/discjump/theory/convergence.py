"""Errors against the continuous motion by length of the tick, and the order with which they shrink."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discjump._native import Terrain
from discjump.theory import forms
from discjump.theory.lab import Floats, Tier, after, exact32, incline, level

TICKS_MS = (1, 2, 4, 8, 16, 32, 64)
"""Lengths of a tick; all divide the seconds of every case."""
ALTITUDE = 200.0
"""Of flights above the ground, m: where a map's players are, and float32 knows no finer than 15 um."""


@dataclass(frozen=True)
class Case:
    """A motion with a closed form."""

    what: str
    #: Order of the place by theory, in either model, and why.
    order: dict[str, str]
    seconds: float
    terrain: Callable[[], Terrain]
    keys: dict[str, Any]
    #: Draws the fields of a state for so many players.
    fields: Callable[[np.random.Generator, int], dict[str, Floats]]
    #: Fields at the start and seconds to (position, velocity), (n, 3) each.
    exact: Callable[[dict[str, Floats], float], tuple[Floats, Floats]]
    #: The shortest tick that an order is fitted to, ms: below it other errors take over.
    shortest: int = TICKS_MS[0]


def _thrown(rng: np.random.Generator, count: int) -> dict[str, Floats]:
    velocity = rng.uniform([-30.0, -30.0, 0.0], [30.0, 30.0, 30.0], (count, 3))
    return {"position": np.tile([0.0, 0.0, ALTITUDE], (count, 1)), "velocity": velocity}


def _even(up: float) -> Callable[[dict[str, Floats], float], tuple[Floats, Floats]]:
    def exact(fields: dict[str, Floats], t: float) -> tuple[Floats, Floats]:
        gained = np.array([0.0, 0.0, up])
        v = fields["velocity"]
        return fields["position"] + v * t + 0.5 * gained * t**2, v + gained * t

    return exact


def _ahead(rng: np.random.Generator, count: int) -> dict[str, Floats]:
    velocity = np.zeros((count, 3))
    velocity[:, 1] = rng.uniform(-5.0, 20.0, count)
    velocity[:, 2] = rng.uniform(0.0, 20.0, count)
    return {"position": np.tile([0.0, 0.0, ALTITUDE], (count, 1)), "velocity": velocity}


def _faded(fields: dict[str, Floats], t: float) -> tuple[Floats, Floats]:
    position, velocity = fields["position"].copy(), fields["velocity"].copy()
    for p, v in zip(position, velocity, strict=True):
        flown = forms.fading(forms.ARMORS["light"], v[1], v[2], t)
        p += [0.0, flown.way, flown.climb]
        v[:] = [0.0, flown.speed, flown.climb_speed]
    return position, velocity


def _running(rng: np.random.Generator, count: int) -> dict[str, Floats]:
    velocity = np.zeros((count, 3))
    velocity[:, 1] = rng.uniform(35.0, 60.0, count)
    return {
        "position": np.zeros((count, 3)),
        "velocity": velocity,
        "touched": np.ones(count),
        "friction": np.ones(count),
    }


def _braked(fields: dict[str, Floats], t: float) -> tuple[Floats, Floats]:
    velocity = fields["velocity"] - [0.0, forms.GROUND_LIGHT * t, 0.0]
    return fields["position"] + 0.5 * (fields["velocity"] + velocity) * t, velocity


SLOPE = 30.0
"""Of the landing, degrees."""


def _falling(rng: np.random.Generator, count: int) -> dict[str, Floats]:
    position, velocity = np.zeros((count, 3)), np.zeros((count, 3))
    position[:, 2] = rng.uniform(0.5, 3.0, count)
    velocity[:, 1] = rng.uniform(30.0, 40.0, count)
    velocity[:, 2] = -rng.uniform(25.0, 35.0, count)
    return {"position": position, "velocity": velocity}


def _landed(fields: dict[str, Floats], t: float) -> tuple[Floats, Floats]:
    sin, cos = np.sin(np.radians(SLOPE)), np.cos(np.radians(SLOPE))
    down = np.array([0.0, cos, -sin])
    position, velocity = np.zeros_like(fields["position"]), np.zeros_like(fields["position"])
    for k, (p, v) in enumerate(zip(fields["position"], fields["velocity"], strict=True)):
        speed, way = forms.slide_and_land(SLOPE, p[2], v[1], -v[2], t)
        # The start's foot on the plane, and from there along it.
        position[k] = (p @ down + way) * down
        velocity[k] = speed * down
    return position, velocity


FIRST = "1: velocity first, then the place"
CASES = {
    "free flight": Case(
        "nothing but gravity",
        {
            "article": "1: half a tick further down, g t dt/2",
            "engine": "exact: the mean velocity is gravity's",
        },
        2.048,
        level,
        {},
        _thrown,
        _even(-forms.GRAVITY),
    ),
    "jets up": Case(
        "jets alone, straight up",
        {"article": FIRST, "engine": "exact: the thrust is even"},
        2.048,
        level,
        {"jet": True},
        _thrown,
        _even(forms.ARMORS["light"].jet - forms.GRAVITY),
    ),
    "jets ahead": Case(
        "jets and forward, whose thrust fades with speed",
        {"article": "1: the thrust is the tick's first", "engine": "1: the thrust is the tick's first"},
        2.048,
        level,
        {"jet": True, "forward": 1},
        _ahead,
        _faded,
    ),
    "braking": Case(
        "ground friction on level ground, 35 to 60 m/s without keys",
        {
            "article": f"{FIRST}; from 8 ms on, for in shorter ticks the outward push lifts off the ground",
            "engine": "1: what follows a contact moves at the new velocity; from 8 ms on",
        },
        0.768,
        level,
        {},
        _running,
        _braked,
        8,
    ),
    "landing": Case(
        "a fall onto 30 degrees and the slide after it",
        {"article": "none: bounded by the tick", "engine": "none: bounded by the tick"},
        0.768,
        lambda: incline(SLOPE),
        {},
        _falling,
        _landed,
    ),
}
"""By name."""


EXACT = 1e-9
"""Errors below are rounding of float64, m and m/s: no order is fitted to them."""


def errors(case: Case, tier: Tier, starts: int, seed: int = 0) -> dict[str, Floats]:
    """Errors after `case.seconds`, of place (m) and velocity (m/s): (lengths of a tick, starts)."""
    fields = {name: exact32(v) for name, v in case.fields(np.random.default_rng(seed), starts).items()}
    terrain, (place, velocity) = case.terrain(), case.exact(fields, case.seconds)
    off: dict[str, list[Floats]] = {"place": [], "velocity": []}
    for tick_ms in TICKS_MS:
        ticks = round(1000.0 * case.seconds) // tick_ms
        state = after(tier, terrain, fields, case.keys, ticks, tick_ms=tick_ms)
        off["place"].append(np.linalg.norm(state["position"] - place, axis=1))
        off["velocity"].append(np.linalg.norm(state["velocity"] - velocity, axis=1))
    return {name: np.array(values) for name, values in off.items()}


def orders(off: Floats, ticks_ms: Sequence[int] = TICKS_MS, shortest: int = TICKS_MS[0]) -> Floats:
    """Slope of log error against log tick by least squares, one for each start; NaN where one is rounding.

    >>> orders(np.array([[1e-3, 1e-15], [2e-3, 0.0], [4e-3, 0.0]]), (1, 2, 4)).round(12)
    array([ 1., nan])
    """
    fitted = np.full(off.shape[1], np.nan)
    ticks = np.array(ticks_ms)
    off, ticks = off[ticks >= shortest], ticks[ticks >= shortest]
    real = (off > EXACT).all(axis=0)
    if real.any():
        fitted[real] = np.polyfit(np.log(ticks), np.log(off[:, real]), 1)[0]
    return fitted


def measure(name: str, tier: Tier, starts: int, twin: dict[str, Floats] | None = None) -> dict[str, Any]:
    """Errors by length of the tick and their order, in one tier.

    Args:
        twin: errors of the same movement in float64; what is beyond them is float32's.

    Returns:
        For `place` and `velocity`, medians over the starts:
        `median`: errors by length of the tick.
        `order`: median, lowest and highest of the starts' slopes; None where the tier's errors, or its
        twin's, are rounding.
        `rounding`: what float32 changes, by length of the tick; None without a twin.
    """
    off = errors(CASES[name], tier, starts)
    made: dict[str, Any] = {
        "case": name,
        "tier": tier.name,
        "theory": CASES[name].order[tier.model],
        "ticks_ms": list(TICKS_MS),
    }
    for what, values in off.items():
        shortest = CASES[name].shortest
        fitted = orders(values, shortest=shortest)
        order = None
        # Where the same movement has no error in float64, float32's is rounding, which has no order.
        exact = twin is not None and np.isnan(orders(twin[what], shortest=shortest)).any()
        if np.isfinite(fitted).all() and not exact:
            order = {
                "median": float(np.median(fitted)),
                "low": float(fitted.min()),
                "high": float(fitted.max()),
            }
        made[what] = {
            "median": np.median(values, axis=1).tolist(),
            "order": order,
            "rounding": None if twin is None else np.median(np.abs(values - twin[what]), axis=1).tolist(),
        }
    return made
