"""Nested values: observations, actions and infos, compared and copied bit for bit.

A tree is a numpy array, a dict or a tuple (list) of trees, or any other Python value. A batched tree has one
row for each environment in every array; arrays of dtype object hold one tree in each row.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import starmap
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Difference:
    """The first place where two trees differ: its path (`.key[index]`) and what stands there in each."""

    path: str
    left: str
    right: str

    def __str__(self) -> str:
        return f"{self.path.lstrip('.') or 'value'}: {self.left} against {self.right}"


def frozen(tree: Any) -> Any:
    """A copy that shares no memory with `tree`.

    >>> array = np.zeros(2)
    >>> kept = frozen({"a": (array, 1)})
    >>> array += 1
    >>> kept
    {'a': (array([0., 0.]), 1)}
    """
    if isinstance(tree, np.ndarray):
        if tree.dtype != object:
            return np.array(tree, copy=True)
        copy = np.empty_like(tree, subok=False)
        for index in np.ndindex(tree.shape):
            copy[index] = frozen(tree[index])
        return copy
    if isinstance(tree, dict):
        return {key: frozen(value) for key, value in tree.items()}
    if isinstance(tree, tuple):
        return tuple(frozen(value) for value in tree)
    if isinstance(tree, list):
        return [frozen(value) for value in tree]
    if hasattr(tree, "__array__") and not isinstance(tree, np.generic):
        # Another library's array, such as a tensor on the CPU, may change as well.
        return np.array(tree, copy=True)
    return tree


def difference(left: Any, right: Any, path: str = "") -> Difference | None:
    """The first difference, or None if both are equal in type, dtype, shape and every bit.

    >>> print(difference({"a": np.array([0.0, 1.0])}, {"a": np.array([0.0, 2.0])}))
    a[1]: 1.0 against 2.0
    >>> print(difference(np.array([0.0]), np.array([-0.0])))
    [0]: 0.0 against -0.0
    >>> difference(np.array([np.nan]), np.array([np.nan])) is None
    True
    """
    if isinstance(left, np.ndarray) and isinstance(right, np.ndarray):
        return _array_difference(left, right, path)
    if isinstance(left, dict) and isinstance(right, dict):
        if left.keys() != right.keys():
            return Difference(path, f"keys {sorted(map(str, left))}", f"keys {sorted(map(str, right))}")
        return _first(difference(left[key], right[key], f"{path}.{key}") for key in left)
    if isinstance(left, (tuple, list)) and isinstance(right, (tuple, list)):
        if type(left) is not type(right) or len(left) != len(right):
            return Difference(path, _shown(left), _shown(right))
        pairs = enumerate(zip(left, right, strict=True))
        return _first(difference(one, other, f"{path}[{index}]") for index, (one, other) in pairs)
    if type(left) is not type(right):
        return Difference(path, _shown(left), _shown(right))
    if isinstance(left, (float, np.floating)):
        return _array_difference(np.asarray(left), np.asarray(right), path)
    return None if left is right or _equal(left, right) else Difference(path, _shown(left), _shown(right))


def take(tree: Any, rows: Sequence[int] | NDArray[np.int64]) -> Any:
    """These rows of a batched tree, in this order.

    >>> take({"a": np.array([5, 6, 7])}, [2, 0])
    {'a': array([7, 5])}
    """
    if isinstance(tree, np.ndarray):
        return tree[np.asarray(rows, np.int64)] if tree.ndim and len(tree) > max(rows, default=-1) else tree
    if isinstance(tree, dict):
        return {key: take(value, rows) for key, value in tree.items()}
    if isinstance(tree, tuple):
        return tuple(take(value, rows) for value in tree)
    return tree


def row(tree: Any, index: int) -> Any:
    """One environment's part of a batched tree: what a single environment would have returned."""
    if isinstance(tree, np.ndarray):
        return tree[index] if tree.ndim and len(tree) > index else tree
    if isinstance(tree, dict):
        return {key: row(value, index) for key, value in tree.items()}
    return tuple(row(value, index) for value in tree) if isinstance(tree, tuple) else tree


def same_values(left: Any, right: Any) -> bool:
    """Whether all numbers are equal, whatever types hold them.

    >>> same_values({"a": np.int64(3)}, {"a": 3})
    True
    """
    if isinstance(left, dict) and isinstance(right, dict):
        return left.keys() == right.keys() and all(same_values(left[key], right[key]) for key in left)
    if isinstance(left, (tuple, list)) and isinstance(right, (tuple, list)):
        return len(left) == len(right) and all(starmap(same_values, zip(left, right, strict=True)))
    return bool(np.array_equal(np.asarray(left), np.asarray(right)))


def leaves(tree: Any, path: str = "") -> Iterator[tuple[str, NDArray[Any]]]:
    """Every array of a tree with its path; those inside of arrays of dtype object too."""
    if isinstance(tree, np.ndarray):
        yield path, tree
        if tree.dtype == object:
            for index, value in enumerate(tree.flat):
                yield from leaves(value, f"{path}[{index}]")
    elif isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, f"{path}.{key}")
    elif isinstance(tree, (tuple, list)):
        for index, value in enumerate(tree):
            yield from leaves(value, f"{path}[{index}]")


def scribble(tree: Any) -> None:
    """Overwrite every array that can be written to."""
    for _, array in leaves(tree):
        if array.flags.writeable:
            numeric = np.issubdtype(array.dtype, np.number)
            array[...] = 7 if numeric else True if array.dtype == np.bool_ else np.zeros((), array.dtype)


def without(info: dict[str, Any], ignored: frozenset[str], path: str = "") -> dict[str, Any]:
    """`info` without the ignored keys (dotted paths) and their masks."""
    if not ignored:
        return info
    kept: dict[str, Any] = {}
    for key, value in info.items():
        name = path + key.removeprefix("_")
        if name not in ignored:
            kept[key] = without(value, ignored, f"{name}.") if isinstance(value, dict) else value
    return kept


def _first(differences: Iterator[Difference | None]) -> Difference | None:
    return next((found for found in differences if found is not None), None)


def _array_difference(left: NDArray[Any], right: NDArray[Any], path: str) -> Difference | None:
    if left.dtype != right.dtype or left.shape != right.shape:
        return Difference(path, f"{left.dtype}{list(left.shape)}", f"{right.dtype}{list(right.shape)}")
    if left.dtype == object:
        pairs = ((index, left[index], right[index]) for index in np.ndindex(left.shape))
        return _first(difference(one, other, f"{path}{_index(index)}") for index, one, other in pairs)
    one, other = np.ascontiguousarray(left), np.ascontiguousarray(right)
    if one.tobytes() == other.tobytes():
        return None
    cells = one.reshape(left.size, -1).view(np.uint8) != other.reshape(left.size, -1).view(np.uint8)
    at = np.unravel_index(int(np.flatnonzero(cells.any(axis=1))[0]), left.shape)
    return Difference(f"{path}{_index(at)}", _shown(left[at]), _shown(right[at]))


def _index(index: tuple[Any, ...]) -> str:
    return f"[{', '.join(str(int(part)) for part in index)}]" if index else ""


def _equal(left: Any, right: Any) -> bool:
    try:
        return bool(left == right)
    except Exception:
        # What cannot be compared (an array-like with an equality of its own) is told apart by its text.
        return repr(left) == repr(right)


def _shown(value: Any) -> str:
    text = str(value) if isinstance(value, np.generic) else repr(value)
    return text if len(text) <= 120 else f"{text[:117]}..."
