"""The environment under test: its making, its calls, the rollouts that checks share."""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray

from discjump.testing.batching import to_rows
from discjump.testing.limits import Limit, Unanswered, limited
from discjump.testing.rollout import CORE, FIELDS, Actions, Frame, Rollout, parting
from discjump.testing.trees import frozen

Env = VectorEnv[Any, Any, Any]
Factory = Callable[[int], Env]

STEPS_AFTER = 16
"""Steps that a rollout goes on after every environment has ended an episode."""


class Broken(Exception):
    """A check failed; the text says where and how."""


class Untested(Exception):
    """A check could not be made; the text says why."""


class Subject:
    """An environment, or what makes one, with the rollouts that its checks share.

    Args:
        source: a vector environment, or a callable that makes one of as many environments as it is told.
        num_envs: environments of the batch that a factory is asked for.
        steps: most steps of a rollout; it ends earlier once every environment has ended an episode.
        seed: seed of the shared rollout; others derive theirs from it.
        timeout: seconds for each check.
        ignored: keys of info that need not repeat, dotted (`episode.t`).
        reference: makes what the rollout must equal.
    """

    def __init__(
        self,
        source: Env | Factory,
        *,
        num_envs: int,
        steps: int,
        seed: int,
        timeout: float,
        ignored: frozenset[str] = frozenset(),
        reference: Factory | None = None,
    ) -> None:
        self.reference = reference
        self.factory = None if isinstance(source, VectorEnv) else source
        self._env: Env | None = source if isinstance(source, VectorEnv) else None
        self._others: list[Env] = []
        self.asked = num_envs
        self.steps = steps
        self.seed = seed
        self.timeout = timeout
        self.ignored = ignored
        self.limit = Limit(timeout)
        self.unanswered: str | None = None
        self.masked_resets = True
        self.num_envs = self.env.num_envs
        self.mode = self.env.metadata.get("autoreset_mode")
        self.single_observation_space = self.env.single_observation_space
        self.observation_space = self.env.observation_space
        self.action_space = self.env.action_space
        self.actions = Actions(self.env.single_action_space)

    @property
    def env(self) -> Env:
        """The environment that checks share; a factory's is made anew after `discard`."""
        if self._env is None:
            assert self.factory is not None
            self._env = _made(self.factory, self.asked)
        return self._env

    @property
    def name(self) -> str:
        """How reports call it."""
        return str(self.env)

    def another(self, num_envs: int | None = None, make: Factory | None = None) -> Env:
        """A second environment, closed after the check.

        Args:
            num_envs: of how many; None: as many as the shared one.
            make: what makes it; None: the factory under test, `Untested` without one.
        """
        make = make or self.factory
        if make is None:
            raise Untested("needs a second environment: pass a factory instead of an environment")
        env = _made(make, self.num_envs if num_envs is None else num_envs)
        self._others.append(env)
        return env

    def discard(self) -> None:
        """Leave an environment of unknown state behind; one that was passed in stays, for there is no
        other."""
        self.close_others()
        if self.factory is not None and self._env is not None:
            env, self._env = self._env, None
            self._closed(env)

    def forget(self) -> None:
        """`discard`, and play the shared rollouts anew: another instance may differ."""
        self.discard()
        if self.factory is not None:
            for name in ("rollout", "quiet", "among_others", "row_fields"):
                self.__dict__.pop(name, None)

    def close_others(self) -> None:
        """Close what `another` made."""
        while self._others:
            self._closed(self._others.pop())

    def seeds(self, seed: int | None = None, count: int | None = None) -> tuple[int, ...]:
        """The seeds of a batch that was reset with an int: seed + i."""
        first = self.seed if seed is None else seed
        return tuple(first + i for i in range(self.num_envs if count is None else count))

    @cached_property
    def rollout(self) -> Rollout:
        """The rollout that most checks look at: seed, seed + 1 ... and each one's own random actions."""
        return self.play(self.env, self.seed, steps=None, keep=True)

    @property
    def length(self) -> int:
        """Steps of the shared rollout, and so of those that are compared with it."""
        return len(self.rollout.steps)

    def play(
        self,
        env: Env,
        seed: int | list[int],
        *,
        steps: int | None = -1,
        streams: Sequence[int] | None = None,
        before: Callable[[], None] | None = None,
        alter: Callable[[int, Rollout, Any], Any] | None = None,
        after: Callable[[Any, tuple[Any, ...]], None] | None = None,
        keep: bool = False,
        settle: bool = True,
    ) -> Rollout:
        """Reset with `seed` and step; with the mode DISABLED episodes that ended are reset by mask.

        Args:
            env: what is played.
            seed: of the reset; a list as it is, an int s stands for s, s + 1, ...
            steps: how many; -1: as many as the shared rollout; None: until every environment ended an
                episode.
            streams: of the actions of each environment; by default its seed.
            before: called before each call of the environment.
            alter: (step, rollout so far, actions) -> actions.
            after: (actions, what was returned) -> None, called after each call, once it was copied.
            keep: keep the returned objects themselves in the frames.
            settle: take a step of another rollout first, if this is the shared environment.
        """
        seeds = tuple(seed) if isinstance(seed, list) else self.seeds(seed, env.num_envs)
        own = seeds if streams is None else tuple(streams)
        if steps == -1:
            steps = self.length
        rollout = Rollout(seeds)
        before = before or (lambda: None)
        after = after or (lambda actions, returned: None)

        def call(frame: Frame, actions: Any = None) -> None:
            after(actions, frame.returned)
            rollout.frames.append(frame if keep else _light(frame))

        if settle and env is self._env:
            self._settle(env)
        before()
        call(self.reset(env, seed=list(seed) if isinstance(seed, list) else seed))
        ends, since = np.zeros(env.num_envs, int), 0
        for step in range(self.steps if steps is None else steps):
            actions = self.actions.batch(own, step)
            if alter is not None:
                actions = alter(step, rollout, actions)
            before()
            frame = self.step(env, actions, at=len(rollout.frames))
            call(frame, actions)
            if self.mode is AutoresetMode.DISABLED and frame.ended.any():
                if not self.masked_resets:
                    break
                before()
                try:
                    call(self.reset(env, mask=frame.ended))
                except Broken:
                    if steps is not None:
                        raise
                    # The check of reset masks says so by name; all others end where the first episode does.
                    self.masked_resets = False
                    self.discard()
                    break
            ends += frame.ended
            since = since + 1 if ends.all() else 0
            if steps is None and since >= STEPS_AFTER:
                break
        return rollout

    def drive(self, env: Env, steps: int) -> Frame:
        """The first `steps` steps of the shared rollout again, up to its first end at most; the last
        frame."""
        self._settle(env)
        frame = self.reset(env, seed=self.seed)
        for step in range(steps):
            frame = self.step(env, self.actions.batch(self.seeds(), step))
        return frame

    def _settle(self, env: Env) -> None:
        """Take a step: what an earlier rollout left pending is the business of `reset_forgets` alone."""
        self.reset(env, seed=self.seed)
        self.step(env, self.actions.batch(self.seeds(), 0))

    @cached_property
    def quiet(self) -> int:
        """Steps of the shared rollout before the one in which the first episode ends."""
        return next((at for at, frame in enumerate(self.rollout.steps) if frame.ended.any()), self.length)

    @cached_property
    def among_others(self) -> dict[int, Rollout]:
        """The shared rollout with other actions for all but one environment: by that one, the first and the
        last."""
        if self.num_envs < 2:
            raise Untested("needs two environments or more")
        rollouts = {}
        for index in (0, self.num_envs - 1):
            streams = [seed + (0 if i == index else 10_000) for i, seed in enumerate(self.seeds())]
            rollouts[index] = self.play(self.env, self.seed, streams=streams)
        return rollouts

    @cached_property
    def row_fields(self) -> tuple[str, ...]:
        """What comparisons of single environments compare: not `info`, if it depends on the others."""
        if self.num_envs < 2:
            return FIELDS
        for index, again in self.among_others.items():
            if parting(self.rollout, again, [(index, index)], self.ignored, ("info",)):
                return CORE
        return FIELDS

    @cached_property
    def takes_lists(self) -> str | None:
        """None if reset takes a list of seeds, else how it refuses."""
        try:
            self.reset(self.env, seed=list(self.seeds()))
        except Broken as refusal:
            self.discard()
            return str(refusal)
        return None

    def reset(
        self,
        env: Env,
        seed: int | list[int] | None = None,
        mask: NDArray[np.bool_] | None = None,
    ) -> Frame:
        """One reset as a frame; `Broken` if it raises or returns something else than (observation, dict)."""
        options = None if mask is None else {"reset_mask": mask.copy()}
        what = f"reset(seed={seed}{'' if mask is None else ', reset_mask=' + str(mask.tolist())})"
        # A list of seeds is an extension of SyncVectorEnv and others; the base class declares an int.
        returned = self.called(what, lambda: env.reset(seed=seed, options=options))  # type: ignore[arg-type]
        if not isinstance(returned, tuple) or len(returned) != 2 or not isinstance(returned[1], dict):
            raise Broken(f"{what}: expected (observation, info dict), got {_shape(returned)}")
        observation, info = frozen(returned)
        observation = to_rows(self.single_observation_space, observation)
        return Frame("reset", observation, info, returned, mask=mask)

    def step(self, env: Env, actions: Any, at: int | None = None) -> Frame:
        """One step as a frame; `Broken` if it raises or returns something else than the five values."""
        what = "step" if at is None else f"call {at} (step)"
        returned = self.called(what, lambda: env.step(actions))
        if not isinstance(returned, tuple) or len(returned) != 5 or not isinstance(returned[4], dict):
            wanted = "(observation, reward, terminated, truncated, info dict)"
            raise Broken(f"{what}: expected {wanted}, got {_shape(returned)}")
        observation, reward, terminated, truncated, info = frozen(returned)
        observation = to_rows(self.single_observation_space, observation)
        return Frame("step", observation, info, returned, reward, terminated, truncated)

    def called(self, what: str, call: Callable[[], Any]) -> Any:
        """The result of `call`; `Broken` with its exception if it raises."""
        self.limit.check()
        try:
            return call()
        except Exception as error:
            raise Broken(f"{what} raised {type(error).__name__}: {_short(error)}") from error

    def _closed(self, env: Env) -> None:
        """Close without harm: what is broken may refuse, or never answer."""
        try:
            with limited(min(self.timeout, 10.0)):
                env.close()
        except (Exception, Unanswered):
            return


def _made(make: Factory, num_envs: int) -> Env:
    env = make(num_envs)
    if not isinstance(env, VectorEnv):
        raise TypeError(f"factory: expected it to return a gymnasium.vector.VectorEnv, got {_shape(env)}")
    if env.num_envs != num_envs:
        raise ValueError(
            f"factory: expected {num_envs} environments when called with that, got {env.num_envs}"
        )
    return env


def _light(frame: Frame) -> Frame:
    return Frame(
        frame.call,
        frame.observation,
        frame.info,
        (),
        frame.reward,
        frame.terminated,
        frame.truncated,
        frame.mask,
    )


def _shape(value: Any) -> str:
    if isinstance(value, tuple):
        return f"a tuple of {len(value)}: ({', '.join(type(part).__name__ for part in value)})"
    return type(value).__name__


def _short(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if len(text) <= 200 else f"{text[:197]}..."
