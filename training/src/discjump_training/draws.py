"""Random numbers that belong to an episode, whoever else is played beside it."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Decisions drawn at once.
BLOCK = 64


class RowDraws:
    """For each row of a course a stream of its own, from (seed, row) alone: an evaluation gives the same
    result in one piece or in many.

    Args:
        seed: of all streams.
        draw: makes the next numbers of one row, (count, width), from its generator and `count`.
    """

    def __init__(self, seed: int, draw: Callable[[np.random.Generator, int], NDArray[Any]]) -> None:
        self._seed = seed
        self._draw = draw
        self._rows = range(0)
        self.restart()

    def begin(self, rows: range) -> None:
        """The next numbers are those of these rows, from the beginning."""
        self._rows = rows
        self.restart()

    def restart(self) -> None:
        """From the beginning."""
        self._generators = [np.random.default_rng([self._seed, row]) for row in self._rows]
        self._block: NDArray[Any] = np.zeros((len(self._rows), 0, 0))
        self._used = 0

    def next(self, count: int) -> NDArray[Any]:
        """The next numbers of all rows, (count, width); rows that nobody named are 0 to count - 1."""
        if len(self._rows) != count:
            self.begin(range(count))
        if self._used == self._block.shape[1]:
            self._block = np.stack([self._draw(generator, BLOCK) for generator in self._generators])
            self._used = 0
        self._used += 1
        numbers: NDArray[Any] = self._block[:, self._used - 1]
        return numbers
