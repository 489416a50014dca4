"""What a player touches in the tick after which two sides differ."""

import numpy as np
from numpy.typing import NDArray

from discjump._text import shown
from discjump.bisect.lockstep import Parting
from discjump.bisect.sides import Side
from discjump.bisect.start import just_before


def contact_list(sides: tuple[Side, Side], parting: Parting) -> tuple[list[str], list[str]]:
    """The contacts of the tick on both sides, in their order, one line each."""
    return _of(sides[0], parting, 0), _of(sides[1], parting, 1)


def _of(side: Side, parting: Parting, k: int) -> list[str]:
    if parting.before is None:
        return ["none: it is the beginning"]
    if side.python is not None:
        return ["not known: another installation plays it"]
    sim, inputs, _ = just_before(side, parting, k)
    row = parting.difference.row
    found = sim.contacts(row, inputs[0, row])
    real = sim.state_dtype["velocity"].base
    return [
        f"at {_in(real, one['position'])} m, moving {_in(real, one['velocity'])} m/s, "
        f"normal {_in(real, one['normal'])}"
        for one in found
    ] or ["none"]


def _in(real: np.dtype[np.generic], vector: NDArray[np.float64]) -> str:
    """A vector in the digits of the tier's arithmetic."""
    return shown(vector.astype(real))
