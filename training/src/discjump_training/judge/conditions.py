"""What all policies of an evaluation meet: the course, and what was changed about it."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from discjump import Physics, Terrain
from discjump.envs.tasks import TASKS, Task
from discjump_training.courses import Course
from discjump_training.courses.public import check_terrains
from discjump_training.errors import TrainingError
from discjump_training.evaluate import in_task


@dataclass(frozen=True)
class Conditions:
    """Course and circumstances.

    Attributes:
        course: which episodes.
        episodes: how many of them, from the first on.
        changes: options of the environment that differ from the task's, whatever the policy.
        terrain: a heightfield of the user's in place of the course's terrains.
        noise: standard deviation of what is added to every number that a policy observes.
        sampled: models draw their actions instead of taking the likeliest.
        threads: of the simulator; None: all cores.
        square_size: distance between the heights of `terrain`, m.

    Raises:
        TrainingError: the course has fewer episodes, or does not go with the changes.
    """

    course: Course
    episodes: int
    changes: Mapping[str, Any] = field(default_factory=dict)
    terrain: Path | None = None
    noise: float = 0.0
    sampled: bool = False
    threads: int | None = None
    square_size: float = 8.0

    def __post_init__(self) -> None:
        """Check what can be checked before anything is played."""
        self.course.seeds(self.episodes)
        if self.course.places:
            moved = [
                name for name in ("terrain_seeds", "terrains", "repeating", "surface") if name in self.changes
            ]
            if self.terrain is not None or moved:
                what = "--terrain" if self.terrain is not None else moved[0]
                raise TrainingError(
                    f"course {self.course.name} fixes its terrains, and {what} would change them: "
                    "choose a course that is drawn, such as held-out"
                )
            check_terrains(self.course)
        if not 0.0 <= self.noise < float("inf"):
            raise TrainingError(
                f"noise: expected a finite standard deviation of at least 0, got {self.noise}"
            )
        try:
            self.task.options.from_keywords(self.environment({}))
        except (TypeError, ValueError) as error:
            raise TrainingError(f"task {self.task.name}: {error}") from error

    @property
    def task(self) -> Task:
        """The course's task."""
        return TASKS[self.course.task]

    @property
    def time_limit(self) -> float:
        """What an episode that fails counts as, s."""
        return float(self.changes.get("time_limit", self.task.options.time_limit))

    @cached_property
    def _ground(self) -> list[Terrain]:
        return [] if self.terrain is None else [heightfield(self.terrain, self.square_size)]

    def environment(self, needs: Mapping[str, Any]) -> dict[str, Any]:
        """Options of the environment for a policy.

        Args:
            needs: options that the policy was made for; the physics among them gives way to the task's.
        """
        ground = {"terrains": self._ground, "surface": None} if self._ground else {}
        return {**in_task(needs, self.task.name), **ground, **self.changes}

    def terrains(self) -> list[Terrain]:
        """The terrains that an episode's index counts, those of the course or what came in their place."""
        return self.task.options.from_keywords(
            {"terrain_seeds": list(self.course.terrain_seeds), **self.environment({})}
        ).pool()

    def terrain_name(self, index: int) -> str:
        """Of the terrain with that index: its seed, or the file's name."""
        if self.terrain is not None:
            return self.terrain.name
        seeds = self.changes.get("terrain_seeds", self.course.terrain_seeds)
        return str(seeds[index])

    def told(self) -> dict[str, Any]:
        """What differs from the plain course, for people and for JSON."""
        told: dict[str, Any] = {name: _plain(value) for name, value in self.changes.items()}
        if self.terrain is not None:
            told["terrain"] = f"{self.terrain.name} ({self._ground[0].digest()})"
        if self.noise:
            told["noise"] = self.noise
        return told


def parse_changes(texts: tuple[str, ...], task: str) -> dict[str, Any]:
    """Options of a task's environment from `option=value`, the value as TOML has it; quotes around words may
    be left out. Switches of the physics are `physics.NAME=value`.

    Raises:
        TrainingError: no such option or no value; names it.

    >>> parse_changes(("armor=heavy", "terrain_seeds=[3, 4]", "physics.ski_bug=false"), "ski")
    {'armor': 'heavy', 'terrain_seeds': [3, 4], 'physics': Physics(...)}
    """
    changes: dict[str, Any] = {}
    switches: dict[str, Any] = {}
    known = [one.name for one in fields(TASKS[task].options) if one.name not in ("terrains", "physics")]
    for text in texts:
        name, found, value = text.partition("=")
        if not found or not value:
            raise TrainingError(f"--set: expected option=value, got {text!r}")
        parsed = _value(value)
        if name.startswith("physics."):
            switches[name.removeprefix("physics.")] = parsed
        elif name in known:
            changes[name] = parsed
        else:
            raise TrainingError(
                f"--set: expected an option of the task {task}: {', '.join(known)} or physics.NAME, "
                f"got {name!r}"
            )
    if switches:
        try:
            changes["physics"] = Physics(**switches)
        except (TypeError, ValueError) as error:
            raise TrainingError(f"--set physics: {error}") from error
    return changes


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _plain(value: Any) -> Any:
    return value if isinstance(value, (str, int, float, bool, list, dict)) else str(value)


def heightfield(path: Path, square_size: float) -> Terrain:
    """The ground in a file of numpy's, heights[row y][column x] in m, its middle at the origin. It repeats if
    its last row and column repeat the first, else its rim goes on for ever.

    Raises:
        TrainingError: it cannot be read, or holds no ground.
    """
    try:
        heights = np.load(path, allow_pickle=False)
        if not isinstance(heights, np.ndarray) or heights.ndim != 2 or heights.dtype.kind not in "fiu":
            raise ValueError("expected heights of shape (rows, columns)")
        heights = heights.astype(np.float64)
        repeats = np.array_equal(heights[0], heights[-1]) and np.array_equal(heights[:, 0], heights[:, -1])
        rows, columns = heights.shape
        middle = (-0.5 * square_size * (columns - 1), -0.5 * square_size * (rows - 1))
        return Terrain.from_heights(heights, square_size, middle, "tile" if repeats else "clamp")
    except (OSError, EOFError, TypeError, ValueError) as error:
        message = str(error) if str(path) in str(error) else f"{path}: {error}"
        raise TrainingError(f"--terrain: {message}") from None
