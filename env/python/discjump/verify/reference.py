"""The reference: every environment alone, one player at a time, on one thread: all else must give it."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.verify.interface import Subject
from discjump.verify.parts import Column, Part, canonical

AFTER = 10
"""Decisions after the first episode's end that are compared as well, so that the next one is."""
FLAGS = ("terminated", "truncated")
MOST = 20_000
"""Decisions within which an episode must end."""


@dataclass(frozen=True)
class Reference:
    """What happened to S environments, from their first observation on; L rows each."""

    seeds: NDArray[np.int64]
    """(S,)."""
    actions: Column
    """(S, L, ...): what led to a row; where an episode begins, an action that must be ignored."""
    begun: NDArray[np.bool_]
    """(S, L): the first observation of an episode."""
    table: NDArray[np.void]
    """(S, L): a field per column."""
    lengths: NDArray[np.int64]
    """(S,): rows until `AFTER` decisions into the second episode."""
    digested: int
    """Environments whose digests make up the subject's."""
    ends: Mapping[str, int]
    """How many rows ended an episode: terminated and truncated."""

    @property
    def length(self) -> int:
        """Rows of every environment."""
        return int(self.actions.shape[1])

    def at(self, environments: NDArray[np.int64], rows: NDArray[np.int64]) -> NDArray[np.void]:
        """(k,): one row of each of k environments."""
        # As bytes: numpy takes structured rows field by field, fifteen times slower.
        bytes_of = self.table.reshape(-1, 1).view(np.uint8)
        taken = np.take(bytes_of, environments * self.length + rows, axis=0)
        return taken.view(self.table.dtype).reshape(-1)

    def digest(self) -> str:
        """SHA-256 of all that the first `digested` environments showed."""
        return _whole(self.environment_digest(i) for i in range(self.digested))

    def actions_digest(self) -> str:
        """SHA-256 of what they were told to do."""
        return _whole(self.told_digest(i) for i in range(self.digested))

    def environment_digest(self, environment: int) -> str:
        """SHA-256 of one environment's rows, column by column."""
        digest = hashlib.sha256()
        rows = self.table[environment, : self.lengths[environment]]
        for name in sorted(rows.dtype.names or ()):
            column = rows[name]
            digest.update(f"{name} {column.dtype.newbyteorder('<').descr} {column.shape[1:]}\n".encode())
            for block in canonical(column):
                digest.update(block)
        return digest.hexdigest()

    def told_digest(self, environment: int) -> str:
        """SHA-256 of one environment's actions."""
        digest = hashlib.sha256()
        for block in canonical(self.actions[environment, : self.lengths[environment]]):
            digest.update(block)
        return digest.hexdigest()


def _whole(digests: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(digests).encode()).hexdigest()


def record(subject: Subject, seeds: NDArray[np.int64]) -> Reference:
    """Play the reference of a subject.

    Raises:
        RuntimeError: an episode does not end.
    """
    played = [_Played(subject, int(seed)) for seed in seeds]
    length = max(one.until_end() for one in played)
    lengths = np.array([len(one.rows) for one in played])
    for one in played:
        one.until(length)
    table = _table([one.rows for one in played])
    return Reference(
        np.asarray(seeds),
        np.array([one.actions for one in played]),
        np.array([one.begun for one in played]),
        table,
        lengths,
        min(subject.digested, len(seeds)),
        {flag: int(table[flag].sum()) for flag in FLAGS if flag in (table.dtype.names or ())},
    )


class _Played:
    """One environment in a batch of its own."""

    def __init__(self, subject: Subject, seed: int) -> None:
        self.subject, self.seed = subject, seed
        self.batch = subject.batch(1, threads=1, lanes=1, mode=subject.modes[0])
        self.rows: list[Part] = []
        self.actions: list[Any] = []
        self.begun: list[bool] = []
        self._put(self.batch.reset([seed]), subject.action(seed, 0, {}))

    def until_end(self) -> int:
        """Play until `AFTER` decisions into the second episode, or the subject's steps where it has none."""
        if self.subject.steps is not None:
            self.until(self.subject.steps)
            return len(self.rows)
        while not self._step():
            if len(self.rows) > MOST:
                raise RuntimeError(f"{self.subject.name}: no episode ended within {MOST} decisions")
        self.until(len(self.rows) + AFTER)
        return len(self.rows)

    def until(self, length: int) -> None:
        """Go on to so many rows."""
        while len(self.rows) < length:
            self._step()
        del self.rows[length:], self.actions[length:], self.begun[length:]

    def _step(self) -> bool:
        """One decision; whether it ended an episode."""
        action = self.subject.action(self.seed, len(self.rows), self.rows[-1].columns)
        parts = self.batch.step(np.asarray([action]))
        self._put(parts, action)
        return len(parts) > 1

    def _put(self, parts: list[Part], action: Any) -> None:
        # A reset by hand follows the step that ended an episode.
        for place, part in enumerate(parts):
            self.begun.append(place > 0 or not self.rows)
            self.rows.append(part)
            self.actions.append(action)


def _table(played: list[list[Part]]) -> NDArray[np.void]:
    """(S, L), a field per column; what an info does not give in a row is zero there."""
    known: dict[str, tuple[Any, tuple[int, ...]]] = {}
    for parts in played:
        for part in parts:
            if not part.columns.keys() <= known.keys():
                known |= {name: (column.dtype, column.shape[1:]) for name, column in part.columns.items()}
    dtype = np.dtype([(name, *kind) for name, kind in sorted(known.items())])
    table = np.zeros((len(played), len(played[0])), dtype)
    for environment, parts in enumerate(played):
        for row, part in enumerate(parts):
            for name, column in part.columns.items():
                table[name][environment, row] = column[0]
    return table
