"""What policies meet that they were not trained in."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from discjump import Terrain
from discjump.envs.tasks import TASKS
from discjump_training.courses import Course
from discjump_training.policy import Floats

#: Terrain seeds that no course draws from.
OTHER_SEEDS = tuple(range(1_000_000, 1_000_016))
#: On a heightfield of the user's there is no base and no bridge.
BARE = ("ski", "disc-jump")


@dataclass(frozen=True)
class Condition:
    """One of them.

    Attributes:
        name: in the table.
        changes: options of the environment.
        noise: standard deviation of what is added to every number that a policy observes.
        ground: makes the terrains from the course's own; None: those themselves.
        tasks: where it is met.
    """

    name: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    noise: float = 0.0
    ground: Callable[[Terrain], Terrain] | None = None
    tasks: tuple[str, ...] = tuple(TASKS)

    def options(self, course: Course) -> dict[str, Any]:
        """Options of the environment on that course."""
        usual = TASKS[course.task].options
        changes = dict(self.changes)
        if "tick_ms" in changes:
            # As many seconds between two decisions.
            changes["frame_skip"] = max(1, usual.frame_skip * usual.tick_ms // changes["tick_ms"])
        if self.ground is not None:
            grounds = [self.ground(Terrain.raindance(seed)) for seed in course.terrain_seeds]
            changes |= {"terrains": grounds, "surface": None}
        return changes


def steeper(terrain: Terrain) -> Terrain:
    """The same hills, half as high again about their mean."""
    heights = _heights(terrain)
    return _ground(terrain, heights.mean() + 1.5 * (heights - heights.mean()))


def rougher(terrain: Terrain) -> Terrain:
    """The same hills, with the map itself on them once more, at a quarter of its size in all three
    directions: as steep, and four times as frequent.
    """
    heights = _heights(terrain)
    count = heights.shape[0]
    index = (4 * np.arange(count)) % (count - 1)
    small = heights[np.ix_(index, index)]
    return _ground(terrain, heights + 0.25 * (small - small.mean()))


def waves(terrain: Terrain) -> Terrain:
    """No hills of ours: two crossing swells, an eighth and a sixth of the map long, 24 m high each."""
    count = _heights(terrain).shape[0]
    along = 2.0 * np.pi * np.arange(count) / (count - 1)
    swell = 12.0 * (np.sin(8.0 * along)[:, None] + np.sin(6.0 * along)[None, :])
    return _ground(terrain, 100.0 + swell)


def _heights(terrain: Terrain) -> Floats:
    return np.asarray(terrain.heights, np.float64)


def _ground(terrain: Terrain, heights: Floats) -> Terrain:
    return Terrain.from_heights(heights.astype(np.float32), square_size=terrain.square_size)


CONDITIONS = (
    Condition("as trained"),
    Condition("other terrain seeds", {"terrain_seeds": list(OTHER_SEEDS)}),
    Condition("steeper: heights x 1.5", ground=steeper, tasks=BARE),
    Condition("rougher: a quarter-size relief on top", ground=rougher, tasks=BARE),
    Condition("a heightfield of the user's: swells", ground=waves, tasks=BARE),
    Condition("easy", {"difficulty": "easy"}),
    Condition("hard", {"difficulty": "hard"}),
    Condition("medium armor", {"armor": "medium"}),
    Condition("heavy armor", {"armor": "heavy"}),
    Condition("noise 0.02 on observations", noise=0.02),
    Condition("noise 0.05 on observations", noise=0.05),
    Condition("noise 0.1 on observations", noise=0.1),
    Condition("tier reference", {"fidelity": "reference"}),
    Condition("tier swept", {"fidelity": "swept"}),
    Condition("tier fast", {"fidelity": "fast"}),
    Condition("tier engine", {"fidelity": "engine"}),
    Condition("ticks of 64 ms", {"tick_ms": 64}),
)
