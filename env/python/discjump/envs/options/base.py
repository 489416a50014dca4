"""Options that every task has, in one typed place."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from discjump import _check
from discjump._native import TaskBatch, Terrain
from discjump.simulator import ARMORS, FIDELITIES, Physics
from discjump.terrains import SURFACES, TRAINING_SEEDS, checked_seeds, pool

REWARD = {"progress": 0.02, "time": -0.15625, "arrival": 5.0, "death": 0.0, "climb": 0.0}
"""Default weights: per metre nearer to the goal, per second, once on arrival, once on
death; and how many metres of distance
a metre of height counts that the player's flight will lack, for goals in the air."""

FAN_BEARINGS = (0.0, 30.0, -30.0)
"""Default bearings of the fan, degrees, 0 ahead, positive left: the fewest that lose nothing.

The fan is the rise of the terrain over range: its height there, over the ground below the player, divided by
the range (dimensionless)."""

FAN_RANGES = (10.0, 25.0, 50.0, 90.0)
"""Default ranges of the fan, m."""

ACTIONS = ("multi_discrete", "box")
DIFFICULTIES = ("easy", "standard", "hard")


SIGHT = ("fan_bearings", "fan_ranges", "landing", "jet_landings")
"""Options that change what an agent sees, and nothing else."""


class Level(NamedTuple):
    """A distribution that episodes are drawn from."""

    goal_distance: tuple[float, float]
    """Least and largest distance of the goal, m: on the map, of a marker the height over the ground."""
    start_speed: float
    """Largest speed at the start, m/s."""
    start_height: float = 0.0
    """Largest height of the start over the ground, m."""
    aside: float = 0.0
    """Largest distance on the map of a marker from the start, or of a start from the own flag stand, m."""
    from_stand: bool = False
    """The start is at the player's own flag stand."""


