"""What a course is, and the seeds that trainings keep to."""

import hashlib
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump_training.errors import TrainingError

#: Distance between the environment seeds of two training runs: more than any run has environments.
SEED_SPACING = 1_000_000
#: Largest run seed: the seed of the last run must fit the 32 bits that numpy's global generator takes.
MAX_RUN_SEED = 4_000


@dataclass(frozen=True)
class Place:
    """Where an episode of a public course is put.

    Attributes:
        terrain_seed: of the course's pool.
        start: x, y, metres; None where the task takes none, and the environment's seed says.
        goal: x, y, metres, likewise.
    """

    terrain_seed: int
    start: tuple[float, float] | None = None
    goal: tuple[float, float] | None = None


@dataclass(frozen=True)
class Course:
    """A fixed set of episodes.

    Attributes:
        name: name with version; a change of any other field needs a new one.
        terrain_seeds: seeds of the generated terrains that episodes draw from.
        base_seed: environment seed of episode 0.
        episodes: number of episodes in the course.
        task: short name of the task that it is a course of.
        places: where each episode is put; empty: its seed says.
    """

    name: str
    terrain_seeds: tuple[int, ...]
    base_seed: int
    episodes: int
    task: str = "ski"
    places: tuple[Place, ...] = ()

    @property
    def kind(self) -> str:
        """`train`, `validation`, `held-out` or `public`."""
        return self.name.removeprefix(f"{self.task}-").rpartition("-v")[0]

    @property
    def version(self) -> int:
        """Of its name."""
        return int(self.name.rpartition("-v")[2])

    def seeds(self, episodes: int | None = None) -> NDArray[np.uint64]:
        """Environment seeds of the first `episodes` episodes (all by default), shape (episodes,).

        Raises:
            TrainingError: if the course has fewer episodes.
        """
        count = self.episodes if episodes is None else episodes
        if not 1 <= count <= self.episodes:
            raise TrainingError(f"course {self.name} has 1 to {self.episodes} episodes to offer, not {count}")
        return self.base_seed + np.arange(count, dtype=np.uint64)

    def placement(self, rows: range) -> dict[str, Any] | None:
        """Options of `reset` for these rows: `start`, `goal`, `terrain_seed`; None where seeds say all."""
        if not self.places:
            return None
        placed = self.places[rows.start : rows.stop]
        options: dict[str, Any] = {"terrain_seed": [one.terrain_seed for one in placed]}
        for key in ("start", "goal"):
            points = [getattr(one, key) for one in placed]
            if points[0] is not None:
                options[key] = np.array(points, np.float64)
        return options

    def digest(self) -> str:
        """Of everything that makes its episodes, 16 hexadecimal digits."""
        content = {
            "name": self.name,
            "task": self.task,
            "terrain_seeds": list(self.terrain_seeds),
            "base_seed": self.base_seed,
            "episodes": self.episodes,
            "places": [[one.terrain_seed, one.start, one.goal] for one in self.places],
        }
        text = json.dumps(content, sort_keys=True, separators=(",", ":"))
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()


def run_seed(seed: int) -> int:
    """First environment seed of the training run `seed`.

    Raises:
        TrainingError: if `seed` is not in 0..MAX_RUN_SEED.
    """
    if not 0 <= seed <= MAX_RUN_SEED:
        raise TrainingError(f"seed must be in 0..{MAX_RUN_SEED}, got {seed}")
    return seed * SEED_SPACING
