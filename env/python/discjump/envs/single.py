"""One environment of any task."""

from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.envs.callables import Callables, ObservationFn, RewardFn
from discjump.envs.observations import ObservationField
from discjump.envs.options import TaskOptions
from discjump.envs.task import TaskEnvs, seeds_of

RENDER_MODES = ("rgb_array",)


def checked_render_mode(mode: object) -> str | None:
    """`mode` if it is one of the render modes or None; a ValueError else."""
    if mode is None:
        return None
    if mode not in RENDER_MODES:
        raise ValueError(f"render_mode: expected 'rgb_array' or None, got {mode!r}")
    return str(mode)


class TaskEnv(gymnasium.Env[NDArray[np.float32], NDArray[Any]]):
    """An environment of a task; each task has its own class in `discjump.envs.named`.

    Args:
        lanes: as for many environments; no bit depends on it.
        render_mode: None or `rgb_array`, the command map.
        observation_fn, reward_fn, observation_space: what replaces observation and reward, see
            `discjump.envs.callables`.
        **options: fields of the task's options.

    Attributes:
        observation_space: `Box` of shape (size,), float32; `observation_layout` says what each number is.
        action_space: `MultiDiscrete` of forward, strafe, jump, jet, turn, and with a launcher fire and pitch;
            or `Box` with `actions="box"`.
        observation_layout: list of (name, slice, unit, scale); value in unit = observation * scale.

    Raises:
        TypeError, ValueError: naming the option, what was expected and what came.
    """

    OPTIONS: ClassVar[type[TaskOptions]]

    metadata: ClassVar[dict[str, Any]] = {"render_modes": list(RENDER_MODES), "render_fps": 7.8125}  # type: ignore[misc]

    def __init__(
        self,
        *,
        lanes: int | None = None,
        render_mode: str | None = None,
        observation_fn: ObservationFn | None = None,
        reward_fn: RewardFn | None = None,
        observation_space: spaces.Box | None = None,
        **options: Any,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode)
        self.options = self.OPTIONS.from_keywords(options)
        self.metadata = {**type(self).metadata, "render_fps": 1 / self.options.decision_seconds}  # type: ignore[misc]
        self._task = TaskEnvs(
            self.options,
            1,
            autoreset="disabled",
            threads=1,
            lanes=lanes,
            render=self.render_mode is not None,
            callables=Callables(observation_fn, reward_fn, observation_space),
        )
        self.observation_space = self._task.observation_space  # type: ignore[assignment]
        self.action_space = self._task.action_space

    @property
    def observation_layout(self) -> list[ObservationField]:
        """Fields of the task's own observation in their order."""
        return self._task.observation_layout

    @property
    def terrain(self) -> Terrain:
        """The terrain of the episode."""
        return self._task.terrain()

    def state(self) -> np.void:
        """A copy of the player's state, structured: position, velocity, yaw, energy and so on, as in
        `Simulator.state`.
        """
        state: np.void = self._task.batch.state()[0]
        return state

    def goal(self) -> NDArray[np.float64]:
        """Position of the goal, (3,), m: of a beacon on the ground, of a marker in the air, of a flag on its
        stand.
        """
        goal: NDArray[np.float64] = self._task.batch.goals()[0]
        return goal

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Start an episode.

        Args:
            seed: 0 to 2**64 - 1; None: the next episode of the last seed.
            options: `start` (x, y) or (x, y, z) in m, `goal` (x, y), of a marker also (x, y, z), in m (none
                where it is a flag), `terrain_seed` from the pool; what is left out is drawn.

        Returns:
            Observation (size,) float32, and info (see `discjump.envs.infos`).
        """
        seeds = seeds_of(seed, 1)
        observations = self._task.reset(seeds, options=options)
        super().reset(seed=None if seeds is None else seeds[0])
        return observations[0], self._task.batch.infos()[0]

    def step(self, action: object) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """One decision.

        Args:
            action: (5,) or, with a launcher, (7,), an element of `action_space`; an array must have an
                integer dtype (float32 with `actions="box"`).

        Returns:
            Observation (size,) float32, reward, terminated, truncated, info.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset and after an episode's end.
            TypeError, ValueError: the action has another dtype or shape, or is out of range; nothing has
            changed then.
        """
        task = self._task
        batch = task.batch
        if batch.halted:
            raise ResetNeeded("step: expected a call of reset() first: no episode is running")
        if not isinstance(action, np.ndarray):
            action = self._array(action)
        return batch.step_one(action) if task.plain else task.step_one(action)

    def _array(self, action: object) -> NDArray[Any]:
        """An action that came as numbers of Python's own."""
        given = np.asarray(action)
        if self.options.actions == "box" and given.dtype.kind in "if":
            return given.astype(np.float32)
        return given

    def snapshot(self) -> bytes:
        """The environment in the middle of its episode, as bytes that `restore` takes; also that of one
        environment among many (`index=`) with the same options.
        """
        return self._task.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot: the episode goes on from there with the same bits.

        Raises:
            TypeError: no bytes.
            ValueError: it is damaged or belongs to other options; nothing has changed then.

        >>> import gymnasium, discjump
        >>> env = gymnasium.make("discjump/Ski-v0", terrain_seeds=[0]).unwrapped
        >>> observation, info = env.reset(seed=1)
        >>> before, action = env.snapshot(), np.array([2, 1, 1, 1, 3])
        >>> once = env.step(action)[1]
        >>> env.restore(before)
        >>> once == env.step(action)[1]
        True
        """
        self._task.restore(snapshot)

    def render(self) -> NDArray[np.uint8] | None:
        """The command map, (height, width, 3) uint8, north up; None without `render_mode`."""
        return None if self.render_mode is None else self._task.render()
