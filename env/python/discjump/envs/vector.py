"""Many environments of any task, stepped together in Rust."""

from typing import Any, ClassVar, NoReturn

import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.envs.callables import Callables, ObservationFn, RewardFn
from discjump.envs.observations import ObservationField
from discjump.envs.options import TaskOptions
from discjump.envs.single import RENDER_MODES, checked_render_mode
from discjump.envs.task import TaskEnvs, seeds_of

AUTORESET = {
    AutoresetMode.NEXT_STEP: "next_step",
    AutoresetMode.SAME_STEP: "same_step",
    AutoresetMode.DISABLED: "disabled",
}

Step = tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]


class TaskVectorEnv(VectorEnv[NDArray[np.float32], NDArray[Any], NDArray[Any]]):
    """Environments that behave, bit for bit, as gymnasium's `SyncVectorEnv` over as many single ones of the
    task.

    An environment with seed s gives the same bits at any index, among any number of others, on any number of
    threads. What `reset` and `step` return never changes afterwards: a buffer is used again only when nobody
    holds it any more.

    Args:
        num_envs: number of environments.
        autoreset_mode: `AutoresetMode` or its value. `NEXT_STEP` (default): the step after an episode's end
            ignores the action and returns the next episode's first observation with reward 0. `SAME_STEP`:
            the step that ends an episode returns it already, and `info["final_obs"]`, `info["final_info"]`
            hold what was last. `DISABLED`: reset by hand with `options={"reset_mask": ...}`.
        threads: threads that step the batch; None: one per core.
        lanes: most players side by side: 1, 8, 16 or 32, as far as the processor has them; None: the
            environment variable `DISCJUMP_LANES` says, else the processor. No bit depends on it.
        render_mode: None or `rgb_array`, the command maps.
        observation_fn, reward_fn, observation_space: what replaces observation and reward, see
            `discjump.envs.callables`.
        **options: fields of the task's options.

    Raises:
        TypeError, ValueError: naming the option, what was expected and what came.
    """

    OPTIONS: ClassVar[type[TaskOptions]]

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": list(RENDER_MODES),
        "render_fps": 7.8125,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        lanes: int | None = None,
        render_mode: str | None = None,
        observation_fn: ObservationFn | None = None,
        reward_fn: RewardFn | None = None,
        observation_space: spaces.Box | None = None,
        **options: Any,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode)
        self.autoreset_mode = _checked_autoreset_mode(autoreset_mode)
        self.options = self.OPTIONS.from_keywords(options)
        self.metadata = {  # type: ignore[misc]
            **type(self).metadata,
            "render_fps": 1 / self.options.decision_seconds,
            "autoreset_mode": self.autoreset_mode,
        }
        self._task = TaskEnvs(
            self.options,
            num_envs,
            autoreset=AUTORESET[self.autoreset_mode],
            threads=threads,
            lanes=lanes,
            render=self.render_mode is not None,
            callables=Callables(observation_fn, reward_fn, observation_space),
        )
        self.num_envs = num_envs
        self.single_observation_space = self._task.observation_space
        self.single_action_space = self._task.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    @property
    def observation_layout(self) -> list[ObservationField]:
        """Fields of one of the task's own observations in their order."""
        return self._task.observation_layout

    @property
    def terrains(self) -> list[Terrain]:
        """The pool that episodes draw from."""
        return self._task.terrains

    @property
    def terrain_index(self) -> NDArray[np.int64]:
        """(num_envs,): which terrain of the pool each episode runs on."""
        return self._task.batch.terrain_index()

    def state(self) -> NDArray[np.void]:
        """The players, (num_envs,), a copy: position (m), velocity (m/s), yaw (rad), energy and so on."""
        return self._task.batch.state()

    def goals(self) -> NDArray[np.float64]:
        """The goals, (num_envs, 3), m: beacons on the ground, markers in the air, flags on their stands."""
        return self._task.batch.goals()

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Start episodes.

        Args:
            seed: an int s gives environment i the seed s + i; a list one each; None (in the list too): its
                next episode, or a seed from the operating system if it never had one.
            options: `start`, `goal`, `terrain_seed` as for one environment, or one row each: (num_envs, 2)
                and so on, where a row of NaN is drawn; `reset_mask`, (num_envs,) bool with at least one True:
                only these are reset.

        Returns:
            Observations of all environments, (num_envs, size) float32, and info; its `_key` masks say which
            were reset.
        """
        mask = _checked_mask(options, self.num_envs)
        observations = self._task.reset(seeds_of(seed, self.num_envs), mask, options, batched=True)
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
        return observations, self._task.batch.info(mask)

    def step(self, actions: NDArray[Any]) -> Step:
        """One decision of every environment.

        Args:
            actions: (num_envs, 5) or, with a launcher, (num_envs, 7), integer (float32 with `actions="box"`).

        Returns:
            Observations (num_envs, size) float32, rewards (num_envs,) float64, terminations and truncations
            (num_envs,) bool, info: columns as in `discjump.envs.infos` with gymnasium's `_key` masks. Masks
            that are true everywhere are one array, which is read-only.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset; with `DISABLED`, while an episode that ended
            was not reset. TypeError, ValueError: the actions have another dtype or shape, or are out of
            range; nothing has changed then.
        """
        task = self._task
        batch = task.batch
        if batch.halted:
            self._refuse()
        return batch.step(actions) if task.plain else task.step(actions)

    def snapshot(self, index: int | None = None) -> bytes:
        """Every environment in the middle of its episode, or the one of that index, for `restore`."""
        return self._task.snapshot(index)

    def restore(self, snapshot: bytes, index: int | None = None) -> None:
        """Go back to a snapshot of this object or of one with the same options, whatever its autoreset mode,
        threads or lanes; with an index put one environment to where it, or any other one, was.

        Raises:
            TypeError: `snapshot` is no bytes, `index` no integer.
            ValueError: it is damaged or belongs to other options or another number of environments, or there
                is no such environment; nothing has changed then.
        """
        self._task.restore(snapshot, index)

    def _refuse(self) -> NoReturn:
        """Say why no step can be taken."""
        if self._task.batch.fresh:
            raise ResetNeeded("step: expected a call of reset() of every environment first")
        ended = np.flatnonzero(self._task.over)
        raise ResetNeeded(
            f"step: expected a reset of the {len(ended)} environments whose episode ended first "
            f"(the first of them is {ended[0]})"
        )

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """The command map of every environment, each (height, width, 3) uint8; None without `render_mode`."""
        if self.render_mode is None:
            return None
        return tuple(self._task.render(index) for index in range(self.num_envs))


def _checked_autoreset_mode(mode: object) -> AutoresetMode:
    try:
        return AutoresetMode(mode)
    except ValueError:
        values = ", ".join(repr(known.value) for known in AutoresetMode)
        raise ValueError(
            f"autoreset_mode: expected an AutoresetMode or one of {values}, got {mode!r}"
        ) from None


def _checked_mask(options: object, num_envs: int) -> NDArray[np.bool_] | None:
    """`options["reset_mask"]`; it stays in `options`, for wrappers read it after us."""
    if not isinstance(options, dict) or options.get("reset_mask") is None:
        return None
    mask = options["reset_mask"]
    name = "options['reset_mask']"
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
        got = mask.dtype if isinstance(mask, np.ndarray) else type(mask).__name__
        raise TypeError(f"{name}: expected a bool array of shape ({num_envs},), got {got}")
    if mask.shape != (num_envs,):
        raise ValueError(f"{name}: expected a bool array of shape ({num_envs},), got shape {mask.shape}")
    if not mask.any():
        raise ValueError(f"{name}: expected at least one True, got none")
    return mask
