"""Plays the fixed episodes of a course with a policy, all at once."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import discjump  # noqa: F401  registers the environment ids
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay, VectorRecorder
from discjump_training.courses import Course
from discjump_training.policy import Floats, Layout, Mask, Policy

#: An episode that ends without arrival counts as this many seconds, the length of a time-out.
FAILURE_SECONDS = 60.0


@dataclass(frozen=True)
class Episodes:
    """What happened in `n` episodes; row `i` is the course's episode `i`.

    Attributes:
        success, death: how they ended, (n,) bool; neither: timed out.
        seconds: time to the beacon, failures count as `FAILURE_SECONDS`, (n,).
        mean_speed, top_speed: m/s, (n,).
        damage: at the end, 0 is unhurt, (n,).
        start_distance: horizontal metres from start to beacon, (n,).
        episode_return: sum of rewards, (n,).
        terrain: index into the course's terrain seeds, (n,) int.
        goals: beacons, metres, (n, 3).
        paths: position and speed (x, y, z, m/s) at each decision for the episodes that were recorded, by row.
    """

    success: Mask
    death: Mask
    seconds: Floats
    mean_speed: Floats
    top_speed: Floats
    damage: Floats
    start_distance: Floats
    episode_return: Floats
    terrain: NDArray[np.int64]
    goals: Floats
    paths: dict[int, Floats]


class Stage:
    """Environments for the episodes of a course, to play them with one policy after another.

    Args:
        course: which terrains and episodes.
        episodes: how many of them; all by default.
        options: of the task's environment, terrains excepted.
        threads: of the simulator; all cores by default.
    """

    def __init__(
        self,
        course: Course,
        episodes: int | None = None,
        options: dict[str, Any] | None = None,
        threads: int | None = None,
    ) -> None:
        self.course = course
        self._seeds = [int(seed) for seed in course.seeds(episodes)]
        self.env = gymnasium.make_vec(
            TASKS[course.task].id,
            num_envs=len(self._seeds),
            threads=threads,
            terrain_seeds=list(course.terrain_seeds),
            **(options or {}),
        )
        self.inner: Any = self.env.unwrapped

    @property
    def layout(self) -> Layout:
        """Layout of the observations."""
        return Layout.of(self.inner.observation_layout)

    @property
    def turn_rate(self) -> float:
        """Largest turn of the action space, rad/s."""
        return float(self.inner.options.turn_rate)

    @property
    def frame_skip(self) -> int:
        """Ticks per decision."""
        return int(self.inner.options.frame_skip)

    def play(
        self,
        policy: Policy,
        record: tuple[int, ...] = (),
        on_replay: Callable[[int, EpisodeReplay], object] | None = None,
    ) -> Episodes:
        """Play every episode to its end.

        Args:
            policy: decides.
            record: rows whose paths are kept.
            on_replay: called with the row and the replay of each episode when it is over.
        """
        env: Any = self.env
        if on_replay is not None:
            env = VectorRecorder(env, episodes=1, on_replay=lambda one: on_replay(one.made["index"], one))
        observations, info = env.reset(seed=self._seeds)
        num_envs = len(self._seeds)
        policy.reset(np.ones(num_envs, np.bool_))
        goals, terrain = self.inner.goals(), self.inner.terrain_index
        running = np.ones(num_envs, np.bool_)
        last: dict[str, NDArray[Any]] = {}
        paths: dict[int, list[Floats]] = {row: [] for row in record}

        # Environments whose episode is over go on with another one that nobody looks at.
        while running.any():
            self._record(paths, running)
            observations, _, terminated, truncated, info = env.step(policy(observations))
            ended = running & (terminated | truncated)
            if ended.any():
                for key in KEYS:
                    last.setdefault(key, np.zeros(num_envs, info[key].dtype))[ended] = info[key][ended]
                self._record({row: path for row, path in paths.items() if ended[row]}, running)
            running &= ~ended
        return Episodes(
            success=last["is_success"],
            death=last["death"],
            seconds=np.where(last["is_success"], last["time"], FAILURE_SECONDS),
            mean_speed=last["mean_speed"],
            top_speed=last["top_speed"],
            damage=last["damage"],
            start_distance=last["start_distance"],
            episode_return=last["return"],
            terrain=terrain,
            goals=goals,
            paths={row: np.array(path) for row, path in paths.items()},
        )

    def close(self) -> None:
        """Close the environments."""
        self.env.close()

    def _record(self, paths: dict[int, list[Floats]], running: Mask) -> None:
        if not paths or not running[list(paths)].any():
            return
        state = self.inner.state()
        for row, path in paths.items():
            if running[row]:
                path.append(np.append(state["position"][row], np.linalg.norm(state["velocity"][row])))


KEYS = ("is_success", "death", "time", "mean_speed", "top_speed", "damage", "start_distance", "return")
