"""From a direction one wants to press to the keys and the turn that press it.

The movement keys give eight directions relative to the yaw; the diagonals lie at atan(10/11), since walking
sideways is slower than walking ahead. The nearest one is pressed at once and the yaw turned until it fits
exactly.
"""

import numpy as np

from discjump_training.policy import Floats

_FORWARD = np.array([1.0, 1.0, 0.0, -1.0, -1.0, -1.0, 0.0, 1.0])
_STRAFE = np.array([0.0, -1.0, -1.0, -1.0, 0.0, 1.0, 1.0, 1.0])
#: Angles of the eight key combinations, counter-clockwise from straight ahead.
ANGLES = np.arctan2(-10.0 * _STRAFE, 11.0 * _FORWARD)


def wrap(angle: Floats) -> Floats:
    """The same angle in [-pi, pi)."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def press(angle: Floats, seconds: float) -> tuple[Floats, Floats, Floats]:
    """Keys and turn that press the direction `angle`.

    Args:
        angle: wanted direction relative to the yaw, counter-clockwise, shape (n,).
        seconds: time within which the turn should be done.

    Returns:
        forward and strafe in {-1, 0, 1} and turn in rad/s (positive to the left), each of shape (n,).
    """
    off = wrap(angle[:, None] - ANGLES)
    key = np.argmin(np.abs(off), axis=1)
    rest = np.take_along_axis(off, key[:, None], axis=1)[:, 0]
    return _FORWARD[key], _STRAFE[key], rest / seconds
