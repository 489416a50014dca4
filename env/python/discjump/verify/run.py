"""A batch followed along the reference, until the first bit that differs."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.verify.interface import Batch, Subject
from discjump.verify.parts import INFO, Column, Part, differing, leaves, ulps
from discjump.verify.reference import Reference

Unlike = tuple[str, Any, Any]
"""A number's name, what came and what was expected; words where it is no number."""


@dataclass(frozen=True)
class Difference:
    """The first number that differs."""

    where: str
    """What was played."""
    seed: int
    """Of the environment."""
    index: int
    """Of the environment in the batch."""
    row: int
    """0 is the first observation, each decision and each new episode is one more."""
    episode: int
    decision: int
    """Of that episode; 0 is its first observation."""
    field: str
    """The number's name."""
    meaning: str
    got: str
    expected: str
    ulps: int | None
    """Floating-point numbers from one to the other."""
    others: int
    """Further numbers that differ in this row."""

    def __str__(self) -> str:
        name = f"{self.field} ({self.meaning})" if self.meaning else self.field
        apart = "" if self.ulps is None else f", {self.ulps} ULP apart"
        more = f"; {self.others} more numbers differ there" if self.others else ""
        return (
            f"{self.where}: environment with seed {self.seed}, at index {self.index}, "
            f"episode {self.episode}, decision {self.decision}: "
            f"{name} is {self.got}, expected {self.expected}{apart}{more}"
        )

    def record(self) -> dict[str, Any]:
        """As JSON."""
        return {**asdict(self), "text": str(self)}


class Run:
    """A batch whose environments follow rows of the reference.

    Args:
        subject: what is played.
        reference: of the subject.
        batch: a batch of it.
        environments: (num,), which environment of the reference each is.
        where: words that say what is played.
        rows: (num,), the rows where they are; None: before the first.
    """

    def __init__(
        self,
        subject: Subject,
        reference: Reference,
        batch: Batch,
        environments: NDArray[np.int64],
        where: str,
        rows: NDArray[np.int64] | None = None,
    ) -> None:
        self.subject, self.reference, self.batch, self.where = subject, reference, batch, where
        self.environments = environments
        self.rows = np.full(len(environments), -1) if rows is None else rows.copy()
        names = reference.table.dtype.names or ()
        self.always = frozenset(name for name in names if not name.startswith(INFO))
        self.difference: Difference | None = None
        self.compared = 0

    @property
    def seeds(self) -> list[int]:
        """Of the environments."""
        return [int(seed) for seed in self.reference.seeds[self.environments]]

    def start(self) -> "Run":
        """Begin the first episodes."""
        self.take(self.batch.reset(self.seeds))
        return self

    def again(self, mask: NDArray[np.bool_], seeds: Sequence[int | None] | None = None) -> None:
        """Begin the first episodes of some again."""
        self.rows[mask] = -1
        self.take(self.batch.reset(self.seeds if seeds is None else seeds, mask))

    def advance(self, decisions: int | None = None) -> "Run":
        """Play so many decisions, or to the reference's end; stops at the first difference."""
        last = self.reference.length - 1
        while self.difference is None and self.rows.min() < last and decisions != 0:
            following = np.minimum(self.rows + 1, last)
            self.take(self.batch.step(self.reference.actions[self.environments, following]))
            decisions = None if decisions is None else decisions - 1
        return self

    def take(self, parts: list[Part]) -> None:
        """Compare what a batch showed with the next rows."""
        for part in parts:
            self.rows[part.indices] += 1
            if self.difference is None:
                self._compare(part)

    def _compare(self, part: Part) -> None:
        rows, environments = self.rows[part.indices], self.environments[part.indices]
        known = rows < self.reference.length
        if not known.any():
            return
        if not known.all():
            chosen = np.flatnonzero(known)
            columns = {name: column[chosen] for name, column in part.columns.items()}
            part = part._replace(indices=part.indices[chosen], columns=columns)
            rows, environments = rows[chosen], environments[chosen]
        self.compared += len(rows)
        expected = self.reference.at(environments, rows)
        got, wrong = self._shown(part, expected)
        if not wrong and got.tobytes() == expected.tobytes():
            return
        unlike = np.ones(len(rows), np.bool_) if wrong else differing(got, expected)
        if unlike.any():
            at = int(np.flatnonzero(unlike)[0])
            numbers = wrong or _numbers(got[at], expected[at])
            self.difference = self._found(
                int(part.indices[at]), int(environments[at]), int(rows[at]), numbers
            )

    def _shown(self, part: Part, expected: NDArray[np.void]) -> tuple[NDArray[np.void], list[Unlike]]:
        """What a part shows, in the layout of the reference; and columns that do not fit into it."""
        got = np.zeros(expected.shape, expected.dtype)
        wrong: list[Unlike] = []
        fields = expected.dtype.fields
        assert fields is not None
        for name, column in part.columns.items():
            field = fields.get(name)
            if field is None:
                wrong.append((name, _kind(column), "absent"))
                continue
            base, shape = field[0].base, field[0].shape
            if name in part.narrow and column.dtype == np.float32:
                # What rounds to it is taken for it.
                wide = expected[name]
                column = np.where(wide.astype(np.float32) == column, wide, column)
            if column.dtype != base or column.shape[1:] != shape:
                wrong.append((name, _kind(column), f"{base} of shape {shape}"))
                continue
            got[name] = column
        for name in self.always - part.columns.keys() - part.hidden:
            wrong.append((name, "absent", str(fields[name][0])))
        if part.hidden:
            for name in fields.keys() - part.columns.keys():
                if name in part.hidden or (name.startswith(INFO) and "info" in part.hidden):
                    got[name] = expected[name]
        return got, sorted(wrong)

    def _found(self, index: int, environment: int, row: int, numbers: list[Unlike]) -> Difference:
        """What differs in one row."""
        field, value, wanted = numbers[0]
        begun = np.flatnonzero(self.reference.begun[environment, : row + 1])
        return Difference(
            self.where,
            int(self.reference.seeds[environment]),
            index,
            row,
            len(begun) - 1,
            row - int(begun[-1]),
            field,
            self.subject.describe(field),
            _written(value),
            _written(wanted),
            None if isinstance(value, str) else ulps(value, wanted),
            len(numbers) - 1,
        )


def _numbers(got: np.void, expected: np.void) -> list[Unlike]:
    """The numbers that differ in two rows of one layout, observations and states first."""
    found = []
    for name in sorted(got.dtype.names or (), key=lambda name: (name.startswith(INFO), name)):
        for (leaf, value), (_, wanted) in zip(
            leaves(name, got[name]), leaves(name, expected[name]), strict=True
        ):
            if np.asarray(value).tobytes() != np.asarray(wanted).tobytes():
                found.append((leaf, value, wanted))
    return found


def _kind(column: Column) -> str:
    return f"{column.dtype} of shape {column.shape[1:]}"


def _written(value: Any) -> str:
    """A number to the last digit, and its bits where it is a floating-point one."""
    if isinstance(value, str):
        return value
    number = np.asarray(value)
    if number.dtype.kind != "f":
        return str(number[()])
    bits = int(number.view(f"u{number.dtype.itemsize}"))
    return f"{number[()]} (0x{bits:0{2 * number.dtype.itemsize}x})"
