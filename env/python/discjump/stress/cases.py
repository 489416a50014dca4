"""What is played: columns (tier, precision, surface) and cases (ground, starts, keys, explosions)."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import INPUT, Physics
from discjump.stress.rules import Floats, Rows

TIERS = ("reference", "authentic", "swept", "fast", "engine", "anyway")
PRECISIONS = ("float32", "float64")
SURFACES = ("triangles", "bilinear")


@dataclass(frozen=True)
class Column:
    """One way of computing."""

    tier: str
    precision: str
    surface: str

    def __str__(self) -> str:
        return f"{self.tier}/{self.precision}/{self.surface}"

    @property
    def eps(self) -> float:
        """Relative rounding of its arithmetic."""
        return float(np.finfo(self.precision).eps)

    @property
    def real(self) -> np.dtype[np.floating]:
        """The dtype of its numbers."""
        return np.dtype(self.precision)


def columns(
    tiers: tuple[str, ...] = TIERS,
    precisions: tuple[str, ...] = PRECISIONS,
    surfaces: tuple[str, ...] = SURFACES,
) -> list[Column]:
    """All there are of these; `reference` has float64 alone.

    >>> [str(column) for column in columns(("reference",), surfaces=("triangles",))]
    ['reference/float64/triangles']
    """
    return [
        Column(tier, precision, surface)
        for tier in tiers
        for precision in precisions
        for surface in surfaces
        if (tier, precision) != ("reference", "float32")
    ]


@dataclass(frozen=True)
class Setting:
    """What is uniform over a case, beside the column."""

    scene: str = "sandbox"
    armor: str = "light"
    energy_pack: bool = False
    tick_ms: int = 32
    physics: Physics = field(default_factory=Physics)
    players_per_world: int = 1


@dataclass(frozen=True)
class Start:
    """Where n players begin, and what they press: the same in every column of a surface."""

    #: (n, 3), m and m/s.
    position: Floats
    velocity: Floats
    #: (ticks, n), dtype `INPUT`.
    inputs: Rows
    #: Other fields of the state by name, (n,) or (n, 3).
    fields: dict[str, Floats] = field(default_factory=dict)
    #: Points (n, 3) of explosions by the tick before which they go off, m; NaN: none.
    blasts: dict[int, Floats] = field(default_factory=dict)
    #: Whether some begin under the ground on purpose: then nobody is asked to be above it.
    buried: bool = False

    def take(self, players: slice | NDArray[np.int64]) -> "Start":
        """Some of the players, in this order."""
        return Start(
            self.position[players],
            self.velocity[players],
            self.inputs[:, players],
            {name: values[players] for name, values in self.fields.items()},
            {tick: points[players] for tick, points in self.blasts.items()},
            self.buried,
        )


@dataclass(frozen=True)
class Case:
    """A ground with its players. `begin` is given the terrain with the column's surface, and the column."""

    extreme: str
    name: str
    ground: Callable[[], Terrain]
    begin: Callable[[Terrain, Column], Start]
    setting: Setting = field(default_factory=Setting)
    #: Whether the same start whole tiles away must give the same bits.
    far: tuple[int, int] | None = None
    #: Whether it takes so long that it is not repeated in a crowd.
    heavy: bool = False

    @property
    def label(self) -> str:
        """Its name in a report."""
        return f"{self.extreme}/{self.name}"


def no_keys(ticks: int, players: int) -> Rows:
    """Nothing pressed, (ticks, players)."""
    return np.zeros((ticks, players), INPUT)
