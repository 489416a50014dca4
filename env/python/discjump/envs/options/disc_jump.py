"""Options of the disc-jump task."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from discjump import _check
from discjump.envs.options.base import REWARD, Level, TaskOptions, span

HEIGHTS: Mapping[str, tuple[float, float]] = {
    "light": (108.0, 268.0),
    "medium": (82.0, 206.0),
    "heavy": (60.0, 146.0),
}
"""Of each armor, from level ground, on a full tank, m: 8 m more than jump and jets alone lead the feet to,
and what the best disc jump reaches whose jets are lit with the jump or after it: searched through the tick of
the shot, the tick at which the jets are lit and the aim (`discjump_training.bounds`)."""


@dataclass(frozen=True, kw_only=True)
class DiscJumpOptions(TaskOptions):
    """Keyword arguments of `discjump/DiscJump-v0`.

    >>> DiscJumpOptions(marker_height=(60, 80)).level("standard").goal_distance
    (60.0, 80.0)
    """

    GROUNDS: ClassVar[str] = "marker"
    REWARD: ClassVar[Mapping[str, float]] = REWARD | {"time": 0.0, "death": -1.0, "climb": 1.0}
    SPANS: ClassVar[Mapping[str, tuple[float, float]]] = {
        "easy": (0.0, 0.4),
        "standard": (0.0, 1.0),
        "hard": (0.6, 1.0),
    }
    """Part of the way between the armor's two `HEIGHTS` that markers are drawn from at each difficulty."""
    LEVELS: ClassVar[Mapping[str, Level]] = {
        "easy": Level((0.0, 0.0), 0.0, 0.0, 5.0),
        "standard": Level((0.0, 0.0), 10.0, 10.0, 20.0),
        "hard": Level((0.0, 0.0), 20.0, 20.0, 30.0),
    }
    """What else is drawn at each difficulty."""

    frame_skip: int = 2
    """Ticks per decision, 1 to 64. The best moment of a disc jump lasts some 3 ticks."""

    time_limit: float = 16.0
    """Length of an episode, s; it ends truncated."""

    ammo: int = 3
    """Discs."""

    marker_height: tuple[float, float] | None = None
    """Least and largest height of the marker over the ground at the start, m. None: by armor and
    difficulty.
    """

    marker_offset: float | None = None
    """Largest horizontal distance of the marker from the start, m. None: the difficulty's."""

    start_height: float | None = None
    """Largest height of the start over the ground, m; half of the episodes begin on it. None: the
    difficulty's.
    """

    def __post_init__(self) -> None:
        """Check and normalise every field."""
        super().__post_init__()
        put = object.__setattr__
        put(self, "ammo", _check.integer("ammo", self.ammo, 0, 1_000_000))
        if self.marker_height is not None:
            put(self, "marker_height", span("marker_height", self.marker_height))
        if self.marker_offset is not None:
            put(self, "marker_offset", _check.real("marker_offset", self.marker_offset, 0, 1e6, "m"))
        if self.start_height is not None:
            put(self, "start_height", _check.real("start_height", self.start_height, 0, 1000, "m"))

    def level(self, difficulty: str) -> Level:
        """The distribution of a difficulty, with what these options fix."""
        level = self.LEVELS[difficulty]
        low, high = HEIGHTS[self.armor]
        from_, to = self.SPANS[difficulty]
        heights = self.marker_height or (low + from_ * (high - low), low + to * (high - low))
        return level._replace(
            goal_distance=heights,
            start_speed=level.start_speed if self.start_speed is None else self.start_speed,
            start_height=level.start_height if self.start_height is None else self.start_height,
            aside=level.aside if self.marker_offset is None else self.marker_offset,
        )

    def extras(self) -> dict[str, Any]:
        """What the batch is told besides."""
        return {**super().extras(), "ammo": self.ammo}
