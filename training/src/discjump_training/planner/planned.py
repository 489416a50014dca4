"""What a planner did."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump import replays
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay
from discjump_training.courses import Course
from discjump_training.errors import TrainingError
from discjump_training.planner.settings import Settings
from discjump_training.policy import Actions, Floats, Mask, Observations


@dataclass(frozen=True)
class Cost:
    """What planning an episode took.

    Attributes:
        decisions: simulated ones of all candidates.
        ticks: simulated ones.
        simulated_seconds: of all candidates together.
        wall_seconds: the episode's share of the time that its group was planned in.
        cpu_seconds: the same of the processors' time.
    """

    decisions: int
    ticks: int
    simulated_seconds: float
    wall_seconds: float
    cpu_seconds: float


@dataclass(frozen=True)
class Outcome:
    """How a planned episode ended.

    Attributes:
        episode: of the course.
        seed: of its environment.
        success, death, timeout: exactly one is true.
        seconds: until success; failures count as the time limit.
        decisions: real ones.
        episode_return: sum of rewards.
        cost: of planning it.
    """

    episode: int
    seed: int
    success: bool
    death: bool
    timeout: bool
    seconds: float
    decisions: int
    episode_return: float
    cost: Cost

    @classmethod
    def of(cls, plain: dict[str, Any]) -> "Outcome":
        """From JSON."""
        return cls(**{**plain, "cost": Cost(**plain["cost"])})


class Pairs(NamedTuple):
    """What was seen and what was done: `n` decisions, episode after episode.

    Attributes:
        observations: (n, size) float32.
        actions: (n, components) int64.
        episode: of the course, (n,).
        seconds_left: until the episode's end, (n,).
    """

    observations: Observations
    actions: Actions
    episode: NDArray[np.int64]
    seconds_left: Floats


@dataclass(frozen=True)
class Planned:
    """Planned episodes of a course.

    Attributes:
        task: name.
        course: which episodes.
        wanted: how many of them were asked for; more than there are outcomes: partial.
        settings: of the planner.
        guides, values: what completed sequences and judged their ends; empty: nothing.
        options: of the environments, terrains excepted.
        outcomes: in the order of the course.
        replays: by episode.
        folder: where all of it is stored; None: nowhere.
    """

    task: str
    course: Course
    wanted: int
    settings: Settings
    guides: tuple[str, ...]
    values: tuple[str, ...]
    options: dict[str, Any]
    outcomes: tuple[Outcome, ...]
    replays: dict[int, EpisodeReplay]
    folder: Path | None

    @property
    def partial(self) -> bool:
        """Whether episodes are missing."""
        return len(self.outcomes) < self.wanted

    @property
    def seconds(self) -> Floats:
        """Time of each outcome, failures counting as the time limit."""
        return np.array([one.seconds for one in self.outcomes])

    @property
    def success(self) -> Mask:
        """Who succeeded."""
        return np.array([one.success for one in self.outcomes], np.bool_)

    def pairs(self, **options: Any) -> Pairs:
        """Observations and actions of all episodes, as a policy would have seen and done them.

        Args:
            **options: of the task, in place of those that it was planned with: other parts of the
                observation for a policy that sees them. What changes the physics is refused.

        Raises:
            TrainingError: if the episodes come out otherwise with these options.
        """
        rows = [one.episode for one in self.outcomes]
        if not rows:
            raise TrainingError("pairs: expected planned episodes, got none")
        env: Any = gymnasium.make_vec(
            TASKS[self.task].id,
            num_envs=len(rows),
            threads=1,
            terrain_seeds=list(self.course.terrain_seeds),
            **{**self.options, **options},
        )
        observations, _ = env.reset(seed=[one.seed for one in self.outcomes])
        taken = [self.replays[row].actions for row in rows]
        seen: list[list[Observations]] = [[] for _ in rows]
        action = np.zeros(env.action_space.shape, np.int64)
        for time in range(max(map(len, taken))):
            for slot, actions in enumerate(taken):
                if time < len(actions):
                    seen[slot].append(observations[slot])
                    action[slot] = actions[time]
            observations, _, terminated, truncated, info = env.step(action)
            ended = terminated | truncated
            for slot, one in enumerate(self.outcomes):
                last = time == one.decisions - 1
                planned_time = (self.replays[one.episode].outcome or {}).get("time")
                if time < one.decisions and (
                    ended[slot] != last or (last and info["time"][slot] != planned_time)
                ):
                    raise TrainingError(
                        f"pairs: episode {one.episode} does not end as it was planned with the options "
                        f"{options}: expected some that change the observation alone"
                    )
        period = env.unwrapped.options.decision_seconds
        env.close()
        return Pairs(
            np.concatenate([np.stack(one) for one in seen]),
            np.concatenate(taken).astype(np.int64),
            np.repeat(rows, [len(actions) for actions in taken]),
            np.concatenate([period * np.arange(len(actions), 0, -1.0) for actions in taken]),
        )

    def replay_path(self, episode: int) -> Path:
        """Where the replay of an episode is stored."""
        assert self.folder is not None
        return replay_path(self.folder, self.course, episode)

    def as_dict(self) -> dict[str, Any]:
        """For JSON; replays are files of their own."""
        return {
            "schema_version": 1,
            "task": self.task,
            "course": self.course.name,
            "wanted": self.wanted,
            "partial": self.partial,
            "settings": self.settings.as_dict(),
            "guides": list(self.guides),
            "values": list(self.values),
            "options": self.options,
            "episodes": [asdict(one) for one in self.outcomes],
        }


def replay_path(folder: Path, course: Course, episode: int) -> Path:
    """Where the replay of an episode is stored."""
    return folder / "replays" / f"{course.name}-{episode:04}-planner.replay"


def load_replay(path: Path) -> EpisodeReplay:
    """A stored replay.

    Raises:
        TrainingError: if it cannot be read.
    """
    try:
        found = replays.load(path)
    except (replays.ReplayError, OSError) as error:
        raise TrainingError(f"{path}: {error}") from error
    assert isinstance(found, EpisodeReplay)
    return found
