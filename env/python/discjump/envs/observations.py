"""Observations with the names of their fields."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from discjump import _check


class ObservationField(NamedTuple):
    """One field of the flat observation."""

    name: str
    slice: slice
    unit: str
    scale: float
    """Value in `unit` = observation * scale. A field that is not linear has unit "" and scale 1."""


@dataclass(frozen=True, slots=True)
class Observations:
    """A task's own observations of many environments, for functions that make others of them.

    Attributes:
        array: (rows, size) float32, read-only.
        fields: by name; `observation_layout` of an environment.

    >>> fields = {"speed": ObservationField("speed", slice(0, 1), "m/s", 20.0)}
    >>> seen = Observations(np.array([[0.5], [1.0]], np.float32), fields)
    >>> seen["speed"]
    array([10., 20.], dtype=float32)
    >>> seen["sped"]
    Traceback (most recent call last):
    KeyError: "expected one of 'speed', got 'sped'; did you mean 'speed'?"
    """

    array: NDArray[np.float32]
    fields: Mapping[str, ObservationField]

    def __len__(self) -> int:
        """Rows."""
        return len(self.array)

    def __getitem__(self, name: str) -> NDArray[np.float32]:
        """A field in its unit, float32: (rows,) if it is one number, else (rows, numbers)."""
        field = self.fields.get(name)
        if field is None:
            known = ", ".join(map(repr, self.fields))
            raise KeyError(f"expected one of {known}, got {name!r}{_check.nearest(str(name), self.fields)}")
        first, stop = field.slice.start, field.slice.stop
        values = self.array[:, first] if stop == first + 1 else self.array[:, first:stop]
        scaled: NDArray[np.float32] = values * np.float32(field.scale)
        return scaled
