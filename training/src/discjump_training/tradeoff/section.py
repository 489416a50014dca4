"""What a section of the trade-off is, and what it gives to the picture."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from discjump_training.tradeoff.grid import Config, Plan
from discjump_training.tradeoff.store import Store

Made = dict[str, Any]
"""What a section measured, as JSON has it; its rows under `rows`."""
Done = Callable[[int], object]
"""Is told how many units of work were done."""


class Section(Protocol):
    """One kind of measurement over the grid."""

    @property
    def name(self) -> str:
        """On the command line, in the JSON and as folder of the pieces."""

    def work(self, plan: Plan) -> int:
        """Units of work in all, for the progress bar; those already in the store count as well."""

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Measure what the store lacks, piece by piece, and gather all.

        Raises:
            Missing: the store is frozen and lacks a piece. Nothing may be set up before that shows.
        """

    def tables(self, made: Made) -> list[str]:
        """Markdown lines of the section, its heading included."""

    def panels(self, made: Made, speeds: "Speeds") -> list["Panel"]:
        """What the picture shows of it."""


@dataclass(frozen=True)
class Speeds:
    """Seconds of one player's game that are simulated in a second: medians, with quartiles.

    Attributes:
        physics: a simulator on all cores.
        agents: a vector environment on all cores, a decision each `DECISION_MS`.
    """

    physics: dict[Config, tuple[float, float, float]]
    agents: dict[Config, tuple[float, float, float]]


@dataclass(frozen=True)
class Point:
    """A configuration in a panel."""

    config: Config
    #: Median and quartiles, game seconds a second.
    speed: tuple[float, float, float]
    #: At least 0.
    error: float


@dataclass(frozen=True)
class Panel:
    """Speed against one error."""

    title: str
    #: What the speed axis counts.
    speed: str
    #: What the error axis counts.
    error: str
    #: Of the error.
    unit: str
    points: list[Point]
    #: Errors that are no larger lie on the lower end of the axis.
    floor: float


def points(errors: dict[Config, float], speeds: dict[Config, tuple[float, float, float]]) -> list[Point]:
    """Those configurations that have both."""
    return [Point(config, speeds[config], error) for config, error in errors.items() if config in speeds]
