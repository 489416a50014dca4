"""What a batch shows of its environments: columns, one row per environment, and where two of them differ."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Column = NDArray[Any]

INFO = "info."
"""Begins the names of an info's columns: `info.speed`, and `info._speed`, which says where it is given."""


class Part(NamedTuple):
    """The next row of some environments: their first observation, or what a step made of them."""

    indices: NDArray[np.int64]
    """(k,), which environments of the batch."""
    columns: Mapping[str, Column]
    """Name to (k, ...). A column of an info that is absent is given nowhere."""
    hidden: frozenset[str] = frozenset()
    """Columns that this way in cannot show, so that they are not compared; `info` for all of an info."""
    narrow: frozenset[str] = frozenset()
    """Columns that this way in shows rounded to float32."""


def take(columns: Mapping[str, Column], rows: Any) -> dict[str, Column]:
    """The same columns of some rows."""
    return {name: column[rows] for name, column in columns.items()}


def joined(parts: Sequence[Part]) -> list[Part]:
    """Fewer parts with the same rows: those of equal columns in one, in the order of the first of them."""
    alike: dict[Any, list[Part]] = {}
    for part in parts:
        alike.setdefault((frozenset(part.columns), part.hidden, part.narrow), []).append(part)
    return [
        Part(
            np.concatenate([part.indices for part in group]),
            {name: np.concatenate([part.columns[name] for part in group]) for name in group[0].columns},
            *group[0][2:],
        )
        for group in alike.values()
    ]


def info_columns(info: Mapping[str, Any], prefix: str = INFO) -> dict[str, Column]:
    """The columns of a vector environment's info; those of episodes that ended in a same-step autoreset are
    left out.

    >>> sorted(info_columns({"speed": np.zeros(2), "_speed": np.ones(2, bool), "final_obs": None}))
    ['info._speed', 'info.speed']
    """
    columns: dict[str, Column] = {}
    for key, value in info.items():
        if key in ("final_obs", "_final_obs", "final_info", "_final_info"):
            continue
        if isinstance(value, Mapping):
            columns |= info_columns(value, f"{prefix}{key}.")
        else:
            columns[prefix + key] = np.asarray(value)
    return columns


def differing(got: Column, expected: Column) -> NDArray[np.bool_]:
    """(k,): the rows of two columns that differ in a bit; padding within a row is no part of it.

    >>> differing(np.array([0.0, -0.0, np.nan]), np.array([0.0, 0.0, np.nan])).tolist()
    [False, True, False]
    """
    if got.dtype != expected.dtype or got.shape != expected.shape:
        return np.ones(len(expected), np.bool_)
    if got.tobytes() == expected.tobytes():
        return np.zeros(len(expected), np.bool_)
    if got.dtype.names is None:
        rows = _bytes(got) != _bytes(expected)
        return np.asarray(rows.any(axis=1))
    fields = [differing(got[name], expected[name]) for name in got.dtype.names]
    return np.asarray(np.logical_or.reduce(fields))


def leaves(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """The single numbers of one row of a column with their names.

    >>> [leaf for leaf, _ in leaves("goal", np.zeros(2))]
    ['goal[0]', 'goal[1]']
    """
    if isinstance(value, np.void) and value.dtype.names is not None:
        for field in value.dtype.names:
            yield from leaves(f"{name}.{field}", value[field])
    elif np.ndim(value):
        for index in np.ndindex(np.shape(value)):
            yield from leaves(f"{name}[{', '.join(map(str, index))}]", value[index])
    else:
        yield name, np.asarray(value)[()]


def ulps(one: Any, other: Any) -> int | None:
    """Numbers that lie between two floating-point numbers of one type, the farther one included; None for
    others.

    >>> ulps(np.float32(1), np.nextafter(np.float32(1), np.float32(2)))
    1
    >>> ulps(np.float64(0.0), np.float64(-0.0))
    0
    """
    one, other = np.asarray(one), np.asarray(other)
    if one.dtype != other.dtype or one.dtype.kind != "f" or not (np.isfinite(one) and np.isfinite(other)):
        return None
    low = -(1 << (8 * one.dtype.itemsize - 1))
    bits = [int(number.view(f"i{number.dtype.itemsize}")) for number in (one, other)]
    first, second = (place if place >= 0 else low - place for place in bits)
    distance: int = abs(first - second)
    return distance


def canonical(column: Column) -> Iterator[bytes]:
    """The bytes of a column for a digest: little-endian, one NaN, without padding."""
    if column.dtype.names is not None:
        for name in column.dtype.names:
            yield from canonical(column[name])
        return
    if column.dtype.kind == "f":
        column = np.where(np.isnan(column), column.dtype.type(np.nan), column)
    yield np.ascontiguousarray(column, column.dtype.newbyteorder("<")).tobytes()


def _bytes(column: Column) -> NDArray[np.uint8]:
    rows = np.ascontiguousarray(column)
    return rows.view(np.uint8).reshape(len(rows), -1) if rows.ndim > 1 else rows[:, None].view(np.uint8)
