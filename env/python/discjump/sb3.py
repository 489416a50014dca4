"""Adapter to stable-baselines3.

from discjump.sb3 import make_vec_env
model = PPO("MlpPolicy", make_vec_env("discjump/Ski-v0", n_envs=1024, seed=0))
"""

import time
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from discjump import _check
from discjump.envs.callables import Callables, ObservationFn, RewardFn
from discjump.envs.observations import ObservationField
from discjump.envs.options import TaskOptions
from discjump.envs.single import checked_render_mode
from discjump.envs.task import TaskEnvs, seeds_of
from discjump.envs.tasks import BY_ID

try:
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import VecEnv
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices
except ImportError as error:
    raise ImportError(
        "discjump.sb3 needs stable-baselines3, which is not installed: pip install 'discjump[sb3]'"
    ) from error


class SharedInfo(dict[str, Any]):
    """The empty info of every environment whose episode goes on: one object for all, so it refuses to be
    changed.

    A copy of it is a plain dict.
    """

    __slots__ = ()

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise TypeError(
            "this info is shared by all environments whose episode goes on: copy it before you change it"
        )

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __copy__(self) -> dict[str, Any]:
        return {}

    def __deepcopy__(self, memo: dict[int, Any]) -> dict[str, Any]:
        return {}

    def __reduce__(self) -> tuple[type[dict[str, Any]], tuple[()]]:
        return dict, ()


SHARED_INFO = SharedInfo()


