"""Options of the tasks between two flags."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from discjump import _check
from discjump.envs.options.base import REWARD, Level, TaskOptions, span

Place = tuple[float, float] | tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class RouteOptions(TaskOptions):
    """Keyword arguments of `discjump/Route-v0`.

    >>> RouteOptions().level("standard").from_stand
    True
    """

    GROUNDS: ClassVar[str] = "stands"
    REWARD: ClassVar[Mapping[str, float]] = REWARD | {"death": -5.0}
    CAPTURE: ClassVar[bool] = False
    """Whether the flag must be brought home."""
    LEVELS: ClassVar[Mapping[str, Level]] = {
        "easy": Level((80.0, 250.0), 0.0),
        "standard": Level((80.0, 800.0), 0.0, aside=2.0, from_stand=True),
        "hard": Level((250.0, 800.0), 25.0),
    }
    """What is drawn at each difficulty: distances are those of the start from the enemy flag."""

    arrival_radius: float = 2.5
    """Distance of the path of the feet to a flag's foot that counts as a touch, m."""

    time_limit: float = 60.0
    """Length of an episode, s; it ends truncated."""

    ammo: int = 15
    """Discs."""

    start_distance: tuple[float, float] | None = None
    """Least and largest distance from the start to the enemy flag, m, anywhere in the area. None: the
    difficulty's, which at `standard` is the own flag stand.
    """

    flags: Sequence[Place] | None = None
    """Where the two flags stand, (x, y) or (x, y, z) in m, on every terrain of the pool; without z on the
    ground. None: on the stands of each terrain's mission.
    """

    def __post_init__(self) -> None:
        """Check and normalise every field."""
        super().__post_init__()
        put = object.__setattr__
        put(self, "ammo", _check.integer("ammo", self.ammo, 0, 1_000_000))
        if self.start_distance is not None:
            put(self, "start_distance", span("start_distance", self.start_distance))
        if self.flags is not None:
            put(self, "flags", _flags(self.flags))

    def level(self, difficulty: str) -> Level:
        """The distribution of a difficulty, with what these options fix."""
        level = self.LEVELS[difficulty]
        if self.start_distance is not None:
            level = level._replace(goal_distance=self.start_distance, from_stand=False)
        return level if self.start_speed is None else level._replace(start_speed=self.start_speed)

    def extras(self) -> dict[str, Any]:
        """What the batch is told besides."""
        flags = None
        if self.flags is not None:
            flags = tuple(
                (flag[0], flag[1], flag[2] if len(flag) == 3 else float("nan")) for flag in self.flags
            )
        return {"capture": self.CAPTURE, "ammo": self.ammo, "flags": flags}


@dataclass(frozen=True, kw_only=True)
class FlagRunOptions(RouteOptions):
    """Keyword arguments of `discjump/FlagRun-v0`.

    >>> FlagRunOptions().time_limit
    120.0
    """

    CAPTURE: ClassVar[bool] = True

    time_limit: float = 120.0
    """Length of an episode, s; it ends truncated."""


def _flags(flags: object) -> tuple[Place, ...]:
    places = _check.sequence("flags", flags, "two places in m")
    if len(places) != 2:
        raise ValueError(f"flags: expected two places in m, got {len(places)}")
    checked: list[Place] = []
    for i, place in enumerate(places):
        numbers = _check.array(f"flags[{i}]", place, [(2,), (3,)], "m")
        checked.append(tuple(float(x) for x in numbers))  # type: ignore[arg-type]
    return tuple(checked)
