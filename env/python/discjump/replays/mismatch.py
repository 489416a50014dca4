"""Where a replay and its repetition part."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Mismatch:
    """The first difference that was found.

    Attributes:
        field: what differs: `state`, `output` (observations, rewards, flags, info), a field of the final
            state or of the outcome.
        first, last: the decisions (ticks in a simulator's replay) after one of which it appeared, counted
            from 1; both 0: it is there from the beginning.
        expected: what the replay says.
        got: what the repetition gives.
        unit: what is counted.
    """

    field: str
    first: int
    last: int
    expected: Any
    got: Any
    unit: str = "decision"

    def __str__(self) -> str:
        """In a line."""
        if self.last == 0:
            where = "at the beginning"
        elif self.first == self.last:
            where = f"after {self.unit} {self.last}"
        else:
            where = f"after one of the {self.unit}s {self.first} to {self.last}"
        return f"{self.field} differs {where}: expected {self.expected}, got {self.got}"
