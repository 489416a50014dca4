"""Pictures of running episodes: remembers the paths and hands them to the command map."""

from collections import OrderedDict, deque

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from discjump._native import TaskBatch, Terrain
from discjump.envs.command_map import CommandMap

# Recording is one array per decision; an hour at one tick per decision.
LONGEST_PATH = 112_500
MAPS_KEPT = 4


class Camera:
    """Command maps of a batch.

    Args:
        batch: watched from its first reset on.
        terrains: its pool.
        arrival_radius: drawn round the beacon, m.
    """

    def __init__(self, batch: TaskBatch, terrains: list[Terrain], arrival_radius: float) -> None:
        self._batch = batch
        self._terrains = terrains
        self._radius = arrival_radius
        # One (num_envs, 3) array of x, y, speed per decision; a path is the last `_points` of them.
        self._track: deque[NDArray[np.float64]] = deque(maxlen=LONGEST_PATH)
        self._points = np.zeros(batch.num_envs, np.int64)
        self._maps: OrderedDict[int, CommandMap] = OrderedDict()

    @property
    def paths(self) -> tuple[list[NDArray[np.float64]], NDArray[np.int64]]:
        """What it remembers of all episodes, for a copy of it."""
        return list(self._track), self._points.copy()

    @paths.setter
    def paths(self, paths: tuple[list[NDArray[np.float64]], NDArray[np.int64]]) -> None:
        self._track.clear()
        self._track.extend(paths[0])
        self._points = paths[1].copy()

    def restart(self, rows: NDArray[np.bool_]) -> None:
        """New episodes began in `rows` by a reset; the others did not move."""
        self._points[rows] = 0
        if self._track:
            self._track.pop()
            self._points[~rows] -= 1
        self.advance(rows)

    def advance(self, began: NDArray[np.bool_]) -> None:
        """The batch made a step; new episodes began in the rows `began`, (num_envs,) bool."""
        state = self._batch.state()
        speed = np.linalg.norm(state["velocity"].astype(np.float64), axis=1)
        self._track.append(np.column_stack([state["position"][:, :2], speed]))
        self._points = np.where(began, 0, self._points) + 1
        while len(self._track) > self._points.max():
            self._track.popleft()

    def picture(self, index: int) -> NDArray[np.uint8]:
        """The command map of environment `index`, (height, width, 3) uint8."""
        if not self._points[index]:
            raise ResetNeeded("render: expected a call of reset() first: no episode is running")
        steps = list(self._track)[-int(self._points[index]) :]
        state = self._batch.state()[index]
        return self._map(int(self._batch.terrain_index()[index])).draw(
            path=np.array([step[index] for step in steps]),
            yaw=float(state["yaw"]),
            beacon=self._batch.goals()[index, :2],
            arrival_radius=self._radius,
        )

    def _map(self, terrain: int) -> CommandMap:
        if terrain not in self._maps:
            self._maps[terrain] = CommandMap(self._terrains[terrain])
        self._maps.move_to_end(terrain)
        while len(self._maps) > MAPS_KEPT:
            self._maps.popitem(last=False)
        return self._maps[terrain]