@dataclass(frozen=True, kw_only=True)
class TaskOptions:
    """Keyword arguments of an environment, checked and normalised when made. A task's own class adds to them.

    Raises:
        TypeError: an argument of the wrong type, or an unknown one (through `from_keywords`).
        ValueError: an argument out of its range; the message names it, what was expected and what came.
    """

    GROUNDS: ClassVar[str]
    """What kind of goal there is: `beacon`, `marker` or `stands`."""
    REWARD: ClassVar[Mapping[str, float]] = REWARD
    """Default weights of the reward."""

    terrain_seeds: Sequence[int] = TRAINING_SEEDS
    """Seeds of the generated terrains that episodes draw from; 16 by default."""

    repeating: bool = False
    """Generated terrains repeat a cell of 512 m instead of 2,048 m."""

    terrains: Sequence[Terrain] | None = None
    """Terrains to draw from in place of generated ones, all of one size and surface."""

    surface: str | None = None
    """What lies between the heights of generated terrains: `triangles` (the default) or `bilinear`. Given
    `terrains` have their own; read, this is theirs.
    """

    fidelity: str = "authentic"
    """Fidelity tier: `reference` (float64), or in float32 `authentic`, `swept`, `fast` or `engine`."""

    armor: str = "light"
    """Armor of the player."""

    energy_pack: bool = False
    """The player wears an energy pack."""

    physics: Physics = field(default_factory=Physics)
    """Switches of the movement model."""

    tick_ms: int = 32
    """Length of a tick, milliseconds."""

    frame_skip: int = 4
    """Ticks per decision, 1 to 64."""

    actions: str = "multi_discrete"
    """`multi_discrete` (bins) or `box` (float32 in [-1, 1])."""

    turn_rate: float = 2.34375
    """Largest turn rate, rad/s."""

    time_limit: float = 60.0
    """Length of an episode, s; it ends truncated."""

    arrival_radius: float = 8.0
    """Distance of the path to the goal that counts as arrival, m: to a beacon horizontal, to a goal in the
    air or on a stand in space, from the player's feet.
    """

    difficulty: str = "standard"
    """Where starts and goals are drawn from: `easy`, `standard` or `hard`; see the task's `LEVELS`. An option
    that fixes one of these itself goes before it.
    """

    curriculum: bool = False
    """Each environment begins `easy`, goes up to the next difficulty after 3 successes in a row, and down
    after 3 failures. `difficulty` is not asked for then.
    """

    start_speed: float | None = None
    """Largest speed at the start, m/s; 0: always at rest. None: the difficulty's."""

    reward: Mapping[str, float] = field(default_factory=dict)
    """Weights that differ from the task's `REWARD`: `progress` (per m), `time` (per s), `arrival`, `death`,
    `climb` (see `discjump.envs.options.REWARD`).
    """

    fan_bearings: Sequence[float] | NDArray[np.float64] = FAN_BEARINGS
    """Bearings of the fan (rise of the terrain over range, dimensionless), degrees, 0 ahead, positive left;
    empty: no fan.
    """

    fan_ranges: Sequence[float] | NDArray[np.float64] = FAN_RANGES
    """Ranges of the fan, m; empty: no fan."""

    landing: bool = True
    """Observe features of the ballistic landing."""
    jet_landings: bool = False
    """Observe features of the landings that jets lead to: after a burst of half a second up, after burning
    all the energy, and after bursts to the left and to the right."""

    def __post_init__(self) -> None:
        """Check and normalise every field."""
        put = object.__setattr__
        put(self, "terrain_seeds", checked_seeds(self.terrain_seeds))
        put(self, "repeating", _check.flag("repeating", self.repeating))
        put(self, "terrains", _terrains(self.terrains))
        put(self, "surface", _surface(self.surface, self.terrains))
        put(self, "energy_pack", _check.flag("energy_pack", self.energy_pack))
        if not isinstance(self.physics, Physics):
            raise TypeError(f"physics: expected a discjump.Physics, got {self.physics!r}")
        put(self, "frame_skip", _check.integer("frame_skip", self.frame_skip, 1, 64))
        put(self, "tick_ms", _check.integer("tick_ms", self.tick_ms, 1, 1000))
        _check.choice("fidelity", self.fidelity, FIDELITIES)
        _check.choice("armor", self.armor, ARMORS)
        _check.choice("actions", self.actions, ACTIONS)
        put(self, "turn_rate", _check.real("turn_rate", self.turn_rate, 0, 100, "rad/s", open_low=True))
        put(self, "time_limit", _check.real("time_limit", self.time_limit, 0, 3600, "s", open_low=True))
        radius = _check.real("arrival_radius", self.arrival_radius, 0, 1000, "m", open_low=True)
        put(self, "arrival_radius", radius)
        _check.choice("difficulty", self.difficulty, DIFFICULTIES)
        put(self, "curriculum", _check.flag("curriculum", self.curriculum))
        if self.start_speed is not None:
            put(self, "start_speed", _check.real("start_speed", self.start_speed, 0, 100, "m/s"))
        put(self, "reward", _reward(self.reward, self.REWARD))
        put(self, "fan_bearings", _fan("fan_bearings", self.fan_bearings, -180, 180, "degrees"))
        put(self, "fan_ranges", _fan("fan_ranges", self.fan_ranges, 1, 2000, "m"))
        put(self, "landing", _check.flag("landing", self.landing))
        put(self, "jet_landings", _check.flag("jet_landings", self.jet_landings))

    @classmethod
    def from_keywords(cls, keywords: Mapping[str, Any]) -> Self:
        """Options from keyword arguments; an unknown one raises a TypeError that lists the known ones.

        >>> from discjump.envs.options import SkiOptions
        >>> SkiOptions.from_keywords({"frameskip": 2})
        Traceback (most recent call last):
        TypeError: frameskip: expected one of the options terrain_seeds, ..., got an unknown one; did you mean
            'frame_skip'?
        """
        names = [f.name for f in fields(cls)]
        for key in keywords:
            if key not in names:
                raise TypeError(
                    f"{key}: expected one of the options {', '.join(names)}, got an unknown one"
                    f"{_check.nearest(key, names)}"
                )
        return cls(**keywords)

    @property
    def decision_seconds(self) -> float:
        """Time between two decisions, s."""
        return self.tick_ms * self.frame_skip / 1000

    def level(self, difficulty: str) -> Level:
        """The distribution of a difficulty, with what these options fix."""
        raise NotImplementedError

    def levels(self) -> list[Level]:
        """The distributions that episodes go through."""
        return [self.level(name) for name in (DIFFICULTIES if self.curriculum else (self.difficulty,))]

    def extras(self) -> dict[str, Any]:
        """What the batch is told besides: `capture`, `ammo`, `flags`."""
        return {"capture": False, "ammo": 0, "flags": None}

    def pool(self) -> list[Terrain]:
        """The terrains that episodes draw from."""
        if self.terrains is not None:
            return list(self.terrains)
        return pool(self.terrain_seeds, self.repeating, self.surface or SURFACES[0])

    def batch(
        self, num_envs: int, autoreset: str, threads: int | None, lanes: int | None = None
    ) -> TaskBatch:
        """The simulator of `num_envs` environments.

        Args:
            num_envs: at least 1.
            autoreset: `next_step`, `same_step` or `disabled`.
            threads: threads that step the batch, 1 to 256; None: one per core.
            lanes: players side by side in a register, one of the widths that the processor has; None: the
                environment variable `DISCJUMP_LANES` says, else the processor.
        """
        if threads is not None:
            threads = _check.integer("threads", threads, 1, 256)
        if lanes is not None:
            lanes = _check.integer("lanes", lanes, 1, 32)
        return TaskBatch(
            self.pool(),
            _check.integer("num_envs", num_envs, 1, 2**24),
            grounds=self.GROUNDS,
            fidelity=self.fidelity,
            armor=self.armor,
            energy_pack=self.energy_pack,
            physics=self.physics,
            tick_ms=self.tick_ms,
            frame_skip=self.frame_skip,
            actions=self.actions,
            turn_rate=self.turn_rate,
            time_limit=self.time_limit,
            arrival_radius=self.arrival_radius,
            levels=self.levels(),
            reward=(
                self.reward["progress"],
                self.reward["time"],
                self.reward["arrival"],
                self.reward["death"],
                self.reward["climb"],
            ),
            **self.extras(),
            fan_bearings=list(self.fan_bearings),
            fan_ranges=list(self.fan_ranges),
            landing=self.landing,
            jet_landings=self.jet_landings,
            autoreset=autoreset,
            threads=threads,
            lanes=lanes,
        )


