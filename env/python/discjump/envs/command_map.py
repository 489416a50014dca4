"""The command map: terrain from above with a player's path, drawn in software with numpy.

North (+y) is up. Hillshade lit from the north-west, contours every 10 m (each fifth stronger), the mission
area and its flags and bridge, the beacon with its arrival radius, the path coloured by speed, the player as
an arrow. The bar at the bottom left is the colour scale, 0 to 50 m/s with a tick every 10; the bar at the
bottom right is 100 m long.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.envs import canvas, relief

MARGIN = 40.0
TOP_SPEED = 50.0

BEACON = (255, 92, 40)
FLAG = (40, 60, 200)
AREA = (250, 246, 230)
INK = (24, 22, 28)


class Window(NamedTuple):
    """A square of the map: its south-west corner and side, m."""

    west: float
    south: float
    side: float


class CommandMap:
    """Draws maps of one terrain; the ground is drawn once per window and kept.

    Args:
        terrain: what to draw.
        size: height and width of the picture, pixels.
    """

    def __init__(self, terrain: Terrain, size: int = 400) -> None:
        self._terrain = terrain
        self._size = size
        self._window: Window | None = None
        self._ground = np.zeros((size, size, 3))

    def draw(
        self, *, path: NDArray[np.float64], yaw: float, beacon: NDArray[np.float64], arrival_radius: float
    ) -> NDArray[np.uint8]:
        """A picture, (size, size, 3) uint8; the same arguments always give the same bytes.

        Args:
            path: (k, 3), x, y in m and speed in m/s, k >= 1; the last row is the player.
            yaw: of the player, rad, counter-clockwise, 0 looks north.
            beacon: (2,), m.
            arrival_radius: m.
        """
        window = self._fit(np.vstack([path[:, :2], beacon]))
        if window != self._window:
            self._ground, self._window = ground(self._terrain, window, self._size), window
        image = self._ground.copy()
        scale = self._size / window.side

        where = _pixels(window, self._size, path[:, :2])
        canvas.polyline(image, where, 2.6, np.array([INK], float), opacity=0.55)
        canvas.polyline(image, where, 1.5, canvas.speed_colours(path[:, 2] / TOP_SPEED))
        canvas.ring(image, where[0], 4.0, 1.2, AREA)

        at = _pixels(window, self._size, beacon[np.newaxis])[0]
        canvas.ring(image, at, max(arrival_radius * scale, 5.0), 1.6, BEACON)
        canvas.disc(image, at, 2.2, BEACON)

        ahead = np.array([-np.sin(yaw), -np.cos(yaw)])  # image rows grow southward
        side = np.array([-ahead[1], ahead[0]])
        arrow = where[-1] + np.array([9 * ahead, -6 * ahead + 5 * side, -3 * ahead, -6 * ahead - 5 * side])
        canvas.polygon(image, arrow, AREA, INK)
        self._legend(image, scale)
        return finished(image)

    def _fit(self, points: NDArray[np.float64]) -> Window:
        """The square round the mission area and `points`, in whole steps of 64 m so that it seldom
        changes.
        """
        mission = self._terrain.mission
        if mission is not None:
            points = np.vstack([points, mission["area_min"][:2], mission["area_max"][:2]])
        low, high = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
        side = float(np.ceil((high - low).max() / 64) * 64)
        west, south = np.floor(((low + high) / 2 - side / 2) / 64 + 0.5) * 64
        if not ((low >= (west, south)).all() and (high <= (west + side, south + side)).all()):
            side += 64
            west, south = np.floor(low / 64) * 64
        return Window(float(west), float(south), side)

    def _legend(self, image: NDArray[np.float64], scale: float) -> None:
        bottom = self._size - 10
        stops = np.linspace(0, 1, 41)
        bar = np.column_stack([10 + 100 * stops, np.full(41, float(bottom))])
        canvas.polyline(image, bar, 4.0, np.array([INK], float))
        canvas.polyline(image, bar, 3.0, canvas.speed_colours(stops))
        for tick in np.arange(0, TOP_SPEED + 1, 10) / TOP_SPEED:
            x = 10 + 100 * tick
            canvas.polyline(
                image, np.array([(x, bottom - 7.0), (x, bottom - 3.0)]), 0.7, np.array([INK], float)
            )
        right = self._size - 10.0
        bar = np.array([(right - 100 * scale, float(bottom)), (right, float(bottom))])
        canvas.polyline(image, bar, 2.0, np.array([INK], float))
        canvas.polyline(image, bar, 1.0, np.array([AREA], float))


def ground(terrain: Terrain, window: Window, size: int) -> NDArray[np.float64]:
    """Relief, mission area, flags and bridge, (size, size, 3) float64 in 0..255."""
    image = relief.shaded(terrain, window.west, window.south, window.side, size)
    mission = terrain.mission
    if mission is not None:
        (x0, y0), (x1, y1) = mission["area_min"][:2], mission["area_max"][:2]
        border = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], float)
        canvas.polyline(image, _pixels(window, size, border), 0.7, np.array([AREA], float), opacity=0.8)
        bridge = _pixels(window, size, np.asarray(mission["bridge_ends"])[:, :2])
        canvas.polyline(image, bridge, 1.5, np.array([AREA], float))
        for flag in _pixels(window, size, np.asarray(mission["flags"])[:, :2]):
            canvas.disc(image, flag, 4.0, FLAG)
            canvas.ring(image, flag, 4.5, 1.0, AREA)
    return image


def finished(image: NDArray[np.float64]) -> NDArray[np.uint8]:
    """The image in bytes, rounded and clipped."""
    return np.clip(image + 0.5, 0, 255).astype(np.uint8)


def _pixels(window: Window, size: int, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 2) world x, y -> (k, 2) image x (column), y (row)."""
    scale = size / window.side
    east, north = points[:, 0] - window.west, points[:, 1] - window.south
    return np.column_stack([east * scale - 0.5, size - north * scale - 0.5])
