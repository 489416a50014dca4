"""Simulates the candidates of many episodes in one batch, from copies of the real states."""

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump_training.episodes import place
from discjump_training.planner.guides import Guide
from discjump_training.planner.proposals import Draft
from discjump_training.policy import Floats, Observations


class Rollouts:
    """Batches of candidates.

    Args:
        task_id: of the environments.
        options: of them; the real ones must have the same.
        candidates: of each episode.
        threads: of the simulator.
        objective: scores them.
        guide: completes sequences; None: all are complete.
    """

    def __init__(
        self,
        task_id: str,
        options: dict[str, Any],
        candidates: int,
        threads: int | None,
        objective: Any,
        guide: Guide | None,
    ) -> None:
        self._make = {"id": task_id, "threads": threads, **options}
        self._candidates = candidates
        self._objective = objective
        self._guide = guide
        self._batches: dict[int, Any] = {}
        self._at: bytes | None = None

    def place(self, snapshots: list[bytes], observations: Observations) -> None:
        """Put the candidates of each episode to where its snapshot is.

        Args:
            snapshots: of the episodes.
            observations: there, (episodes, size).
        """
        # The least power of two holds them: a group of which few episodes are left is not simulated in full.
        slots = 1 << (len(snapshots) - 1).bit_length()
        self._batch = self._batches.get(slots) or self._made(slots)
        self._episodes = len(snapshots)
        for slot, snapshot in enumerate(snapshots):
            place(self._batch, snapshot, range(slot * self._candidates, (slot + 1) * self._candidates))
        self._at = self._batch.snapshot()
        self._first = np.repeat(observations, self._candidates, axis=0)
        self._moved = False

    def run(self, drafts: list[Draft]) -> tuple[Floats, NDArray[np.int64]]:
        """Simulate the sequences of each episode; what the guide decides is filled in.

        Returns:
            Scores (episodes, candidates), and simulated decisions (episodes,) until the ends of episodes.
        """
        assert self._at is not None, "place() comes first"
        if self._moved:
            self._batch.restore(self._at)
        self._moved = True
        per, count = self._candidates, self._episodes * self._candidates
        actions = np.zeros((self._batch.num_envs, *drafts[0].actions.shape[1:]), np.int8)
        for slot, draft in enumerate(drafts):
            actions[slot * per : (slot + 1) * per] = draft.actions
        running = np.ones(count, np.bool_)
        simulated = np.zeros(self._episodes, np.int64)
        seen = self._first
        self._objective.begin(count)
        if self._guide is not None:
            self._guide.begin(self._episodes)
        for time in range(actions.shape[1]):
            self._complete(drafts, actions, seen, time)
            simulated += np.count_nonzero(running.reshape(self._episodes, per), axis=1)
            observations, rewards, terminated, truncated, info = self._batch.step(
                np.ascontiguousarray(actions[:, time], dtype=np.int64)
            )
            seen = observations[:count]
            ended = running & (terminated | truncated)[:count]
            self._objective.add(rewards[:count], ended, running, _first_rows(info, count, ended.any()))
            running &= ~ended
            if not running.any():
                break
        for slot, draft in enumerate(drafts):
            draft.actions = actions[slot * per : (slot + 1) * per]
        return self._objective.scores(seen, running, per).reshape(self._episodes, per), simulated

    def _complete(
        self, drafts: list[Draft], actions: NDArray[np.int8], seen: Observations, time: int
    ) -> None:
        if self._guide is None:
            return
        for slot, draft in enumerate(drafts):
            where = draft.guided[:, time]
            if where.any():
                start = slot * self._candidates
                chosen = self._guide.act(np.array(seen[start : start + len(where)]), slot)
                np.copyto(actions[start : start + len(where), time], chosen, where=where)

    def _made(self, slots: int) -> Any:
        batch: Any = gymnasium.make_vec(num_envs=slots * self._candidates, **self._make).unwrapped
        # Any state will do for those that hold no candidate.
        batch.reset(seed=0)
        self._batches[slots] = batch
        return batch

    def close(self) -> None:
        """Close all batches."""
        for batch in self._batches.values():
            batch.close()


def _first_rows(info: dict[str, Any], count: int, ended: bool) -> dict[str, Any]:
    keys = ("time", "is_success") if ended else ("time",)
    return {key: info[key][:count] for key in keys}
