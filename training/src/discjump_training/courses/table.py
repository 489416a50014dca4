"""One row per task: its courses follow from it.

A new task needs a row here, and nothing else: courses, their seeds and the test that no two share any follow.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discjump.terrains import TRAINING_SEEDS
from discjump_training.courses.course import Course
from discjump_training.errors import TrainingError
from discjump_training.policy import Floats

#: First environment seed of each kind of course; a task's lie `SLOT` times its slot above. All are above the
#: last seed of the last training run.
FIRST = {
    "train": 4_500_000_000,
    "validation": 5_000_000_000,
    "held-out": 10_000_000_000,
    "public": 20_000_000_000,
}
SLOT = 10_000
#: First terrain seed of each kind, and how many a course has; a task's lie `TERRAINS` times its slot above.
#: Training draws from one pool, the environments' own default, whatever the task.
POOLS = {"validation": (5_000, 8), "held-out": (10_000, 16), "public": (20_000, 8)}
TERRAINS = 100
#: Slots: as many as fit between two kinds.
SLOTS = 40
EPISODES = {"train": 4_096, "validation": 512, "held-out": 512}


@dataclass(frozen=True)
class Band:
    """What results are split by.

    Attributes:
        key: info at an episode's end.
        title: in tables, with unit.
        edges: ends of the bands, ascending; a value outside belongs to the nearest band.
    """

    key: str
    title: str
    edges: tuple[float, ...]

    def which(self, values: Floats) -> NDArray[np.int64]:
        """Index of the band of each value."""
        found: NDArray[np.int64] = np.clip(np.digitize(values, self.edges[1:-1]), 0, len(self.edges) - 2)
        return found


@dataclass(frozen=True)
class Row:
    """A task's courses.

    Attributes:
        task: short name, as in `discjump.envs.tasks.TASKS`.
        slot: 0 to 39, its own for ever: it keeps its seeds apart from other tasks'.
        placed: whether `reset` takes `start` and `goal`: else an episode of the public course is a terrain
            seed and an environment seed.
        band: what makes an episode easy or hard.
    """

    task: str
    slot: int
    placed: bool = True
    band: Band | None = None

    def __post_init__(self) -> None:
        """Check the slot."""
        if not 0 <= self.slot < SLOTS:
            raise ValueError(f"slot: expected 0 to {SLOTS - 1}, got {self.slot}")

    def pool(self, kind: str) -> tuple[int, ...]:
        """Terrain seeds of a kind of course."""
        if kind == "train":
            return TRAINING_SEEDS
        first, count = POOLS[kind]
        return tuple(range(first + TERRAINS * self.slot, first + TERRAINS * self.slot + count))

    def base_seed(self, kind: str) -> int:
        """Environment seed of episode 0 of a kind of course."""
        return FIRST[kind] + SLOT * self.slot

    def courses(self) -> list[Course]:
        """All but the public one."""
        return [
            Course(f"{self.task}-{kind}-v1", self.pool(kind), self.base_seed(kind), episodes, self.task)
            for kind, episodes in EPISODES.items()
        ]


ROWS = {
    one.task: one
    for one in (
        Row("ski", 0, band=Band("start_distance", "start distance, m", (300, 400, 500, 600, 700, 800))),
        Row(
            "disc-jump",
            1,
            False,
            Band("marker_height", "marker height, m", (100, 130, 160, 190, 220, 250, 280)),
        ),
        Row("route", 2, placed=False),
        Row("flag-run", 3, placed=False),
    )
}
"""By task."""


def row(task: str) -> Row:
    """The row of a task.

    Raises:
        TrainingError: there is none.
    """
    try:
        return ROWS[task]
    except KeyError:
        raise TrainingError(
            f"no courses are listed for the task {task!r}; there are {', '.join(ROWS)}"
        ) from None
