"""Checks of arguments: every message names the argument, what was expected and what came."""

import difflib
from collections.abc import Collection, Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

SEEDS = 2**64
"""Seeds are unsigned 64-bit integers."""


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def integer(name: str, value: object, low: int, high: int) -> int:
    """`value` as an int in [low, high].

    Raises:
        TypeError: not an integer (a bool is none).
        ValueError: out of range.

    >>> integer("frame_skip", 4, 1, 64)
    4
    >>> integer("frame_skip", 0, 1, 64)
    Traceback (most recent call last):
    ValueError: frame_skip: expected an integer from 1 to 64, got 0
    """
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Integral):
        came = f"{_shown(value)} of type {type(value).__name__}"
        raise TypeError(f"{name}: expected an integer from {low} to {high}, got {came}")
    if not low <= int(value) <= high:
        raise ValueError(f"{name}: expected an integer from {low} to {high}, got {_shown(value)}")
    return int(value)


def real(name: str, value: object, low: float, high: float, unit: str, *, open_low: bool = False) -> float:
    """`value` as a finite float in [low, high], or (low, high] with `open_low`.

    Raises:
        TypeError: not a real number (a bool is none).
        ValueError: NaN, infinite or out of range.

    >>> real("time_limit", 60, 0.0, 3600.0, "s", open_low=True)
    60.0
    >>> real("time_limit", float("nan"), 0.0, 3600.0, "s", open_low=True)
    Traceback (most recent call last):
    ValueError: time_limit: expected a number in (0, 3600] s, got nan
    """
    span = f"a number in {'(' if open_low else '['}{low:g}, {high:g}]{' ' if unit else ''}{unit}"
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        raise TypeError(f"{name}: expected {span}, got {_shown(value)} of type {type(value).__name__}")
    number = float(value)
    if not low <= number <= high or (open_low and number == low):
        raise ValueError(f"{name}: expected {span}, got {number:g}")
    return number


def flag(name: str, value: object) -> bool:
    """`value` as a bool; integers are refused.

    >>> flag("landing", 1)
    Traceback (most recent call last):
    TypeError: landing: expected True or False, got 1 of type int
    """
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: expected True or False, got {_shown(value)} of type {type(value).__name__}")
    return bool(value)


def choice(name: str, value: object, choices: Collection[str]) -> str:
    """`value`, one of `choices`.

    >>> choice("armor", "lihgt", ("light",))
    Traceback (most recent call last):
    ValueError: armor: expected one of 'light', got 'lihgt'; did you mean 'light'?
    """
    if not isinstance(value, str):
        raise TypeError(
            f"{name}: expected one of {_listed(choices)}, got {_shown(value)} of type {type(value).__name__}"
        )
    if value not in choices:
        raise ValueError(
            f"{name}: expected one of {_listed(choices)}, got {value!r}{nearest(value, choices)}"
        )
    return value


def sequence(name: str, value: object, of: str) -> list[Any]:
    """`value`, a sequence or an array of one dimension, as a list.

    >>> sequence("fan_ranges", 5, "numbers in m")
    Traceback (most recent call last):
    TypeError: fan_ranges: expected a sequence of numbers in m, got 5 of type int
    """
    if isinstance(value, (str, bytes)) or not isinstance(value, (Sequence, np.ndarray)):
        raise TypeError(
            f"{name}: expected a sequence of {of}, got {_shown(value)} of type {type(value).__name__}"
        )
    if isinstance(value, np.ndarray) and value.ndim != 1:
        raise ValueError(f"{name}: expected a sequence of {of}, got an array of shape {value.shape}")
    return list(value)


def known(name: str, given: Iterable[object], names: Collection[str]) -> None:
    """Every one of `given` is among `names`.

    >>> known("options", ["strat"], ("start", "goal"))
    Traceback (most recent call last):
    ValueError: options: expected keys among 'goal', 'start', got 'strat'; did you mean 'start'?
    """
    for key in given:
        if key not in names:
            hint = nearest(key, names) if isinstance(key, str) else ""
            raise ValueError(f"{name}: expected keys among {_listed(sorted(names))}, got {key!r}{hint}")


def array(name: str, value: object, shapes: Collection[tuple[int, ...]], unit: str) -> NDArray[np.float64]:
    """`value` as a float64 array of one of `shapes`; whether it is finite is left to the caller.

    Raises:
        TypeError: not made of real numbers.
        ValueError: another shape.

    >>> array("start", (1, 2), [(2,), (3,)], "m")
    array([1., 2.])
    >>> array("start", "here", [(2,), (3,)], "m")
    Traceback (most recent call last):
    TypeError: start: expected numbers of shape (2,) or (3,) in m, got 'here' of type str
    """
    wanted = f"numbers of shape {' or '.join(map(str, shapes))} in {unit}"
    given = numbers(name, value, wanted)
    if given.dtype.kind not in "iuf":
        raise TypeError(f"{name}: expected {wanted}, got {_shown(value)} of type {type(value).__name__}")
    if given.shape not in shapes:
        raise ValueError(f"{name}: expected {wanted}, got shape {given.shape}")
    return given.astype(np.float64)


def numbers(name: str, value: object, wanted: str) -> NDArray[Any]:
    """`value` as an array of any kind, where it has a shape at all.

    >>> numbers("points", [[1, 2, 3], [4, 5]], "numbers of shape (n, 3) in m")
    Traceback (most recent call last):
    ValueError: points: expected numbers of shape (n, 3) in m, got the ragged [[1, 2, 3], [4, 5]]
    """
    try:
        return np.asarray(value)
    except ValueError:
        raise ValueError(f"{name}: expected {wanted}, got the ragged {_shown(value)}") from None


def nearest(value: str, names: Iterable[str]) -> str:
    """A hint for a misspelled name, empty when nothing is near."""
    near = difflib.get_close_matches(value, list(names), n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def _listed(names: Iterable[str]) -> str:
    return ", ".join(map(repr, names))
