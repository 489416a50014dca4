"""Observation and reward in Python, for all environments in one call.

`observation_fn`, `reward_fn` and `observation_space` are keywords of `gymnasium.make`, `gymnasium.make_vec`
and `discjump.sb3.make_vec_env`, for every task.

- `observation_fn(observations)` takes the task's own `Observations` and returns an array with a row for each
  of theirs: what the environments observe instead. It sees all of them at a step or a reset; besides, where
  an episode ends in the step that begins the next one, the last observations of those that ended. So a row
  of what it returns must depend on that row alone, and the number of rows is open.
- `reward_fn(transition)` takes a `Transition` and returns the rewards, (num_envs,). It is called once per
  step. In the step that begins the next episode (`NEXT_STEP`) the reward is 0, whatever it returns.
- `observation_space` is a `Box` for one environment: shape and dtype of what `observation_fn` returns.
  Without it, they are those of what it returns for observations of zeros, as float32 without bounds.

Both must return arrays that they do not write again. Both are tried on zeros when environments are made.

`info["return"]` and what stable-baselines3 calls `episode` sum up the new rewards, `info["native_return"]`
the task's own. `observation_layout` stays that of the task's own observation. Replays hold the task's own
observations and rewards, and are played without the functions. Copies and snapshots go on with the same bits
if the functions depend on nothing but what they are given; to be pickled, they must be functions of a module.
A snapshot of environments without a `reward_fn` begins its sum at 0.

An exception out of them, or something else than was expected of them, comes out of `step` and `reset`. The
simulator has gone on by then: no further step is taken until all environments are reset or restored.

>>> import gymnasium, discjump, numpy as np
>>> def eyes_shut(observations):
...     return np.column_stack([observations["velocity"] / 30, observations["beacon_distance"] / 400])
>>> def faster(transition):
...     return transition.rewards + 0.01 * (transition.after["speed"] - transition.before["speed"])
>>> envs = gymnasium.make_vec(
...     "discjump/Ski-v0", num_envs=3, terrain_seeds=[0], observation_fn=eyes_shut, reward_fn=faster
... )
>>> envs.reset(seed=0)[0].shape
(3, 4)
>>> observations, rewards, terminations, truncations, info = envs.step(np.tile([2, 1, 1, 0, 3], (3, 1)))
>>> observations.dtype, rewards.dtype
(dtype('float32'), dtype('float64'))
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from discjump.envs.observations import ObservationField, Observations


@dataclass(frozen=True, slots=True)
class Transition:
    """A decision of all environments, as a `reward_fn` sees it. Every array is read-only.

    Attributes:
        before: what the task observed when the actions were chosen.
        after: what it observes now; where an episode ended, the last observation of that episode.
        actions: (num_envs, size), as they were given.
        rewards: (num_envs,) float64, the task's own.
        terminated, truncated: (num_envs,) bool.
    """

    before: Observations
    after: Observations
    actions: NDArray[Any]
    rewards: NDArray[np.float64]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]


ObservationFn = Callable[[Observations], Any]
RewardFn = Callable[[Transition], Any]


@dataclass(frozen=True)
class Callables:
    """What replaces observation and reward; None: nothing does.

    Raises:
        TypeError: naming what is not callable, or no `Box`; or a space without a function that fills it.
    """

    observation_fn: ObservationFn | None = None
    reward_fn: RewardFn | None = None
    observation_space: spaces.Box | None = None

    def __post_init__(self) -> None:
        """Check every field."""
        for name in ("observation_fn", "reward_fn"):
            given = getattr(self, name)
            if given is not None and not callable(given):
                raise TypeError(
                    f"{name}: expected a callable, got {given!r:.80} of type {type(given).__name__}"
                )
        space = self.observation_space
        if space is None:
            return
        if not isinstance(space, spaces.Box):
            raise TypeError(
                f"observation_space: expected a gymnasium.spaces.Box of one environment, got {space!r:.80}"
            )
        if self.observation_fn is None:
            raise TypeError("observation_space: expected an observation_fn beside it, got none")

    def __bool__(self) -> bool:
        """Whether anything is replaced."""
        return self.observation_fn is not None or self.reward_fn is not None


class Checked:
    """The functions with what they must return.

    Args:
        given: the functions.
        layout: of the task's own observation.
        size: numbers in it.
        action: an action of one environment.
        num_envs: number of environments.

    Attributes:
        space: of one environment's observation; None: the task's own.

    Raises:
        TypeError, ValueError: a function did not return what it must for zeros.
    """

    def __init__(
        self,
        given: Callables,
        layout: list[ObservationField],
        size: int,
        action: NDArray[Any],
        num_envs: int,
    ) -> None:
        self._given = given
        self._fields: Mapping[str, ObservationField] = {field.name: field for field in layout}
        self.space: spaces.Box | None = given.observation_space
        zeros = self.named(np.zeros((num_envs, size), np.float32))
        # Who divides by a distance divides by zero here.
        with np.errstate(all="ignore"):
            if given.observation_fn is not None and self.space is None:
                shape = _array("observation_fn", given.observation_fn(zeros), np.dtype(np.float32)).shape
                if len(shape) < 2 or shape[0] != num_envs:
                    raise ValueError(
                        f"observation_fn: expected an array of shape ({num_envs}, k), a row for each "
                        f"environment, got shape {shape}"
                    )
                self.space = spaces.Box(-np.inf, np.inf, shape[1:], np.float32)
            self.observed(zeros, finite=False)
            none = locked(np.zeros(num_envs, np.bool_))
            actions = locked(np.tile(action, (num_envs, 1)))
            rewards = locked(np.zeros(num_envs))
            self.rewarded(Transition(zeros, zeros, actions, rewards, none, none), finite=False)

    def named(self, rows: NDArray[np.float32]) -> Observations:
        """The task's observations, with names and read-only."""
        return Observations(locked(rows), self._fields)

    def observed(self, seen: Observations, *, finite: bool = True) -> NDArray[Any]:
        """What is observed instead, (rows, ...)."""
        function = self._given.observation_fn
        if function is None:
            return seen.array
        assert self.space is not None
        assert self.space.dtype is not None
        made = _array("observation_fn", function(seen), self.space.dtype)
        if made.shape != (len(seen), *self.space.shape):
            wanted = (len(seen), *self.space.shape)
            raise ValueError(f"observation_fn: expected an array of shape {wanted}, got shape {made.shape}")
        if finite:
            _finite("observation_fn", made)
        # What is given away may be written to; what came may be the simulator's own.
        return made if made.flags.writeable else made.copy()

    def rewarded(self, transition: Transition, *, finite: bool = True) -> NDArray[np.float64]:
        """The rewards instead, (num_envs,), an array of their own."""
        function = self._given.reward_fn
        if function is None:
            return transition.rewards
        made = _array("reward_fn", function(transition), np.dtype(np.float64))
        if made.shape != transition.rewards.shape:
            raise ValueError(f"reward_fn: expected shape {transition.rewards.shape}, got shape {made.shape}")
        if finite:
            _finite("reward_fn", made)
        return made.copy()

    @property
    def rewards(self) -> bool:
        """Whether rewards are replaced."""
        return self._given.reward_fn is not None


