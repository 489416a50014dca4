"""Recording episodes of a vector environment while they are played."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from numpy.typing import NDArray

from discjump import _check
from discjump.envs.vector import TaskVectorEnv
from discjump.replays.episode import EpisodeReplay
from discjump.replays.recorder import Recorder
from discjump.replays.shelf import EVERY, Deliver, Shelf, alone, id_of, placed_at
from discjump.replays.tape import Tape


class VectorRecorder(VectorWrapper):
    """Records episodes of a discjump vector environment, in any autoreset mode.

    With `SAME_STEP` the last state of an episode cannot be had any more: it is not in the replay.

    Args:
        env: to be recorded.
        folder, every, on_replay: as for `Recorder`.
        rows: which environments; None: all.
        episodes: how many of each environment; None: all.

    Raises:
        TypeError: `env` is not discjump's.
        ValueError: it has `curriculum=True`.
    """

    def __init__(
        self,
        env: VectorEnv[Any, Any, Any],
        folder: str | Path | None = None,
        *,
        every: int = EVERY,
        on_replay: Deliver | None = None,
        rows: Iterable[int] | None = None,
        episodes: int | None = None,
    ) -> None:
        if not isinstance(env.unwrapped, TaskVectorEnv):
            raise TypeError(f"env: expected a vector environment of discjump, got {env.unwrapped!r:.80}")
        super().__init__(env)
        self._inner: TaskVectorEnv = env.unwrapped
        alone(self._inner.options)
        self._id = id_of(env)
        self._every = _check.integer("every", every, 1, 2**20)
        self._shelf = Shelf(folder, on_replay)
        last = env.num_envs - 1
        chosen = range(env.num_envs) if rows is None else rows
        self._left = {_check.integer(f"rows[{i}]", row, 0, last): episodes for i, row in enumerate(chosen)}
        self._tapes: dict[int, tuple[Tape, dict[str, Any]]] = {}
        self._over = np.zeros(env.num_envs, np.bool_)

    @property
    def replays(self) -> list[EpisodeReplay]:
        """Finished replays that went nowhere else."""
        return self._shelf.replays

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Start episodes; those under way where one is started are cut off."""
        # Whose episode ends here must be known while its state is still there.
        mask = (options or {}).get("reset_mask")
        before = self._inner.state() if self._tapes else None
        returned = observations, infos = self.env.reset(seed=seed, options=options)
        if (native := self._inner._task.native) is not None:
            observations = native.observations
        rows = np.arange(self.num_envs) if mask is None else np.flatnonzero(mask)
        for row in rows.tolist():
            if row in self._tapes and before is not None:
                self._cut(row, before[row])
        self._begin(rows, observations, infos, options)
        return returned

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """One decision of every environment."""
        seen = self.env.step(actions)
        if not self._left:
            return seen
        observations, rewards, terminations, truncations, infos = seen
        if (native := self._inner._task.native) is not None:
            observations, rewards, infos = native
        over = terminations | truncations
        same_step = self._inner.autoreset_mode == AutoresetMode.SAME_STEP
        ended = [row for row in self._tapes if over[row]]
        due = [row for row, (tape, _) in self._tapes.items() if tape.due]
        states = self._inner.state() if due or ended else None
        # The caller may write its next actions into the same array.
        taken = np.array(actions)
        for row, (tape, _) in self._tapes.items():
            observation, info = observations[row], _Row(infos, row)
            state = None if states is None else states[row]
            if over[row] and same_step:
                observation, info, state = infos["final_obs"][row], _Row(infos["final_info"], row), None
            tape.add(taken[row], observation, rewards[row], terminations[row], truncations[row], info, state)
        for row in ended:
            self._finish(row)
        if same_step:
            self._begin(np.flatnonzero(over), observations, infos, None)
        elif self._inner.autoreset_mode == AutoresetMode.NEXT_STEP:
            self._begin(np.flatnonzero(self._over), observations, infos, None)
        self._over = over
        return seen

    def close(self, **kwargs: Any) -> None:
        """Cut off what is under way, and close the environments."""
        if self._tapes:
            states = self._inner.state()
            for row in [*self._tapes]:
                self._cut(row, states[row])
        self.env.close(**kwargs)

    def _begin(
        self, rows: NDArray[np.int64], observations: Any, infos: Any, options: Mapping[str, Any] | None
    ) -> None:
        """Episodes began in these rows."""
        self._over[rows] = False
        wanted = [row for row in rows.tolist() if row in self._left]
        if not wanted:
            return
        inner = self._inner
        (seeds, numbers), states, goals = inner._task.batch.episodes(), inner.state(), inner.goals()
        terrains = inner.terrain_index
        for row in wanted:
            begun = {
                "seed": int(seeds[row]),
                "episode": int(numbers[row]),
                "reset": placed_at(options, row),
                "terrain": inner.terrains[int(terrains[row])],
            }
            info = _Row(infos, row)
            self._tapes[row] = (Tape(self._every, states[row], observations[row], info, goals[row]), begun)

    def _cut(self, row: int, state: Any) -> None:
        tape, _ = self._tapes[row]
        if tape.decisions:
            tape.cut(state)
            self._finish(row)
        else:
            del self._tapes[row]

    def _finish(self, row: int) -> None:
        tape, begun = self._tapes.pop(row)
        inner = self._inner
        way = {"lanes": inner._task.batch.lanes, "batch": inner.num_envs, "index": row}
        self._shelf.put(EpisodeReplay.of(tape, name=self._id, options=inner.options, way=way, **begun))
        left = self._left[row]
        if left is not None:
            self._left[row] = left - 1
            if left <= 1:
                del self._left[row]


def record(
    env: Any,
    folder: str | Path | None = None,
    *,
    every: int = EVERY,
    on_replay: Deliver | None = None,
    **chosen: Any,
) -> Any:
    """The environment with a recorder round it: a `VectorRecorder` for many, a `Recorder` for one.

    Args:
        env: of discjump, from `gymnasium.make` or `make_vec`.
        folder: where replays are saved, one file each.
        every: decisions between two digests.
        on_replay: called with each replay.
        **chosen: `rows` and `episodes` of a vector environment.
    """
    if isinstance(env, VectorEnv):
        return VectorRecorder(env, folder, every=every, on_replay=on_replay, **chosen)
    return Recorder(env, folder, every=every, on_replay=on_replay, **chosen)


class _Row(Mapping[str, Any]):
    """One environment's entries of an info of columns, looked up when asked for."""

    def __init__(self, infos: Mapping[str, Any], row: int) -> None:
        self._infos, self._row = infos, row

    def __getitem__(self, key: str) -> Any:
        return self._infos[key][self._row]

    def __contains__(self, key: object) -> bool:
        return key in self._infos and bool(self._infos[f"_{key}"][self._row])

    def __iter__(self) -> Iterator[str]:
        return (key for key in self._infos if not key.startswith("_") and key in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
