"""What the three front ends (single, vector, stable-baselines3) share: the batch, its spaces, its seeds."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from discjump import _check
from discjump._native import Terrain
from discjump.envs import placement
from discjump.envs.options import TaskOptions
from discjump.envs.render import Camera

Seeds = Sequence[int | None]
Result = TypeVar("Result")

SEEDED, OVER = 1, 2
"""Bits of a batch's flags."""


class ObservationField(NamedTuple):
    """One field of the flat observation."""

    name: str
    slice: slice
    unit: str
    scale: float
    """Value in `unit` = observation * scale. A field that is not linear has unit "" and scale 1."""


class TaskEnvs:
    """A batch of environments with its spaces.

    Args:
        options: of the task.
        num_envs: number of environments.
        autoreset: `next_step`, `same_step` or `disabled`.
        threads: that step the batch; None: one per core.
        lanes: players side by side in a register; None: as many as the processor has.
        render: record the paths that pictures show.
    """

    def __init__(
        self,
        options: TaskOptions,
        num_envs: int,
        *,
        autoreset: str,
        threads: int | None,
        lanes: int | None = None,
        render: bool = False,
    ) -> None:
        self._arguments: dict[str, Any] = {
            "options": options,
            "num_envs": num_envs,
            "autoreset": autoreset,
            "threads": threads,
            "lanes": lanes,
            "render": render,
        }
        self.options = options
        self.terrains: list[Terrain] = options.pool()
        self.terrain_seeds = [terrain.seed for terrain in self.terrains]
        self.batch = options.batch(num_envs, autoreset, threads, lanes)
        self.num_envs = num_envs
        self.autoreset = autoreset
        self.camera = Camera(self.batch, self.terrains, options.arrival_radius) if render else None
        """Watches the episodes where pictures are asked for; steps must go through `filmed` then."""

        size, clip = self.batch.observation_size, self.batch.observation_clip
        self.observation_space = spaces.Box(-clip, clip, (size,), np.float32)
        self.action_space: spaces.MultiDiscrete | spaces.Box
        if options.actions == "box":
            self.action_space = spaces.Box(-1.0, 1.0, (self.batch.action_size,), np.float32)
        else:
            self.action_space = spaces.MultiDiscrete(self.batch.action_bins)
        self.observation_layout = [
            ObservationField(name, slice(start, stop), unit, scale)
            for name, start, stop, unit, scale in self.batch.layout
        ]

    @property
    def seeded(self) -> NDArray[np.bool_]:
        """(num_envs,): reset at least once."""
        return (self.batch.flags() & SEEDED).astype(np.bool_)

    @property
    def over(self) -> NDArray[np.bool_]:
        """(num_envs,): the last step ended the episode."""
        return (self.batch.flags() & OVER).astype(np.bool_)

    def reset(
        self,
        seeds: Seeds | None,
        mask: NDArray[np.bool_] | None = None,
        options: Mapping[str, Any] | None = None,
        *,
        batched: bool = False,
    ) -> NDArray[np.float32]:
        """Start new episodes and return the observations of all environments, (num_envs, size) float32.

        Args:
            seeds: one per environment; None (in the list too): its next episode, or a seed from the
                operating system if it never had one.
            mask: (num_envs,), the environments to reset; None: all.
            options: see `placement.parse`.
            batched: `options` may hold one row per environment.
        """
        places = placement.parse(options, self.terrain_seeds, self.num_envs, batched=batched)._asdict()
        if seeds is None and not self.batch.fresh:
            observations = self.batch.reset(None, mask, **places)
        else:
            observations = self._reset_seeded(seeds, mask, places)
        if self.camera is not None:
            self.camera.restart(np.ones(self.num_envs, np.bool_) if mask is None else mask)
        return observations

    def _reset_seeded(
        self, seeds: Seeds | None, mask: NDArray[np.bool_] | None, places: dict[str, Any]
    ) -> NDArray[np.float32]:
        """Start new episodes, some of them with seeds of their own."""
        seeds = [None] * self.num_envs if seeds is None else seeds
        chosen = np.ones(self.num_envs, np.bool_) if mask is None else mask
        given = np.array([seed is not None for seed in seeds])
        values = np.array([seed or 0 for seed in seeds], np.uint64)
        fresh = chosen & ~given & ~self.seeded
        if fresh.any():
            values[fresh] = np.random.SeedSequence().generate_state(int(fresh.sum()), np.uint64)
        seeded, following = chosen & (given | fresh), chosen & ~given & ~fresh
        if not following.any():
            return self.batch.reset(values, seeded, **places)
        if not seeded.any():
            return self.batch.reset(None, following, **places)
        # Two calls must change all or nothing.
        before = self.batch.snapshot()
        try:
            self.batch.reset(values, seeded, **places)
            return self.batch.reset(None, following, **places)
        except BaseException:
            self.batch.restore(before)
            raise

    def filmed(self, step: Callable[[Any], Result], actions: object) -> Result:
        """What `step(actions)` gives, and a picture's worth of it remembered."""
        assert self.camera is not None
        before = self.over
        result = step(actions)
        if self.autoreset == "same_step":
            self.camera.advance(self.over)
        else:
            self.camera.advance(before if self.autoreset == "next_step" else np.zeros_like(before))
        return result

    def snapshot(self, index: int | None = None) -> bytes:
        """Every environment in the middle of its episode, or the one of that index, for `restore`."""
        return self.batch.snapshot(index if index is None else self._index(index))

    def restore(self, snapshot: bytes, index: int | None = None) -> None:
        """Put the batch back to a snapshot of itself, or of one with the same options; or one environment of
        it to where that, or another one, was.

        Raises:
            TypeError: `snapshot` is no bytes, `index` no integer.
            ValueError: it is damaged or belongs to other options or another number of environments, or there
                is no such environment; nothing has changed then.
        """
        if not isinstance(snapshot, bytes):
            raise TypeError(f"snapshot: expected bytes, got {type(snapshot).__name__}")
        index = index if index is None else self._index(index)
        self.batch.restore(snapshot, index)
        if self.camera is not None:
            changed = np.full(self.num_envs, index is None)
            changed[slice(None) if index is None else index] = True
            self.camera.restart(changed)

    def _index(self, index: object) -> int:
        return _check.integer("index", index, 0, self.num_envs - 1)

    def __getstate__(self) -> dict[str, Any]:
        """What makes it again, in this process or another: a copy goes on with the same bits."""
        return {
            "arguments": self._arguments,
            "snapshot": self.batch.snapshot(),
            "paths": None if self.camera is None else self.camera.paths,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        TaskEnvs.__init__(self, **state["arguments"])
        self.batch.restore(state["snapshot"])
        if self.camera is not None:
            self.camera.paths = state["paths"]

    def render(self, index: int = 0) -> NDArray[np.uint8]:
        """The command map of one environment, (height, width, 3) uint8."""
        if self.camera is None:
            raise ValueError("render_mode: expected 'rgb_array' for pictures, got None")
        return self.camera.picture(index)

    def terrain(self, index: int = 0) -> Terrain:
        """The terrain of one environment's episode."""
        return self.terrains[int(self.batch.terrain_index()[index])]


def seeds_of(seed: object, num_envs: int) -> Seeds | None:
    """Seeds of all environments: an int s means s, s + 1, ...; a list is taken as given; None (in the
    list too) is the next episode.

    Raises:
        TypeError: neither integer, sequence of integers and None, nor None.
        ValueError: wrong length, or a seed outside 0 to 2**64 - 1.

    >>> seeds_of(5, 3)
    [5, 6, 7]
    >>> seeds_of([1, None], 3)
    Traceback (most recent call last):
    ValueError: seed: expected 3 seeds, one per environment, got 2
    """
    if seed is None:
        return None
    if isinstance(seed, (Sequence, np.ndarray)) and not isinstance(seed, (str, bytes)):
        if len(seed) != num_envs:
            raise ValueError(f"seed: expected {num_envs} seeds, one per environment, got {len(seed)}")
        return [
            None if one is None else _check.integer(f"seed[{i}]", one, 0, _check.SEEDS - 1)
            for i, one in enumerate(seed)
        ]
    first = _check.integer("seed", seed, 0, _check.SEEDS - num_envs)
    return list(range(first, first + num_envs))