class SharedInfos(list[dict[str, Any]]):
    """The infos of a step that ended no episode: one list for all such steps, so it refuses to be changed.

    A copy or a slice of it is a plain list.
    """

    __slots__ = ()

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise TypeError(
            "this list of infos is shared by all steps that end no episode: copy it before you change it"
        )

    __setitem__ = __delitem__ = __iadd__ = __imul__ = _refuse
    append = clear = extend = insert = pop = remove = reverse = sort = _refuse

    def __copy__(self) -> list[dict[str, Any]]:
        return list(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> list[dict[str, Any]]:
        return [{} for _ in self]

    def __reduce__(self) -> tuple[type[list[Any]], tuple[list[dict[str, Any]]]]:
        return list, (list(self),)


class TaskVecEnv(VecEnv):
    """Environments of a task as a stable-baselines3 `VecEnv`.

    Episodes restart in the step that ends them. Python's work in a step grows with the episodes that ended,
    not with the environments: all others share one empty, read-only info, and steps that end no episode one
    read-only list of it. The info of an episode's end holds

    - `terminal_observation`: (size,) float32, the last observation of the episode;
    - `TimeLimit.truncated`: truncated and not terminated;
    - `episode`: `r` sum of rewards, `l` decisions, `t` seconds since this object was made (so no `Monitor` is
      needed, and `env_is_wrapped(Monitor)` says True);
    - the columns of `discjump.envs.infos`, `is_success` among them.

    `reset_infos` holds the info of each episode's first observation.

    What `reset` and `step` return never changes afterwards. Rewards are float32, as stable-baselines3 keeps
    them.

    Args:
        num_envs: number of environments.
        threads: threads that step the batch; None: one per core.
        lanes: players side by side in a register, as in `discjump.envs.vector`; no bit depends on it.
        render_mode: None or `rgb_array`, the command maps.
        observation_fn, reward_fn, observation_space: what replaces observation and reward, see
            `discjump.envs.callables`.
        options: of the task.
    """

    actions: NDArray[Any]

    def __init__(
        self,
        num_envs: int,
        options: TaskOptions,
        *,
        threads: int | None = None,
        lanes: int | None = None,
        render_mode: str | None = None,
        observation_fn: ObservationFn | None = None,
        reward_fn: RewardFn | None = None,
        observation_space: spaces.Box | None = None,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode)
        self.options = options
        self._task = TaskEnvs(
            options,
            num_envs,
            autoreset="same_step",
            threads=threads,
            lanes=lanes,
            render=render_mode is not None,
            callables=Callables(observation_fn, reward_fn, observation_space),
        )
        self._attributes: list[dict[str, Any]] = [{} for _ in range(num_envs)]
        self._quiet = SharedInfos([SHARED_INFO] * num_envs)
        self._started = time.time()
        super().__init__(num_envs, self._task.observation_space, self._task.action_space)
        self.metadata: dict[str, Any] = {**self.metadata, "render_fps": 1 / options.decision_seconds}

    @property
    def observation_layout(self) -> list[ObservationField]:
        """Fields of one of the task's own observations in their order."""
        return self._task.observation_layout

    def reset(self) -> NDArray[np.float32]:
        """Start an episode everywhere, with the seeds and options given by `seed` and `set_options` since the
        last call.

        Returns:
            Observations (num_envs, size) float32; `reset_infos` holds the infos.
        """
        observations = self._task.reset(
            seeds_of(self._seeds, self.num_envs), options=_batched(self._options), batched=True
        )
        self._reset_seeds()
        self._reset_options()
        self.reset_infos = self._task.batch.infos()
        return observations

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take note of the actions, (num_envs, 5) or, with a launcher, (num_envs, 7); `step_wait` steps."""
        self.actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        """One decision of every environment.

        Returns:
            Observations (num_envs, size) float32, of the next episode where one ended; rewards (num_envs,)
            float32; dones (num_envs,) bool; infos, a `SharedInfos` where no episode ended.
        """
        task = self._task
        batch = task.batch
        if batch.halted:
            raise ResetNeeded("step: expected a call of reset() first")
        step = batch.step_dones if task.plain else task.step_dones
        observations, rewards, dones, ended = step(self.actions)
        if not ended:
            return observations, rewards, dones, self._quiet
        return observations, rewards, dones, self._ends()

    def _ends(self) -> list[dict[str, Any]]:
        """The infos of a step that ended episodes."""
        task, batch, begun = self._task, self._task.batch, self.reset_infos
        elapsed = round(time.time() - self._started, 6)
        step_infos = self._quiet[:]
        for index, info, first, last in zip(
            batch.finished().tolist(),
            task.final_infos(),
            batch.begun_infos(),
            task.final_observations(),
            strict=True,
        ):
            info["terminal_observation"] = last
            info["TimeLimit.truncated"] = info["timeout"]
            info["episode"] = {"r": info["return"], "l": info["length"], "t": elapsed}
            step_infos[index] = info
            begun[index] = first
        return step_infos

    def snapshot(self, index: int | None = None) -> bytes:
        """Every environment in the middle of its episode, or the one of that index, for `restore`."""
        return self._task.snapshot(index)

    def restore(self, snapshot: bytes, index: int | None = None) -> None:
        """Put every environment back to where it was at a `snapshot`, of this object or of one like it; with
        an index, one of them to where it, or any other one, was.

        Raises:
            TypeError: `snapshot` is no bytes, `index` no integer.
            ValueError: the snapshot is damaged or belongs to other options, or there is no such environment;
                nothing has changed then.
        """
        self._task.restore(snapshot, index)

    def __getstate__(self) -> dict[str, Any]:
        """What makes it again; the shared infos are made anew."""
        return {name: value for name, value in self.__dict__.items() if name != "_quiet"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        self.__dict__.update(state)
        self._quiet = SharedInfos([SHARED_INFO] * self.num_envs)

    def close(self) -> None:
        """Nothing is held that would need it."""

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """The command map of every environment, or None without `render_mode`."""
        if self.render_mode is None:
            return [None] * self.num_envs
        return [self._task.render(index) for index in range(self.num_envs)]

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Attributes set by `set_attr`, else those of this object, which all environments share."""
        return [
            self._attributes[index][attr_name]
            if attr_name in self._attributes[index]
            else getattr(self, attr_name)
            for index in self._indices(indices)
        ]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Attach a value to environments; what this object defines itself cannot be replaced."""
        if hasattr(self, attr_name):
            raise AttributeError(f"{attr_name}: expected a new name, got one that all environments share")
        for index in self._indices(indices):
            self._attributes[index][attr_name] = value

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Results of a method of each environment: `render`, or a callable attached by `set_attr`."""
        results = []
        for index in self._indices(indices):
            if method_name == "render":
                results.append(self._task.render(index) if self.render_mode is not None else None)
            elif callable(method := self._attributes[index].get(method_name)):
                results.append(method(*method_args, **method_kwargs))
            else:
                raise AttributeError(
                    f"method_name: expected 'render' or a method set by set_attr, got {method_name!r}"
                )
        return results

    def env_is_wrapped(
        self, wrapper_class: type[gymnasium.Wrapper[Any, Any, Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        """True for `Monitor`, whose `episode` statistics every episode's end has; no environment has another
        wrapper.
        """
        return [wrapper_class is Monitor for _ in self._indices(indices)]

    def _indices(self, indices: VecEnvIndices) -> Iterable[int]:
        return self._get_indices(indices)


def make_vec_env(
    env_id: str,
    n_envs: int = 1,
    seed: int | None = None,
    *,
    threads: int | None = None,
    lanes: int | None = None,
    render_mode: str | None = None,
    observation_fn: ObservationFn | None = None,
    reward_fn: RewardFn | None = None,
    observation_space: spaces.Box | None = None,
    **options: Any,
) -> TaskVecEnv:
    """A stable-baselines3 vector environment.

    Args:
        env_id: id of a task, also as `discjump:discjump/Ski-v0`.
        n_envs: number of environments.
        seed: environment i has seed + i; None: drawn from the operating system.
        threads: threads that step the batch; None: one per core.
        lanes: players side by side in a register, as in `discjump.envs.vector`; no bit depends on it.
        render_mode: None or `rgb_array`.
        observation_fn, reward_fn, observation_space: what replaces observation and reward, see
            `discjump.envs.callables`.
        **options: fields of the task's options.

    Raises:
        TypeError, ValueError: naming the argument, what was expected and what came.

    >>> envs = make_vec_env("discjump/Ski-v0", n_envs=2, seed=0, terrain_seeds=[0])
    >>> observations = envs.reset()
    >>> observations, rewards, dones, infos = envs.step(np.tile([2, 1, 1, 0, 3], (2, 1)))
    >>> rewards.dtype, infos
    (dtype('float32'), [{}, {}])
    """
    name = _check.choice("env_id", str(env_id).removeprefix("discjump:"), tuple(BY_ID))
    seeds = seeds_of(seed, _check.integer("n_envs", n_envs, 1, 2**24))
    envs = TaskVecEnv(
        n_envs,
        BY_ID[name].options.from_keywords(options),
        threads=threads,
        lanes=lanes,
        render_mode=render_mode,
        observation_fn=observation_fn,
        reward_fn=reward_fn,
        observation_space=observation_space,
    )
    if seeds is not None:
        envs._seeds = list(seeds)
    return envs


def _batched(options: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """Options of each environment as one row each; a start or goal that an environment leaves out is
    drawn.
    """
    rows: dict[str, Any] = {}
    for key in sorted({key for one in options for key in one}):
        given = [one.get(key) for one in options]
        present = [value for value in given if value is not None]
        if not present:
            continue
        if key == "terrain_seed":
            if len(present) < len(given):
                raise ValueError(
                    "options['terrain_seed']: expected one for every environment or for none, got some"
                )
            rows[key] = given
        else:
            drawn = np.full(np.shape(present[0]), np.nan)
            rows[key] = [drawn if value is None else value for value in given]
    return rows or None
