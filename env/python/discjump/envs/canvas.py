"""Anti-aliased shapes on a float64 image of shape (height, width, 3), values 0..255, in place.

Points are (x, y) = (column, row) in pixels, the centre of the first pixel is (0, 0). What lies outside is
clipped. Coverage is 1 inside, 0 outside, and falls linearly over the pixel at the rim.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float64]
Colour = Sequence[float]

# Slow is dark violet, fast is yellow; lightness grows with speed.
_SPEED = np.array(
    [(44, 12, 96), (126, 22, 128), (198, 50, 110), (242, 104, 62), (252, 180, 50), (252, 250, 160)], float
)


def speed_colours(share: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 3) colours of shares of the top speed, clipped to 0..1."""
    place = np.clip(share, 0, 1) * (len(_SPEED) - 1)
    return np.stack(
        [np.interp(place, np.arange(len(_SPEED)), _SPEED[:, channel]) for channel in range(3)], axis=-1
    )


def polyline(
    image: Image,
    points: NDArray[np.float64],
    radius: float,
    colours: NDArray[np.float64],
    opacity: float = 1.0,
) -> None:
    """A stroke through `points` (k, 2), `radius` pixels to each side; `colours` (k, 3), or (1, 3) for one
    colour.

    Where the stroke crosses itself the later part lies on top.
    """
    dense, shade = _resampled(points, np.broadcast_to(colours, (len(points), 3)))
    height, width = image.shape[:2]
    reach = int(np.ceil(radius + 1))
    span = np.arange(-reach, reach + 1)
    near = np.round(dense).astype(np.int64)
    columns = near[:, 0, np.newaxis, np.newaxis] + span[np.newaxis, np.newaxis, :]
    rows = near[:, 1, np.newaxis, np.newaxis] + span[np.newaxis, :, np.newaxis]
    distance = np.hypot(
        columns - dense[:, 0, np.newaxis, np.newaxis], rows - dense[:, 1, np.newaxis, np.newaxis]
    )
    cover = np.clip(radius + 0.5 - distance, 0, 1)
    order = np.broadcast_to(np.arange(len(dense))[:, np.newaxis, np.newaxis], cover.shape)
    columns, rows = np.broadcast_to(columns, cover.shape), np.broadcast_to(rows, cover.shape)
    seen = (cover > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    flat = rows[seen] * width + columns[seen]

    coverage, latest = np.zeros(height * width), np.zeros(height * width, np.int64)
    np.maximum.at(coverage, flat, cover[seen])
    np.maximum.at(latest, flat, order[seen])
    touched = np.flatnonzero(coverage)
    pixels = image.reshape(-1, 3)
    share = opacity * coverage[touched, np.newaxis]
    pixels[touched] += share * (shade[latest[touched]] - pixels[touched])


def disc(image: Image, centre: NDArray[np.float64], radius: float, colour: Colour) -> None:
    """A filled disc."""
    _blend(image, np.clip(radius + 0.5 - _distance(image, centre), 0, 1), colour)


def ring(image: Image, centre: NDArray[np.float64], radius: float, width: float, colour: Colour) -> None:
    """A circle, its line `width` pixels wide."""
    off = np.abs(_distance(image, centre) - radius)
    _blend(image, np.clip(width / 2 + 0.5 - off, 0, 1), colour)


def polygon(image: Image, corners: NDArray[np.float64], fill: Colour, outline: Colour) -> None:
    """A simple polygon of (k, 2) corners with an outline 1.4 pixels wide."""
    rows, columns = np.indices(image.shape[:2])
    inside = np.zeros(image.shape[:2], np.bool_)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > rows) != (y1 > rows)
            inside ^= crosses & (columns < (x1 - x0) * (rows - y0) / (y1 - y0) + x0)
    image[inside] = fill
    polyline(image, np.vstack([corners, corners[:1]]), 0.7, np.array([outline], float))


def _distance(image: Image, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    rows, columns = np.ogrid[: image.shape[0], : image.shape[1]]
    distance: NDArray[np.float64] = np.hypot(columns - centre[0], rows - centre[1])
    return distance


def _blend(image: Image, cover: NDArray[np.float64], colour: Colour) -> None:
    image += cover[..., np.newaxis] * (np.asarray(colour, float) - image)


def _resampled(
    points: NDArray[np.float64], colours: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points at most half a pixel apart along the line, and their colours."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    places = np.linspace(0, length[-1], int(2 * length[-1]) + 2)
    dense = np.stack([np.interp(places, length, points[:, axis]) for axis in range(2)], axis=-1)
    shade = np.stack([np.interp(places, length, colours[:, axis]) for axis in range(3)], axis=-1)
    return dense, shade
