"""How far two floating-point numbers are apart: units in the last place."""

from typing import Any

import numpy as np


def ulps(one: Any, other: Any, dtype: Any = None) -> int | None:
    """How many steps to a neighbouring number lead from one to the other; None where one is NaN or no float.

    Zeros of both signs are one number: 0. They are counted in `dtype`, to which
    both are rounded first; None: the shorter one's of the two.

    >>> ulps(np.float32(1), np.nextafter(np.float32(1), np.float32(2)))
    1
    >>> ulps(-np.nextafter(0.0, 1.0), np.nextafter(0.0, 1.0))
    2
    """
    first, second = np.asarray(one), np.asarray(other)
    if first.dtype.kind != "f" or second.dtype.kind != "f":
        return None
    short = min(first.dtype, second.dtype, key=lambda d: d.itemsize) if dtype is None else dtype
    with np.errstate(over="ignore"):
        first, second = first.astype(short), second.astype(short)
    if np.isnan(first) or np.isnan(second):
        return None
    return abs(_place(first) - _place(second))


def _place(number: Any) -> int:
    """The number's place among all of its dtype, 0 at zero."""
    size = 8 * number.dtype.itemsize
    bits = int(number.view(f"u{number.dtype.itemsize}"))
    magnitude = bits & ((1 << (size - 1)) - 1)
    place: int = -magnitude if bits >> (size - 1) else magnitude
    return place
