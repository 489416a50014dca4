"""Push of a disc's explosion by distance, against section 6."""

from typing import Any

import numpy as np

from discjump.simulator import Physics
from discjump.theory import forms
from discjump.theory.lab import Floats, Tier, level, make

FORMULAS = ("tribes", "basic", "linear_boosted")
FARTHEST = 8.5
"""m: where the table of section 6 ends. Straight below, the cube about a blast ends beyond it."""
DEPTH = 50.0
"""Of the ground below the player, m: nothing is covered, and coordinates are small."""


def distances(points: int) -> Floats:
    """From 0 to `FARTHEST`, even; the table's quarters of a metre are among them.

    >>> distances(34 * 2 + 1)[:5].tolist()
    [0.0, 0.125, 0.25, 0.375, 0.5]
    """
    return np.linspace(0.0, FARTHEST, points)


def pushes(tier: Tier, armor: str, formula: str, below: Floats) -> Floats:
    """Speed upwards, m/s, that a blast so many metres below the box's centre gives."""
    sim = make(
        tier, level(-DEPTH), len(below), armor=armor, physics=Physics(knockback=formula), scene="sandbox"
    )
    state = sim.state()
    state["position"] = 0.0
    sim.set_state(state)
    points = np.zeros((len(below), 3))
    points[:, 2] = 0.5 * forms.ARMORS[armor].height - below
    sim.explode(points)
    speeds: Floats = sim.state()["velocity"][:, 2].astype(np.float64)
    return speeds


def law(armor: str, formula: str, below: Floats) -> Floats:
    """The same by section 6; a blast in the very centre has no direction."""
    kind = forms.ARMORS[armor]
    power = np.array([forms.power(formula, d, kind.min_box) if d > 0.0 else 0.0 for d in below])
    return forms.DISC_KICK / kind.mass * power


def measure(tier: Tier, armor: str, formula: str, points: int) -> dict[str, Any]:
    """The largest difference over the sweep, m/s, and where it is."""
    below = distances(points)
    got, wanted = pushes(tier, armor, formula, below), law(armor, formula, below)
    off = np.abs(got - wanted)
    return {
        "tier": tier.name,
        "armor": armor,
        "formula": formula,
        "points": points,
        "peak": float(got.max()),
        "peak_at": float(below[got.argmax()]),
        "largest": float(off.max()),
        "largest_at": float(below[off.argmax()]),
    }
