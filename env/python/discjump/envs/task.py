"""What the three front ends (single, vector, stable-baselines3) share: the batch, its spaces, its seeds."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from discjump import _check
from discjump._native import Terrain
from discjump.envs import placement
from discjump.envs.callables import Callables, Checked
from discjump.envs.observations import ObservationField
from discjump.envs.options import TaskOptions
from discjump.envs.render import Camera
from discjump.envs.replaced import Native, One, Replaced, Step, unpacked

Seeds = Sequence[int | None]
Result = TypeVar("Result")

SEEDED, OVER = 1, 2
"""Bits of a batch's flags."""


class TaskEnvs:
    """A batch of environments with its spaces.

    Args:
        options: of the task.
        num_envs: number of environments.
        autoreset: `next_step`, `same_step` or `disabled`.
        threads: that step the batch; None: one per core.
        lanes: players side by side in a register; None: as many as the processor has.
        render: record the paths that pictures show.
        callables: what replaces observation and reward.

    Attributes:
        plain: nothing is done beside the batch's own step.
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
        callables: Callables | None = None,
    ) -> None:
        self._arguments: dict[str, Any] = {
            "options": options,
            "num_envs": num_envs,
            "autoreset": autoreset,
            "threads": threads,
            "lanes": lanes,
            "render": render,
            "callables": callables,
        }
        self.options = options
        self.terrains: list[Terrain] = options.pool()
        self.terrain_seeds = [terrain.seed for terrain in self.terrains]
        self.batch = options.batch(num_envs, autoreset, threads, lanes)
        self.num_envs = num_envs
        self.autoreset = autoreset
        self.camera = Camera(self.batch, self.terrains, options.arrival_radius) if render else None
        """Watches the episodes where pictures are asked for."""

        size, clip = self.batch.observation_size, self.batch.observation_clip
        self.observation_space: spaces.Box = spaces.Box(-clip, clip, (size,), np.float32)
        self.action_space: spaces.MultiDiscrete | spaces.Box
        if options.actions == "box":
            self.action_space = spaces.Box(-1.0, 1.0, (self.batch.action_size,), np.float32)
        else:
            self.action_space = spaces.MultiDiscrete(self.batch.action_bins)
        self.observation_layout = [
            ObservationField(name, slice(start, stop), unit, scale)
            for name, start, stop, unit, scale in self.batch.layout
        ]
        self._replaced = self._replacing(callables) if callables else None
        self.plain = self.camera is None and self._replaced is None

    def _replacing(self, callables: Callables) -> Replaced:
        action = np.zeros(self.action_space.shape, self.action_space.dtype)
        size = self.batch.observation_size
        checked = Checked(callables, self.observation_layout, size, action, self.num_envs)
        self.observation_space = checked.space or self.observation_space
        return Replaced(checked, self.batch, self.autoreset)

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
    ) -> NDArray[Any]:
        """Start new episodes and return the observations of all environments, (num_envs, size) float32, or
        what replaces them.

        Args:
            seeds: one per environment; None (in the list too): its next episode, or a seed from the
                operating system if it never had one.
            mask: (num_envs,), the environments to reset; None: all.
            options: see `placement.parse`.
            batched: `options` may hold one row per environment.
        """
        places = placement.parse(
            options, self.terrain_seeds, self.num_envs, batched=batched, grounds=self.options.GROUNDS
        )._asdict()
        if seeds is None and not self.batch.fresh:
            observations = self.batch.reset(None, mask, **places)
        else:
            observations = self._reset_seeded(seeds, mask, places)
        if self.camera is not None:
            self.camera.restart(np.ones(self.num_envs, np.bool_) if mask is None else mask)
        return observations if self._replaced is None else self._replaced.reset(observations, mask)

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

    def step(self, actions: object) -> Step:
        """The batch's `step`, filmed and replaced as far as that was asked for."""
        play = partial(self._filmed, self.batch.step)
        return play(actions) if self._replaced is None else self._replaced.step(play, actions)

    def step_one(self, action: NDArray[Any]) -> One:
        """The same of the batch's `step_one`."""
        play = partial(self._filmed, self.batch.step_one)
        return play(action) if self._replaced is None else self._replaced.step_one(play, action)

    def step_dones(
        self, actions: object
    ) -> tuple[NDArray[Any], NDArray[np.float32], NDArray[np.bool_], bool]:
        """The same of the batch's `step_dones`."""
        if self._replaced is None:
            return self._filmed(self.batch.step_dones, actions)
        observations, rewards, terminated, truncated, _ = self.step(actions)
        dones = terminated | truncated
        return observations, rewards.astype(np.float32), dones, bool(dones.any())

    def final_observations(self) -> NDArray[Any]:
        """Last observations of the episodes that the last step ended, where the next ones have begun."""
        return self.batch.final_observations() if self._replaced is None else self._replaced.finals

    def final_infos(self) -> list[dict[str, Any]]:
        """Their last infos."""
        infos = self.batch.final_infos()
        if self._replaced is None:
            return infos
        return self._replaced.infos_with_returns(infos, self.batch.finished())

    @property
    def native(self) -> Native | None:
        """The task's own results of the last call, where they are replaced."""
        return None if self._replaced is None else self._replaced.native

    def _filmed(self, step: Callable[[Any], Result], actions: Any) -> Result:
        """What `step(actions)` gives, and a picture's worth of it remembered where that is asked for."""
        if self.camera is None:
            return step(actions)
        before = self.over
        result = step(actions)
        if self.autoreset == "same_step":
            self.camera.advance(self.over)
        else:
            self.camera.advance(before if self.autoreset == "next_step" else np.zeros_like(before))
        return result

    def snapshot(self, index: int | None = None) -> bytes:
        """Every environment in the middle of its episode, or the one of that index, for `restore`."""
        index = index if index is None else self._index(index)
        snapshot = self.batch.snapshot(index)
        return snapshot if self._replaced is None else self._replaced.packed(snapshot, index)

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
        own, sums = unpacked(snapshot, self.num_envs if index is None else 1)
        self.batch.restore(own, index)
        if self._replaced is not None:
            self._replaced.restored(sums, index)
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
            "snapshot": self.snapshot(),
            "paths": None if self.camera is None else self.camera.paths,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        TaskEnvs.__init__(self, **state["arguments"])
        self.restore(state["snapshot"])
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
