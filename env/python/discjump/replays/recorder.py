"""Recording the episodes of one environment while they are played."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from discjump import _check
from discjump.envs.single import TaskEnv
from discjump.replays.episode import EpisodeReplay
from discjump.replays.shelf import EVERY, Deliver, Shelf, alone, id_of, placed_at
from discjump.replays.tape import Tape


class Recorder(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Records every episode of a discjump environment.

    It must lie directly round the environment (and what `gymnasium.make` puts round it): a wrapper inside
    that changes actions would be recorded as if it were not there. So must a `restore` not happen inside an
    episode: a replay is played from its beginning.

    Where `observation_fn` or `reward_fn` replace the task's own observations and rewards, the task's own are
    recorded: a replay is played without the functions.

    Args:
        env: to be recorded.
        folder: where replays are saved, one file each.
        every: decisions between two digests.
        on_replay: called with each replay.

    Raises:
        TypeError: `env` is not discjump's.
        ValueError: a wrapper inside changes its actions, or it has `curriculum=True`.

    Attributes:
        replays: finished replays, where neither `folder` nor `on_replay` takes them.

    >>> import gymnasium, discjump
    >>> env = Recorder(gymnasium.make("discjump/Ski-v0", terrain_seeds=[0], time_limit=1.0))
    >>> observation, info = env.reset(seed=3)
    >>> for _ in range(8):
    ...     step = env.step(np.array([2, 1, 1, 0, 3]))
    >>> env.replays[0].outcome["timeout"], env.replays[0].verify()
    (True, None)
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        folder: str | Path | None = None,
        *,
        every: int = EVERY,
        on_replay: Deliver | None = None,
    ) -> None:
        if not isinstance(env.unwrapped, TaskEnv):
            raise TypeError(f"env: expected an environment of discjump, got {env.unwrapped!r:.80}")
        super().__init__(env)
        if env.action_space != env.unwrapped.action_space:
            raise ValueError("env: expected a recorder inside of what changes actions, got it outside")
        self._inner: TaskEnv = env.unwrapped
        alone(self._inner.options)
        self._id = id_of(env)
        self._every = _check.integer("every", every, 1, 2**20)
        self._shelf = Shelf(folder, on_replay)
        self._tape: Tape | None = None
        self._begun: dict[str, Any] = {}

    @property
    def replays(self) -> list[EpisodeReplay]:
        """Finished replays that went nowhere else."""
        return self._shelf.replays

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start an episode; one under way is cut off there."""
        returned = observation, info = self.env.reset(seed=seed, options=options)
        self._cut()
        inner = self._inner
        if (native := inner._task.native) is not None:
            observation = native.observations[0]
        seeds, numbers = inner._task.batch.episodes()
        self._begun = {
            "seed": int(seeds[0]),
            "episode": int(numbers[0]),
            "reset": placed_at(options, None),
            "terrain": inner.terrain,
        }
        self._state = inner.state()
        self._tape = Tape(self._every, self._state, observation, info, inner.goal())
        return returned

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """One decision."""
        returned = observation, reward, terminated, truncated, info = self.env.step(action)
        tape = self._tape
        if tape is not None:
            if (native := self._inner._task.native) is not None:
                observation, reward, info = native.observations[0], native.rewards[0], native.info
            over = terminated or truncated
            self._state = self._inner.state()
            taken = np.array(action)
            tape.add(taken, observation, reward, terminated, truncated, info, self._state)
            if over:
                self._finish()
        return returned

    def close(self) -> None:
        """Cut off what is under way, and close the environment."""
        self._cut()
        self.env.close()

    def _cut(self) -> None:
        if self._tape is not None and self._tape.decisions:
            self._tape.cut(self._state)
            self._finish()
        self._tape = None

    def _finish(self) -> None:
        assert self._tape is not None
        task = self._inner._task
        way = {"threads": 1, "lanes": task.batch.lanes, "batch": 1, "index": 0}
        options = self._inner.options
        self._shelf.put(EpisodeReplay.of(self._tape, name=self._id, options=options, way=way, **self._begun))
        self._tape = None
