"""Short digests: 8 bytes of BLAKE2b over named values.

Eight bytes keep a replay small. They tell two runs apart that came apart by accident, all but once in 2^64;
who forges one on purpose could rewrite the whole file as well.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

BYTES = 8


class Digest:
    """A digest under way."""

    def __init__(self) -> None:
        self._hash = hashlib.blake2b(digest_size=BYTES)

    def state(self, state: Any, fields: Sequence[str]) -> None:
        """Add the fields of a structured state, one after the other: a field that a later release adds is not
        among them."""
        for name in fields:
            self._hash.update(np.ascontiguousarray(state[name]).tobytes())

    def numbers(self, values: Iterable[Any]) -> None:
        """Add numbers and arrays of them, each in its own dtype; Python's floats are float64."""
        for value in values:
            self._hash.update(np.ascontiguousarray(value).tobytes())

    def info(self, info: Mapping[str, Any], keys: Sequence[str]) -> None:
        """Add the entries of an info."""
        self.numbers(info[key] for key in keys)

    def done(self) -> NDArray[np.uint8]:
        """The digest so far, (8,)."""
        return np.frombuffer(self._hash.digest(), np.uint8)
