"""Which configurations no other beats in both speed and error."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discjump_training.tradeoff.section import Panel


def undominated(speed: ArrayLike, error: ArrayLike) -> NDArray[np.bool_]:
    """Which entries no other dominates.

    One dominates another if it is at least as fast and at most as wrong, and one of the two truly.

    Args:
        speed: (n,), more is better.
        error: (n,), less is better.

    Returns:
        (n,) bool; of equal entries all or none.

    >>> undominated([1.0, 2.0, 3.0, 3.0], [0.0, 0.5, 0.4, 0.4]).tolist()
    [True, False, True, True]
    """
    fast, wrong = np.asarray(speed, np.float64), np.asarray(error, np.float64)
    kept = np.zeros(len(fast), np.bool_)
    # From the fastest down: what is slower must be less wrong than all before, or equal to the last kept.
    least, at = np.inf, np.inf
    for index in np.lexsort((wrong, -fast)):
        if wrong[index] < least:
            least, at = wrong[index], fast[index]
            kept[index] = True
        else:
            kept[index] = wrong[index] == least and fast[index] == at
    return kept


def unbeaten(panel: Panel) -> list[bool]:
    """Whether no other point of the panel dominates a point, by median speed."""
    speeds, errors = zip(*((point.speed[0], point.error) for point in panel.points), strict=True)
    kept: list[bool] = undominated(speeds, errors).tolist()
    return kept
