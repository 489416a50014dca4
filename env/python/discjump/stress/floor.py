"""The ground as its users ask for it, at any distance, and what lies under a straight way over it."""

import numpy as np

from discjump._native import Terrain
from discjump.stress.rules import Floats

FARTHEST = 9e8
"""Beyond this a map that does not tile is the same for ever, m."""
MOST_LINES = 512
"""Ways that cross more grid lines are looked at in as many even steps, four to a line."""


class Floor:
    """Heights and normals of a terrain.

    >>> import discjump
    >>> level = discjump.Terrain.from_heights(np.full((3, 3), 2.0))
    >>> Floor(level).depth(np.array([[1e12, 3.0, 1.5]]))
    array([0.5])
    """

    def __init__(self, terrain: Terrain) -> None:
        self.terrain = terrain
        self.square = terrain.square_size
        heights = terrain.heights
        self.highest, self.lowest = float(heights.max()), float(heights.min())
        self._origin, self._size = np.array(terrain.origin), np.array(terrain.size)

    def within(self, xy: Floats) -> Floats:
        """The same places where the terrain can be asked."""
        if self.terrain.edge == "tile":
            inside: Floats = xy - np.floor((xy - self._origin) / self._size) * self._size
            return inside
        return np.clip(xy, -FARTHEST, FARTHEST)

    def height(self, xy: Floats) -> Floats:
        """(n,), m; NaN where there is no ground."""
        return self.terrain.height(self.within(xy))

    def up(self, xy: Floats) -> Floats:
        """n.up of the ground, (n,)."""
        return self.terrain.normal(self.within(xy))[:, 2]

    def depth(self, position: Floats) -> Floats:
        """How far below the ground, along its normal, (n,), m; NaN where there is none.

        The distance to the face, that is: at a wall a hair inside is metres below its top.
        """
        xy = np.ascontiguousarray(position[:, :2])
        return (self.height(xy) - position[:, 2]) * self.up(xy)

    def deepest(self, start: Floats, end: Floats) -> Floats:
        """The greatest depth under straight ways, (n,), m, looked for where they cross squares and cuts."""
        found = np.full(len(start), -np.inf)
        way = end - start
        lines = np.ceil(np.abs(way[:, :2]).sum(axis=1) / self.square).astype(np.int64) + 2
        # Those that stay above every vertex meet nothing.
        low = np.minimum(start[:, 2], end[:, 2]) <= self.highest
        for most in (4, 32, MOST_LINES, np.iinfo(np.int64).max):
            here = low & (lines <= most)
            low &= ~here
            if here.any():
                found[here] = self._along(start[here], way[here], int(min(lines[here].max(), MOST_LINES)))
        return found

    def _along(self, start: Floats, way: Floats, lines: int) -> Floats:
        shares = np.concatenate(
            [
                *(self._crossings(start, way, across, lines) for across in ((1, 0), (0, 1), (1, 1), (1, -1))),
                np.broadcast_to(np.linspace(0.0, 1.0, 4 * lines), (len(start), 4 * lines)),
            ],
            axis=1,
        )
        points = start[:, None] + shares[..., None] * way[:, None]
        depth: Floats = np.nan_to_num(self.depth(points.reshape(-1, 3)), nan=-np.inf).reshape(shares.shape)
        deepest: Floats = depth.max(axis=1)
        return deepest

    def _crossings(self, start: Floats, way: Floats, across: tuple[int, int], lines: int) -> Floats:
        """Shares of ways at which they cross x, y, x + y or x - y = whole squares, (n, lines)."""
        at = ((start[:, :2] - self._origin) @ np.array(across)) / self.square
        step = (way[:, :2] @ np.array(across)) / self.square
        forward = step >= 0.0
        first = np.where(forward, np.floor(at) + 1.0, np.ceil(at) - 1.0)
        line = first[:, None] + np.where(forward, 1.0, -1.0)[:, None] * np.arange(lines)
        safe = np.where(step == 0.0, 1.0, step)
        shares: Floats = np.clip((line - at[:, None]) / safe[:, None], 0.0, 1.0)
        return shares


def rounding(floor: Floor, position: Floats, way: Floats, eps: float, origin: Floats) -> Floats:
    """How far the arithmetic alone may carry a place through a face, (n,), m.

    A rounding of a local coordinate, and of a sweep's length, along the normal: steep faces feel the
    horizontal ones.
    """
    local = floor.within(np.ascontiguousarray(position[:, :2])) - origin
    up = np.nan_to_num(floor.up(np.ascontiguousarray(position[:, :2])), nan=1.0)
    beside = np.sqrt(np.maximum(0.0, 1.0 - up * up))
    sizes = np.linalg.norm(local, axis=1) * beside + np.abs(position[:, 2]) * up
    found: Floats = 8.0 * eps * (sizes + way)
    return found
