"""What every tier is given alike: ground, starts, keys and explosions."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.accuracy.grounds import Floats
from discjump.accuracy.scripts import TICK_MS, Inputs, resampled

BROWSE = 64
"""Places looked at for each start that is wanted."""
NEAR = 0.25
"""How far above the ground players start who ski at once, m."""


@dataclass(frozen=True)
class Play:
    """One batch: all its players start at once, each in a world of its own."""

    #: What ground it is on.
    name: str
    terrain: Terrain
    #: Scene of the simulator.
    scene: str
    #: (n, 3), m, float32 numbers like all that follow.
    position: Floats
    #: (n, 3), m/s.
    velocity: Floats
    #: (n,), rad.
    yaw: Floats
    #: (ticks, n).
    inputs: Inputs
    #: Points of explosions (n, 3) by the tick before which they go off; NaN: none.
    blasts: dict[int, Floats] = field(default_factory=dict)
    #: Length of a tick, ms.
    tick_ms: int = TICK_MS

    def __post_init__(self) -> None:
        """Whatever float32 cannot hold would be an error of the start, not of the tier."""
        for name in ("position", "velocity", "yaw"):
            given = getattr(self, name)
            object.__setattr__(self, name, given.astype(np.float32).astype(np.float64))

    def on(self, terrain: Terrain) -> "Play":
        """The same play on other ground of nearly the same heights.

        Who would start in that ground, or nearer to it than to his own, is lifted to as far above it, `NEAR`
        at most. Explosions stay as far above the ground as they are.
        """
        xy = self.position[:, :2].copy()
        clearance = np.minimum(self.position[:, 2] - self.terrain.height(xy), NEAR)
        position = self.position.copy()
        position[:, 2] = np.maximum(position[:, 2], terrain.height(xy) + clearance)
        blasts = {}
        for tick, points in self.blasts.items():
            set_off = ~np.isnan(points).any(axis=1)
            below = points[set_off, :2].copy()
            moved = points.copy()
            moved[set_off, 2] += terrain.height(below) - self.terrain.height(below)
            blasts[tick] = moved
        return replace(self, terrain=terrain, position=position, blasts=blasts)

    def at(self, tick_ms: int) -> "Play":
        """The same play in ticks of another length; explosions that fall within a tick wait for its end.

        Raises:
            ValueError: a length that `scripts.resampled` refuses, or two explosions of one player that would
                fall together.
        """
        inputs = resampled(self.inputs, tick_ms)
        blasts: dict[int, Floats] = {}
        for tick, points in sorted(self.blasts.items()):
            begins = -(-tick * TICK_MS // tick_ms)
            others = blasts.get(begins, np.full_like(points, np.nan))
            if (~np.isnan(others) & ~np.isnan(points)).any():
                raise ValueError(
                    f"tick_ms: expected explosions of a player in different ticks, got {tick_ms}"
                )
            blasts[begins] = np.where(np.isnan(points), others, points)
        return replace(self, inputs=inputs, blasts=blasts, tick_ms=tick_ms)


@dataclass(frozen=True)
class Places:
    """Where to start on a terrain, and which way to look."""

    #: (n, 2), m.
    xy: Floats
    #: (n,), rad.
    yaw: Floats

    @property
    def ahead(self) -> Floats:
        """Unit vectors (n, 2) along the view."""
        return np.column_stack([-np.sin(self.yaw), np.cos(self.yaw)])

    def along(self, terrain: Terrain, speed: Floats) -> Floats:
        """Velocities (n, 3) of `speed` (n,) horizontally, along the view and the ground."""
        normal = terrain.normal(self.xy)
        climb = -(normal[:, :2] * self.ahead).sum(axis=1) / normal[:, 2]
        velocity: Floats = speed[:, None] * np.column_stack([self.ahead, climb])
        return velocity

    def above(self, terrain: Terrain, clearance: float | Floats = NEAR) -> Floats:
        """Positions (n, 3), `clearance` m above the ground."""
        return np.column_stack([self.xy, terrain.height(self.xy) + clearance])


def browse(
    rng: np.random.Generator,
    terrain: Terrain,
    count: int,
    wanted: Callable[[Places], NDArray[np.bool_]] | None = None,
    *,
    uphill: bool = False,
) -> Places:
    """The first `count` of places drawn all over the terrain that are `wanted`.

    They look downhill within 60 degrees, or uphill.

    Raises:
        ValueError: fewer than `count` of `BROWSE` times as many are.
    """
    drawn = count * BROWSE if wanted else count
    size, corner = np.array(terrain.size), np.array(terrain.origin)
    xy = (corner + size * rng.random((drawn, 2))).astype(np.float32).astype(np.float64)
    normal = terrain.normal(xy)
    down = np.arctan2(-normal[:, 0], normal[:, 1])
    yaw = down + (np.pi if uphill else 0.0) + rng.uniform(-np.pi / 3, np.pi / 3, drawn)
    places = Places(xy, yaw)
    if wanted is None:
        return places
    chosen = np.flatnonzero(wanted(places))[:count]
    if len(chosen) < count:
        raise ValueError(f"wanted: expected {count} places of {drawn}, got {len(chosen)}")
    return Places(xy[chosen], yaw[chosen])
