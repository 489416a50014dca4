"""Shaded relief with contours."""

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain

CONTOUR = 10.0
STRONG = 50.0
VOID = (58, 62, 74)

# Low ground greenish, high ground pale: (share of the height range, red, green, blue).
_TINTS = np.array(
    [
        (0.0, 96, 122, 92),
        (0.3, 142, 150, 104),
        (0.6, 188, 170, 128),
        (0.85, 214, 202, 176),
        (1.0, 238, 234, 224),
    ]
)


def sampled(
    terrain: Terrain, west: float, south: float, side: float, pixels: int, rim: int
) -> NDArray[np.float64]:
    """Heights at the centres of `pixels` x `pixels` squares and of `rim` more on each side, m.

    Returns:
        (pixels + 2 rim, pixels + 2 rim) float64, first row northmost; NaN where there is no ground.
    """
    step = side / pixels
    centres = (np.arange(-rim, pixels + rim) + 0.5) * step
    x, y = np.meshgrid(west + centres, south + centres[::-1])
    return terrain.height(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)


def shaded(terrain: Terrain, west: float, south: float, side: float, pixels: int) -> NDArray[np.float64]:
    """A picture of the ground, (pixels, pixels, 3) float64 in 0..255, north up."""
    step = side / pixels
    rim = sampled(terrain, west, south, side, pixels, 1)
    heights = rim[1:-1, 1:-1]
    east = (rim[1:-1, 2:] - rim[1:-1, :-2]) / (2 * step)
    north = (rim[:-2, 1:-1] - rim[2:, 1:-1]) / (2 * step)

    low, high = np.nanmin(terrain.heights), np.nanmax(terrain.heights)
    share = (heights - low) / max(high - low, 1.0)
    tint = np.stack([np.interp(share, _TINTS[:, 0], _TINTS[:, channel]) for channel in (1, 2, 3)], axis=-1)
    # Lambert's law, light from the north-west 45 degrees up; 0.35 of it is ambient.
    light = (-east * -0.5 + -north * 0.5 + np.sqrt(0.5)) / np.sqrt(1 + east**2 + north**2)
    image: NDArray[np.float64] = tint * (0.35 + 0.85 * np.clip(light, 0, 1))[..., np.newaxis]

    slope = np.hypot(east, north)
    for interval, opacity in ((CONTOUR, 0.22), (STRONG, 0.4)):
        image *= (1 - opacity * _contours(heights, slope, interval, step))[..., np.newaxis]
    image[np.isnan(heights)] = VOID
    return image


def _contours(
    heights: NDArray[np.float64], slope: NDArray[np.float64], interval: float, step: float
) -> NDArray[np.float64]:
    """How much of each pixel a contour one pixel wide covers, 0 to 1."""
    off = np.abs(heights - interval * np.round(heights / interval))
    # Level ground has no contour, however near its height is to a multiple.
    pixels = off / np.maximum(slope * step, 1e-9)
    cover: NDArray[np.float64] = np.clip(1 - pixels, 0, 1) * (slope > 0.02)
    return cover
