"""Plays fixed episodes of a course with a policy, all at once."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from math import ceil
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import discjump  # noqa: F401  registers the environment ids
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay, VectorRecorder
from discjump_training.courses.course import Course
from discjump_training.errors import TrainingError
from discjump_training.policy import Floats, Layout, Mask, Policy

#: An episode of the ski task that ends without arrival counts as this many seconds, the length of a time-out.
FAILURE_SECONDS = 60.0
#: Who times out is stuck if all positions of the last `STUCK_SECONDS` lie within `STUCK_METRES` of the last.
STUCK_SECONDS = 15.0
STUCK_METRES = 20.0


@dataclass(frozen=True)
class Episodes:
    """What happened in `n` episodes; row `i` is the course's episode `i`, or that of the rows played.

    Attributes:
        success, death: how they ended, (n,) bool; neither: timed out.
        seconds: time to the goal, failures count as the time limit, (n,).
        mean_speed, top_speed: m/s, (n,).
        damage: at the end, 0 is unhurt, (n,).
        start_distance: horizontal metres from start to goal, (n,).
        episode_return: sum of rewards, (n,).
        terrain: index into the terrains of the pool, (n,) int.
        goals: metres, (n, 3).
        paths: position, speed and energy (x, y, z, m/s, energy) at each decision for the episodes that were
            recorded, by row; energy is NaN where the task has none.
        time: length of the episode, s, (n,).
        moved: how far from the last position the furthest of the last `STUCK_SECONDS` was, m, (n,).
        extra: what else the task's infos say at an episode's end, by key, each (n,).
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
    time: Floats
    moved: Floats
    extra: dict[str, Floats] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.success)

    @property
    def stuck(self) -> Mask:
        """(n,): timed out without getting anywhere at the end."""
        return ~self.success & ~self.death & (self.moved <= STUCK_METRES)


class Stage:
    """Environments for the episodes of a course, to play them with one policy after another.

    Args:
        course: which terrains and episodes.
        episodes: how many of them; all by default.
        options: of the task's environment; `terrain_seeds` or `terrains` take the place of the course's.
        threads: of the simulator; all cores by default.
        rows: which of them; all by default.

    Raises:
        TrainingError: the course has fewer episodes, or the task does not take the options.
    """

    def __init__(
        self,
        course: Course,
        episodes: int | None = None,
        options: dict[str, Any] | None = None,
        threads: int | None = None,
        *,
        rows: range | None = None,
    ) -> None:
        self.course = course
        seeds = [int(seed) for seed in course.seeds(episodes)]
        self.rows = range(len(seeds)) if rows is None else rows
        self._seeds = seeds[self.rows.start : self.rows.stop]
        try:
            self.env = gymnasium.make_vec(
                TASKS[course.task].id,
                num_envs=len(self._seeds),
                threads=threads,
                **{"terrain_seeds": list(course.terrain_seeds), **(options or {})},
            )
        except (TypeError, ValueError) as error:
            raise TrainingError(f"task {course.task}: {error}") from error
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

    @property
    def bins(self) -> tuple[int, ...]:
        """Bins of each action.

        Raises:
            TrainingError: actions have none (`actions="box"`).
        """
        space = self.env.single_action_space
        if not isinstance(space, gymnasium.spaces.MultiDiscrete):
            raise TrainingError(f"expected actions in bins, the environment has {space}")
        return tuple(int(count) for count in space.nvec)

    def play(
        self,
        policy: Policy,
        record: tuple[int, ...] = (),
        on_replay: Callable[[int, EpisodeReplay], object] | None = None,
    ) -> Episodes:
        """Play every episode to its end.

        Args:
            policy: decides. Where it has a method `begin`, that is told the rows before the first decision.
            record: indices of the episodes, among those played, whose paths are kept.
            on_replay: called with the row and the replay of each episode when it is over.
        """
        env: Any = self.env
        first = self.rows.start
        if on_replay is not None:
            env = VectorRecorder(
                env, episodes=1, on_replay=lambda one: on_replay(first + one.made["index"], one)
            )
        observations, info = env.reset(seed=self._seeds, options=self.course.placement(self.rows))
        num_envs = len(self._seeds)
        if hasattr(policy, "begin"):
            policy.begin(self.rows)
        policy.reset(np.ones(num_envs, np.bool_))
        goals, terrain = self.inner.goals(), self.inner.terrain_index
        running = np.ones(num_envs, np.bool_)
        last: dict[str, NDArray[Any]] = {}
        tracker = _Tracker(self.inner, record)

        # Environments whose episode is over go on with another one that nobody looks at.
        while running.any():
            tracker.look(running)
            observations, _, terminated, truncated, info = env.step(policy(observations))
            ended = running & (terminated | truncated)
            if ended.any():
                for key in (one for one in info if not one.startswith("_") and f"_{one}" in info):
                    value = np.asarray(info[key])
                    if value.shape == (num_envs,) and value.dtype != object:
                        last.setdefault(key, np.zeros(num_envs, value.dtype))[ended] = value[ended]
                tracker.look(ended)
                tracker.end(ended)
            running &= ~ended
        return Episodes(
            success=last["is_success"],
            death=last["death"],
            seconds=np.where(last["is_success"], last["time"], self.inner.options.time_limit),
            mean_speed=last["mean_speed"],
            top_speed=last["top_speed"],
            damage=last["damage"],
            start_distance=last["start_distance"],
            episode_return=last["return"],
            terrain=terrain,
            goals=goals,
            paths={row: np.array(path) for row, path in tracker.paths.items()},
            time=last["time"],
            moved=tracker.moved,
            extra={key: value.astype(np.float64) for key, value in last.items() if key not in KEYS},
        )

    def close(self) -> None:
        """Close the environments."""
        self.env.close()


KEYS = (
    "is_success",
    "death",
    "timeout",
    "time",
    "mean_speed",
    "top_speed",
    "damage",
    "start_distance",
    "return",
)


class _Tracker:
    """Where the players were: whole paths of some episodes, the last seconds of all."""

    def __init__(self, inner: Any, record: tuple[int, ...]) -> None:
        self._inner = inner
        self.paths: dict[int, list[Floats]] = {row: [] for row in record}
        self.moved = np.zeros(inner.num_envs)
        window = ceil(STUCK_SECONDS / inner.options.decision_seconds) + 1
        self._recent: deque[Floats] = deque(maxlen=window)

    def look(self, at: Mask) -> None:
        """Take note of the episodes in `at` (num_envs,)."""
        state = self._inner.state()
        self._recent.append(state["position"])
        if not self.paths:
            return
        speed = np.linalg.norm(state["velocity"], axis=1)
        known = "energy" in (state.dtype.names or ())
        energy = state["energy"] if known else np.full(len(speed), np.nan)
        table = np.column_stack([state["position"], speed, energy])
        for row, path in self.paths.items():
            if at[row]:
                path.append(table[row])

    def end(self, ended: Mask) -> None:
        """The episodes in `ended` (num_envs,) are over; it looked at their last state already."""
        recent = np.stack([positions[ended] for positions in self._recent])
        self.moved[ended] = np.linalg.norm(recent - recent[-1], axis=2).max(axis=0)
        # The same state is looked at again when the next decision is due.
        self._recent.pop()


def place(env: Any, snapshot: bytes, rows: range) -> None:
    """Put these environments of a vector environment of ours to where that one environment's snapshot is."""
    # The environment checks its arguments anew at each call: three quarters of the time.
    restore = env._task.batch.restore
    for row in rows:
        restore(snapshot, row)