def locked(array: NDArray[Any]) -> NDArray[Any]:
    """A view that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view


def _array(name: str, made: object, dtype: np.dtype[Any]) -> NDArray[Any]:
    """What a function returned, in a dtype that loses no kind of number."""
    try:
        array = np.asarray(made)
    except ValueError:
        raise ValueError(f"{name}: expected an array of {dtype}, got something ragged") from None
    if array.dtype.kind not in "biuf" or not np.can_cast(array.dtype, dtype, "same_kind"):
        came = (
            f"{array.dtype}"
            if isinstance(made, np.ndarray)
            else f"{made!r:.80} of type {type(made).__name__}"
        )
        raise TypeError(f"{name}: expected an array of {dtype}, got {came}")
    return array.astype(dtype, copy=False)


def _finite(name: str, made: NDArray[Any]) -> None:
    """Refuse what would spoil a training silently."""
    if made.dtype.kind != "f":
        return
    with np.errstate(all="ignore"):
        # A sum is not finite if a number is not: one pass, and another only where it may have overflowed.
        if np.isfinite(made.sum()):
            return
    wrong = np.flatnonzero(~np.isfinite(made).reshape(len(made), -1).all(axis=1))
    if len(wrong):
        raise ValueError(
            f"{name}: expected finite numbers, got others in {len(wrong)} rows (the first is {wrong[0]})"
        )
