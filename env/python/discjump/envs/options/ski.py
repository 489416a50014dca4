"""Options of the ski task."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from discjump.envs.options.base import Level, TaskOptions, span


@dataclass(frozen=True, kw_only=True)
class SkiOptions(TaskOptions):
    """Keyword arguments of `discjump/Ski-v0`.

    >>> SkiOptions(frame_skip=2).decision_seconds
    0.064
    >>> SkiOptions(difficulty="easy").level("easy").goal_distance
    (100.0, 300.0)
    >>> SkiOptions(time_limit=-1)
    Traceback (most recent call last):
    ValueError: time_limit: expected a number in (0, 3600] s, got -1
    """

    GROUNDS: ClassVar[str] = "beacon"
    LEVELS: ClassVar[Mapping[str, Level]] = {
        "easy": Level((100.0, 300.0), 10.0),
        "standard": Level((300.0, 800.0), 10.0),
        "hard": Level((600.0, 1000.0), 25.0),
    }
    """What is drawn at each difficulty."""

    goal_distance: tuple[float, float] | None = None
    """Least and largest horizontal distance from start to beacon when they are drawn, m. None: the
    difficulty's.
    """

    def __post_init__(self) -> None:
        """Check and normalise every field."""
        super().__post_init__()
        if self.goal_distance is not None:
            object.__setattr__(self, "goal_distance", span("goal_distance", self.goal_distance))

    def level(self, difficulty: str) -> Level:
        """The distribution of a difficulty, with what these options fix."""
        level = self.LEVELS[difficulty]
        if self.goal_distance is not None:
            level = level._replace(goal_distance=self.goal_distance)
        return level if self.start_speed is None else level._replace(start_speed=self.start_speed)
