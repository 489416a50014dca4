"""The ground of core/docs/physics.md, sections 5 and 8, in plain float64 Python: the Rust's witness."""

import itertools
import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

import discjump

Vec = tuple[float, float, float]

#: m. A path inside a cut is a tie (upper triangle), which the rounding of local coordinates must not break.
TIE = 1e-11


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def along(p: Vec, d: Vec, t: float) -> Vec:
    """p + t d."""
    return (p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2])


class Plane:
    """Of one triangle: through `point`, with slopes dz/dx and dz/dy."""

    def __init__(self, point: Vec, slope_x: float, slope_y: float) -> None:
        self.point = point
        self.slopes: tuple[float, float] = (slope_x, slope_y)
        length = math.sqrt(slope_x * slope_x + slope_y * slope_y + 1.0)
        self.normal: Vec = (-slope_x / length, -slope_y / length, 1.0 / length)

    def height(self, x: float, y: float) -> float:
        return self.point[2] + self.slopes[0] * (x - self.point[0]) + self.slopes[1] * (y - self.point[1])

    def distance(self, p: Vec) -> float:
        """Signed, positive above."""
        return (p[2] - self.height(p[0], p[1])) * self.normal[2]


@dataclass(frozen=True)
class Hit:
    fraction: float
    """Of the path that was swept."""
    normal: Vec


class Surface(ABC):
    """What a path can meet."""

    @abstractmethod
    def pieces(self, p: Vec, d: Vec) -> list[tuple[float, float, Plane]]:
        """The path p to p + d as (start, end, triangle), in order."""

    @abstractmethod
    def plane_at(self, x: float, y: float) -> Plane:
        """Of the triangle above and below (x, y)."""

    def sweep(self, p: Vec, d: Vec) -> Hit | None:
        """The first triangle that the path p to p + d hits from above (section 5)."""
        for start, end, plane in self.pieces(p, d):
            if dot(d, plane.normal) >= 0.0:
                continue
            s0, s1 = plane.distance(along(p, d, start)), plane.distance(along(p, d, end))
            if s0 <= 0.0:
                return Hit(start, plane.normal)
            if s1 < 0.0:
                return Hit(start + (end - start) * s0 / (s0 - s1), plane.normal)
        return None

    def crossing(self, p: Vec, d: Vec) -> Hit | None:
        """The first passage from either side; on the surface counts as below (section 8).

        The side is carried from piece to piece: rounding at an edge cannot let a path slip through."""
        above: bool | None = None
        for start, end, plane in self.pieces(p, d):
            s0, s1 = plane.distance(along(p, d, start)), plane.distance(along(p, d, end))
            if above is None:
                above = s0 > 0.0
            if (s0 > 0.0) != above:
                return Hit(start, plane.normal)
            if (s1 > 0.0) != above:
                return Hit(start + (end - start) * s0 / (s0 - s1), plane.normal)
        return None


class Incline(Surface):
    """One plane without an end, through the origin: falls by `degrees` towards `bearing` (0 is +y)."""

    def __init__(self, degrees: float, bearing: float = 0.0) -> None:
        slope = math.tan(math.radians(degrees))
        self.plane = Plane((0.0, 0.0, 0.0), slope * math.sin(bearing), -slope * math.cos(bearing))

    def pieces(self, p: Vec, d: Vec) -> list[tuple[float, float, Plane]]:
        return [(0.0, 1.0, self.plane)]

    def plane_at(self, x: float, y: float) -> Plane:
        return self.plane


class Ground(Surface):
    """Squares cut in a checkerboard; beyond the rim the map again (tile) or the rim's heights (clamp)."""

    def __init__(self, terrain: discjump.Terrain) -> None:
        heights = np.asarray(terrain.heights)
        self.rows: int = heights.shape[0]
        self.columns: int = heights.shape[1]
        self.heights: list[list[float]] = heights.tolist()
        self.side = terrain.square_size
        self.origin = terrain.origin
        self.tile = {"tile": True, "clamp": False}[terrain.edge]
        self.planes: dict[tuple[int, int, bool], Plane] = {}

    def vertex(self, i: int, j: int) -> float:
        if self.tile:
            return self.heights[j % (self.rows - 1)][i % (self.columns - 1)]
        return self.heights[min(max(j, 0), self.rows - 1)][min(max(i, 0), self.columns - 1)]

    def square(self, x: float, y: float) -> tuple[int, int]:
        return math.floor((x - self.origin[0]) / self.side), math.floor((y - self.origin[1]) / self.side)

    def rising(self, i: int, j: int) -> bool:
        """Whether the cut runs from the low corner to the high one ("45")."""
        if self.tile:
            i, j = i % (self.columns - 1), j % (self.rows - 1)
        return (i + j) % 2 == 0

    def below_cut(self, i: int, j: int, x: float, y: float) -> float:
        """Positive in the lower triangle of square (i, j), else in the upper; 0 on the cut."""
        a = x - self.origin[0] - i * self.side
        b = y - self.origin[1] - j * self.side
        return a - b if self.rising(i, j) else self.side - a - b

    def plane(self, i: int, j: int, lower: bool) -> Plane:
        key = (i, j, lower)
        if key not in self.planes:
            self.planes[key] = self.make_plane(i, j, lower)
        return self.planes[key]

    def make_plane(self, i: int, j: int, lower: bool) -> Plane:
        low, east = self.vertex(i, j), self.vertex(i + 1, j)
        north, high = self.vertex(i, j + 1), self.vertex(i + 1, j + 1)
        x, y = self.origin[0] + i * self.side, self.origin[1] + j * self.side
        s = self.side
        if self.rising(i, j):
            if lower:
                return Plane((x, y, low), (east - low) / s, (high - east) / s)
            return Plane((x, y, low), (high - north) / s, (north - low) / s)
        if lower:
            return Plane((x, y, low), (east - low) / s, (north - low) / s)
        return Plane((x + s, y + s, high), (high - north) / s, (high - east) / s)

    def plane_at(self, x: float, y: float) -> Plane:
        i, j = self.square(x, y)
        return self.plane(i, j, self.below_cut(i, j, x, y) > TIE)

    def pieces(self, p: Vec, d: Vec) -> list[tuple[float, float, Plane]]:
        times = {0.0, 1.0}
        for axis in (0, 1):
            first = (p[axis] - self.origin[axis]) / self.side
            step = d[axis] / self.side
            if step != 0.0:
                ends = sorted((first, first + step))
                lines = range(math.ceil(ends[0]), math.floor(ends[1]) + 1)
                times.update(t for t in ((line - first) / step for line in lines) if 0.0 < t < 1.0)
        ordered = sorted(times)
        found = []
        for start, end in itertools.pairwise(ordered):
            middle = along(p, d, 0.5 * (start + end))
            i, j = self.square(middle[0], middle[1])
            at_start = self.below_cut(i, j, *along(p, d, start)[:2])
            at_end = self.below_cut(i, j, *along(p, d, end)[:2])
            parts = [(start, end)]
            if at_start * at_end < 0.0:
                cut = start + (end - start) * at_start / (at_start - at_end)
                if start < cut < end:
                    parts = [(start, cut), (cut, end)]
            for a, b in parts:
                inside = along(p, d, 0.5 * (a + b))
                lower = self.below_cut(i, j, inside[0], inside[1]) > TIE
                found.append((a, b, self.plane(i, j, lower)))
        return found
