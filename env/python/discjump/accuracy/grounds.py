"""Terrains of the situations. All tile, and have their centre at the origin."""

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.terrains import generated

Floats = NDArray[np.float64]

SQUARE = 8.0
"""Side of a square, m."""
SEEDS = (1000, 1001, 1002, 1003)
"""Seeds of the generated terrains."""
PERIOD = 128.0
"""From one crease to the next, m."""


def rolling() -> dict[str, Terrain]:
    """Generated maps by name."""
    return {f"terrain {seed}": generated(seed) for seed in SEEDS}


def creased(degrees: float) -> Terrain:
    """Straight valleys along y, `PERIOD` apart, whose sides rise at `degrees`; a crease at x = 0.

    >>> creased(45.0).height([[0.0, 3.0], [10.0, 3.0], [-54.0, 3.0]]).tolist()
    [0.0, 10.0, 54.0]
    """
    x = _axis(129)
    profile = np.tan(np.radians(degrees)) * np.abs(np.mod(x + PERIOD / 2, PERIOD) - PERIOD / 2)
    return _terrain(np.broadcast_to(profile, (129, 129)))


def steep(seed: int, median: float = 60.0, smooth: float = 12.0) -> Terrain:
    """Rough hills whose triangles have a median slope of `median` degrees.

    White noise, blurred by a Gaussian of standard deviation `smooth` m, and stretched to the slope wanted.
    """
    side = 128
    noise = np.random.default_rng(seed).standard_normal((side, side))
    frequency = 2.0 * np.pi * np.fft.fftfreq(side, SQUARE)
    blur = np.exp(-0.5 * smooth**2 * (frequency[:, None] ** 2 + frequency[None, :] ** 2))
    heights = np.fft.ifft2(np.fft.fft2(noise) * blur).real
    heights = np.pad(heights, ((0, 1), (0, 1)), mode="wrap")
    # Gradients grow in proportion to the heights.
    heights *= np.tan(np.radians(median)) / np.median(np.tan(slopes(heights)))
    return _terrain(heights - heights.min())


def slopes(heights: Floats) -> Floats:
    """Slopes in rad of the triangles whose right angle is a square's low corner, or its high one."""
    low = np.hypot(np.diff(heights, axis=1)[:-1], np.diff(heights, axis=0)[:, :-1])
    high = np.hypot(np.diff(heights, axis=1)[1:], np.diff(heights, axis=0)[:, 1:])
    steepness: Floats = np.arctan(np.stack([low, high]) / SQUARE)
    return steepness


def _axis(count: int) -> Floats:
    return SQUARE * np.arange(count, dtype=np.float64) - 0.5 * SQUARE * (count - 1)


def _terrain(heights: Floats) -> Terrain:
    """The heights, rounded to float32: only then does every tier read the same ones."""
    rows, columns = heights.shape
    corner = (-0.5 * SQUARE * (columns - 1), -0.5 * SQUARE * (rows - 1))
    return Terrain.from_heights(heights.astype(np.float32).astype(np.float64), SQUARE, corner, "tile")