def _reward(weights: object, defaults: Mapping[str, float]) -> dict[str, float]:
    if not isinstance(weights, Mapping):
        raise TypeError(f"reward: expected a mapping of weights, got {weights!r}")
    _check.known("reward", weights, REWARD)
    checked = {
        name: _check.real(f"reward[{name!r}]", weight, -1e6, 1e6, "") for name, weight in weights.items()
    }
    return {**defaults, **checked}


def _terrains(terrains: object) -> tuple[Terrain, ...] | None:
    if terrains is None:
        return None
    checked = _check.sequence("terrains", terrains, "Terrain")
    for i, terrain in enumerate(checked):
        if not isinstance(terrain, Terrain):
            raise TypeError(
                f"terrains[{i}]: expected a Terrain, got {terrain!r} of type {type(terrain).__name__}"
            )
    if not checked:
        raise ValueError("terrains: expected at least one Terrain, got none")
    return tuple(checked)


def _surface(surface: str | None, terrains: Sequence[Terrain] | None) -> str:
    if surface is not None:
        _check.choice("surface", surface, SURFACES)
    if terrains is None:
        return surface or SURFACES[0]
    first = terrains[0].surface
    for i, terrain in enumerate(terrains):
        if terrain.surface != first:
            raise ValueError(
                f"terrains[{i}]: expected surface {first!r} like terrains[0], got {terrain.surface!r}"
            )
    if surface not in (None, first):
        raise ValueError(f"surface: expected {first!r}, which the given terrains have, got {surface!r}")
    return first


def span(name: str, ends: object) -> tuple[float, float]:
    """Two numbers of metres, least and largest, checked."""
    checked = _check.sequence(name, ends, "two numbers in m")
    if len(checked) != 2:
        raise ValueError(f"{name}: expected two numbers in m, got {len(checked)}")
    low, high = (_check.real(f"{name}[{i}]", end, 0, 1e6, "m") for i, end in enumerate(checked))
    if low > high:
        raise ValueError(f"{name}: expected least <= largest, got ({low:g}, {high:g})")
    return low, high


def _fan(name: str, values: object, low: float, high: float, unit: str) -> tuple[float, ...]:
    numbers = _check.sequence(name, values, f"numbers in {unit}")
    return tuple(_check.real(f"{name}[{i}]", value, low, high, unit) for i, value in enumerate(numbers))
