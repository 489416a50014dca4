"""Batches of spaces that numpy has no arrays for.

`gymnasium.vector.utils` batches Text, Sequence, Graph and OneOf to a tuple with one item for each
environment, which looks like the batch of a Tuple space. Here it is an array of dtype object instead.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from gymnasium import Space, spaces

ARRAYS = (spaces.Box, spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)


def to_rows(single: Space[Any], batch: Any) -> Any:
    """`batch` with arrays of dtype object in place of tuples of items.

    >>> to_rows(spaces.Text(3), ("a", "bc"))
    array(['a', 'bc'], dtype=object)
    """
    return _mapped(single, batch, _objects)


def from_rows(single: Space[Any], batch: Any) -> Any:
    """The inverse of `to_rows`."""
    return _mapped(single, batch, lambda items: tuple(items) if isinstance(items, np.ndarray) else items)


def _objects(items: Any) -> Any:
    if not isinstance(items, tuple):
        return items
    array = np.empty(len(items), object)
    for index, item in enumerate(items):
        array[index] = item
    return array


def _mapped(single: Space[Any], batch: Any, leaf: Callable[[Any], Any]) -> Any:
    # What has another structure than its space stays as it is, for checks to say so.
    if isinstance(single, spaces.Dict):
        if not isinstance(batch, dict) or batch.keys() != single.keys():
            return batch
        return {key: _mapped(single[key], value, leaf) for key, value in batch.items()}
    if isinstance(single, spaces.Tuple):
        if not isinstance(batch, tuple) or len(batch) != len(single):
            return batch
        return tuple(_mapped(one, value, leaf) for one, value in zip(single, batch, strict=True))
    return batch if isinstance(single, ARRAYS) else leaf(batch)
