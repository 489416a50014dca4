"""What can be verified: a subject makes batches, and says what its environments are told to do."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from discjump.verify.parts import Column, Part

DISABLED, NEXT_STEP, SAME_STEP = "Disabled", "NextStep", "SameStep"
"""Autoreset modes, by gymnasium's values."""


class Batch(Protocol):
    """Some environments of a subject."""

    def reset(self, seeds: Sequence[int | None] | None, mask: Any = None) -> list[Part]:
        """Begin episodes: of all environments, or of those in the mask, (num,) bool."""
        ...

    def step(self, actions: Column) -> list[Part]:
        """One decision of every environment, (num, ...): one part, and one more where episodes began."""
        ...

    def snapshot(self) -> bytes:
        """Everything, for `restore`."""
        ...

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot."""
        ...


class Movable(Batch, Protocol):
    """A batch whose environments move to other batches one by one."""

    def moved(self, index: int) -> bytes:
        """One environment, for `settle`."""
        ...

    def settle(self, snapshot: bytes, index: int) -> None:
        """Put one environment to where another was."""
        ...


class Subject(Protocol):
    """An environment id or a scene, in one fidelity tier. It pickles: other processes play it too."""

    @property
    def name(self) -> str:
        """The id, or the scene."""
        ...

    @property
    def tier(self) -> str:
        """The fidelity tier."""
        ...

    @property
    def modes(self) -> tuple[str, ...]:
        """Autoreset modes; of these the first is the reference's. A subject without episodes has one."""
        ...

    @property
    def steps(self) -> int | None:
        """Rows to play; None where episodes end by themselves."""
        ...

    @property
    def digested(self) -> int:
        """Environments whose digests make up the subject's: as many as the quick form has."""
        ...

    def batch(self, num: int, *, threads: int, lanes: int, mode: str) -> Batch:
        """So many environments."""
        ...

    def widths(self) -> list[int]:
        """Lane widths that change how this subject is computed here, 1 first."""
        ...

    def ways(self) -> Sequence[str]:
        """Names of the other ways in; those that are not installed are told by `way`."""
        ...

    def way(self, name: str, num: int) -> Batch:
        """A batch by another way in.

        Raises:
            ImportError: it needs a package that is not installed.
        """
        ...

    def action(self, seed: int, decision: int, columns: Mapping[str, Column]) -> Any:
        """What the environment with this seed is told, given its last row (empty before its first)."""
        ...

    def describe(self, leaf: str) -> str:
        """What a number is, by its name in a column: "" where the name says all."""
        ...
