"""How the push of an explosion falls off with distance, by the core's own formulas."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discjump import _check, _native

_LARGEST = 1e6
"""Largest radius and box side, m."""


def knockback(
    distance: ArrayLike,
    formula: str = "tribes",
    radius: float = 7.5,
    min_box: float = 1.0,
    cutoff: str = "engine",
) -> NDArray[np.float64]:
    """Power of a blast's push at a distance: without dimension, never negative.

    A player's velocity changes by kick * coverage / mass times this, away from the blast: the kick is 150
    for a disc, the mass 9, 13 or 18 for a light, medium or heavy. The defaults are a disc and a light.
    With R = radius, m = min_box and d0 = distance (core/docs/physics.md, section 6):

    - "tribes": (1 - d/R) d0/d with d = max(d0 - m, 1), and 0 where d >= R; strongest at d0 = 1 + m
    - "basic": 1 - d0/R, and 0 where d0 >= R
    - "linear_boosted": basic times 26/11, which is as strong as "tribes" at its peak for a disc and a light

    Args:
        distance: from the blast to the centre of the player's box, m; finite, at least 0, any shape.
        formula: "tribes", "basic" or "linear_boosted".
        radius: of the explosion, in (0, 1e6] m.
        min_box: smallest side of the player's box, in [0, 1e6] m: 1.0, 1.4, 1.6 for the three armors.
        cutoff: where "tribes" ends: "engine", at d = R, or "radius", beyond d0 = R.

    Returns:
        float64, the shape of `distance`.

    Raises:
        TypeError: an argument of another type.
        ValueError: an argument out of range or unknown.

    >>> knockback([0.0, 1.15, 2.0, 8.5]).round(4)
    array([0.    , 0.9967, 1.7333, 0.    ])
    """
    return falloff(distance, formula, radius, min_box, cutoff)[0]


def falloff(
    distance: ArrayLike, formula: str, radius: float, min_box: float, cutoff: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The power, as `knockback`, and the share of the largest damage, which is the same for all formulas."""
    metres = _distance(distance)
    push, hurt = _native.blast_falloff(
        metres.ravel(),
        _text("formula", formula),
        _check.real("radius", radius, 0.0, _LARGEST, "m", open_low=True),
        _check.real("min_box", min_box, 0.0, _LARGEST, "m"),
        _text("cutoff", cutoff),
    )
    return push.reshape(metres.shape), hurt.reshape(metres.shape)


def _text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected a name, got {value!r} of type {type(value).__name__}")
    return value


def _distance(value: ArrayLike) -> NDArray[np.float64]:
    wanted = "finite numbers of any shape, at least 0, in m"
    try:
        given = np.asarray(value)
    except ValueError:
        raise ValueError(f"distance: expected {wanted}, got a ragged sequence") from None
    if given.dtype.kind not in "iuf":
        raise TypeError(f"distance: expected {wanted}, got dtype {given.dtype}")
    metres = np.ascontiguousarray(given, dtype=np.float64).reshape(given.shape)
    bad = ~(np.isfinite(metres) & (metres >= 0.0))
    if bad.any():
        at = tuple(int(i) for i in np.argwhere(bad)[0])
        place = f" at {at}" if at else ""
        raise ValueError(f"distance: expected {wanted}, got {metres[at]}{place}")
    return metres
