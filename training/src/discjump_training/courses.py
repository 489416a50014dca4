"""Named, versioned courses: which terrains and which episodes a policy is trained, chosen and judged on.

A course is a pool of terrain seeds and a range of environment seeds. Its episode `i` is the *first* episode
of the environment with seed `base_seed + i`: an episode is a function of that seed alone, so every policy
meets the same starts and beacons, and none can collect more short episodes than another by finishing them
sooner.

Seeds are kept apart by wide margins. Training run `r` uses the environment seeds from `r * SEED_SPACING`,
at most `MAX_RUN_SEED` runs; validation and held-out courses lie above all of these.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discjump_training.errors import TrainingError

#: Distance between the environment seeds of two training runs: more than any run has environments.
SEED_SPACING = 1_000_000
#: Largest run seed: the seed of the last run must fit the 32 bits that numpy's global generator takes.
MAX_RUN_SEED = 4_000


@dataclass(frozen=True)
class Course:
    """A fixed set of episodes.

    Attributes:
        name: name with version; a change of any other field needs a new one.
        terrain_seeds: seeds of the generated terrains that episodes draw from.
        base_seed: environment seed of episode 0.
        episodes: number of episodes in the course.
        task: short name of the task that it is a course of.
    """

    name: str
    terrain_seeds: tuple[int, ...]
    base_seed: int
    episodes: int
    task: str = "ski"

    def seeds(self, episodes: int | None = None) -> NDArray[np.uint64]:
        """Environment seeds of the first `episodes` episodes (all by default), shape (episodes,).

        Raises:
            TrainingError: if the course has fewer episodes.
        """
        count = self.episodes if episodes is None else episodes
        if not 1 <= count <= self.episodes:
            raise TrainingError(f"course {self.name} has 1 to {self.episodes} episodes to offer, not {count}")
        return self.base_seed + np.arange(count, dtype=np.uint64)


TRAIN = Course("ski-train-v1", tuple(range(16)), 4_500_000_000, 4_096)
VALIDATION = Course("ski-validation-v1", tuple(range(5_000, 5_008)), 5_000_000_000, 512)
HELD_OUT = Course("ski-held-out-v1", tuple(range(10_000, 10_016)), 10_000_000_000, 512)

COURSES = {course.name: course for course in (TRAIN, VALIDATION, HELD_OUT)}


def course(name: str) -> Course:
    """The course of that name.

    Raises:
        TrainingError: if there is none.
    """
    try:
        return COURSES[name]
    except KeyError:
        raise TrainingError(f"no course is named {name!r}; there are {', '.join(COURSES)}") from None


def run_seed(seed: int) -> int:
    """First environment seed of the training run `seed`.

    Raises:
        TrainingError: if `seed` is not in 0..MAX_RUN_SEED.
    """
    if not 0 <= seed <= MAX_RUN_SEED:
        raise TrainingError(f"seed must be in 0..{MAX_RUN_SEED}, got {seed}")
    return seed * SEED_SPACING
