"""Terrains of the extremes. Heights are float32 numbers, so that every precision stands on the same ground.

Asked with another surface, they have the same vertices.
"""

from functools import lru_cache

import numpy as np

from discjump._native import Terrain
from discjump.stress.rules import Floats

SQUARE = 8.0
"""Side of a square where nothing else is said, m."""
HIGHEST = 10_000.0
"""What a terrain allows, m."""


def made(heights: Floats, square: float = SQUARE, edge: str = "clamp") -> Terrain:
    """A terrain whose middle vertex is at the origin."""
    rows, columns = heights.shape
    corner = (-square * ((columns - 1) // 2), -square * ((rows - 1) // 2))
    return Terrain.from_heights(heights.astype(np.float32).astype(np.float64), square, corner, edge)


@lru_cache(maxsize=8)
def rolling(highest: float = 20.0, edge: str = "tile") -> Terrain:
    """Hills that tile with a period of 512 m, between 0 and `highest`."""
    angle = 2.0 * np.pi * np.arange(65) / 64.0
    x, y = np.meshgrid(angle, angle)
    shape = np.sin(2 * x) * np.sin(2 * y) + 0.4 * np.sin(5 * x + 1.0) + 0.3 * np.sin(7 * y)
    shape = (shape - shape.min()) / (shape.max() - shape.min())
    shape[-1], shape[:, -1] = shape[0], shape[:, 0]
    return made(highest * shape, edge=edge)


def slope(degrees: float) -> Terrain:
    """A plane that falls towards +x, as far as heights go; at its ends it levels out."""
    gradient = np.tan(np.radians(degrees))
    squares = 128
    square = SQUARE
    if gradient * squares * square > 2.0 * HIGHEST:
        square = max(0.25, 2.0 * HIGHEST / (gradient * squares))
    half = int(min(squares // 2, HIGHEST / (gradient * square) if gradient > 0.0 else squares))
    x = np.arange(-half, half + 1) * square
    return made(np.broadcast_to(-gradient * x, (9, len(x))), square)


def spikes(height: float, square: float = SQUARE) -> Terrain:
    """Flat ground with a needle on every fourth vertex either way; tiles."""
    heights = np.zeros((33, 33))
    heights[2::4, 2::4] = height
    return made(heights, square, "tile")


def crease(degrees: float, rows: int = 33) -> Terrain:
    """A valley along y with faces of so many degrees, lowest at x = 0; as wide as heights allow."""
    gradient = np.tan(np.radians(degrees))
    half = int(min(16, HIGHEST / (gradient * SQUARE)))
    x = np.abs(np.arange(-half, half + 1)) * SQUARE
    return made(np.broadcast_to(gradient * x, (rows, len(x))))


def pit(degrees: float) -> Terrain:
    """One deep vertex and a neighbour as deep across the cut: three faces to slide down."""
    depth = SQUARE * np.tan(np.radians(degrees))
    heights = np.full((9, 9), depth)
    heights[4, 4] = heights[4, 5] = 0.0
    return made(heights)


def cliffs(height: float) -> Terrain:
    """Plateaus and plains in turn along x, each three squares wide, with faces one square wide; tiles."""
    profile = np.where(np.arange(33) % 8 < 4, height, 0.0)
    profile[-1] = profile[0]
    return made(np.broadcast_to(profile, (33, 33)), edge="tile")


def plain(height: float = 0.0, edge: str = "clamp", square: float = 64.0) -> Terrain:
    """Level ground of eight squares either way."""
    return made(np.full((9, 9), height), square, edge)


def one_square(edge: str) -> Terrain:
    """Four vertices: a saddle, or on a tiling map, whose rims are the same, level ground."""
    corners = np.zeros((2, 2)) if edge == "tile" else np.array([[0.0, 6.0], [5.0, 0.0]])
    return made(corners, edge=edge)


@lru_cache(maxsize=1)
def huge(squares: int, rows: int) -> Terrain:
    """So many squares along x, `rows` along y, hills of 30 m; tiles."""
    x = 2.0 * np.pi * np.arange(squares + 1) / squares
    y = 2.0 * np.pi * np.arange(rows + 1) / rows
    heights = (
        15.0 * np.sin(0.5 * round(squares / 16) * 2 * x)[None, :] * np.cos(max(1, rows // 32) * y)[:, None]
    )
    heights[-1], heights[:, -1] = heights[0], heights[:, 0]
    return made(heights, edge="tile")


def rough(highest: float, seed: int = 0) -> Terrain:
    """Unconnected random heights up to `highest`; tiles."""
    heights = np.random.default_rng(seed).uniform(0.0, highest, (17, 17))
    heights[-1], heights[:, -1] = heights[0], heights[:, 0]
    return made(heights, edge="tile")
