"""Other ways in: `gymnasium.make`, gymnasium's own vector environment over it, and stable-baselines3."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump.verify.interface import Batch
from discjump.verify.parts import Column, Part, info_columns, joined

SHOWN_BY_OURS = frozenset({"state", "goals", "terrain_index"})
"""What other vector environments cannot show, nor any once the next episode has begun."""
NARROW = frozenset({"reward"})
"""What stable-baselines3 keeps as float32."""


class Singles:
    """`gymnasium.make`, as many as there are environments."""

    def __init__(self, id: str, num: int, options: Mapping[str, Any]) -> None:
        self.envs = [gymnasium.make(id, **options) for _ in range(num)]

    def reset(self, seeds: Sequence[int | None] | None, mask: NDArray[np.bool_] | None = None) -> list[Part]:
        """Begin episodes."""
        chosen = range(len(self.envs)) if mask is None else np.flatnonzero(mask).tolist()
        results = [self.envs[i].reset(seed=None if seeds is None else seeds[i]) for i in chosen]
        return joined(
            [self._row(i, (*pair, 0.0, False, False)) for i, pair in zip(chosen, results, strict=True)]
        )

    def step(self, actions: Column) -> list[Part]:
        """One decision of each; where an episode ended, the next begins."""
        parts, begun = [], []
        for index, env in enumerate(self.envs):
            observation, reward, terminated, truncated, info = env.step(actions[index])
            parts.append(self._row(index, (observation, info, reward, terminated, truncated)))
            if terminated or truncated:
                begun.append(self._row(index, (*env.reset(), 0.0, False, False)))
        return joined(parts) + joined(begun)

    def _row(self, index: int, row: tuple[Any, Mapping[str, Any], Any, bool, bool]) -> Part:
        observation, info, reward, terminated, truncated = row
        env = self.envs[index].unwrapped
        columns = {
            "observation": observation[None],
            "reward": np.array([reward]),
            "terminated": np.array([terminated]),
            "truncated": np.array([truncated]),
            **one_info(info),
        }
        if hasattr(env, "state"):
            columns["state"] = env.state()[None]
        if hasattr(env, "goal"):
            columns["goals"] = env.goal()[None]
        return Part(np.array([index]), columns, SHOWN_BY_OURS.difference(columns))

    def snapshot(self) -> bytes:
        """Not by this way in."""
        raise NotImplementedError

    def restore(self, snapshot: bytes) -> None:
        """Not by this way in."""
        raise NotImplementedError


class StableBaselines3:
    """`discjump.sb3.make_vec_env`: rewards in float32, infos at the ends of episodes only."""

    def __init__(self, id: str, num: int, options: Mapping[str, Any]) -> None:
        from discjump.sb3 import make_vec_env

        self.envs = make_vec_env(id, n_envs=num, threads=2, **options)
        self.everyone = np.arange(num)

    def reset(self, seeds: Sequence[int | None] | None, mask: NDArray[np.bool_] | None = None) -> list[Part]:
        """Begin episodes."""
        assert mask is None
        if seeds is not None:
            self.envs._seeds = list(seeds)
        observations: Any = self.envs.reset()
        return self._first(self.everyone, observations)

    def step(self, actions: Column) -> list[Part]:
        """One decision, in which an episode that ends is followed by the next."""
        observations: Any
        observations, rewards, dones, infos = self.envs.step(actions)
        ended, going = np.flatnonzero(dones), np.flatnonzero(~dones)
        none = np.zeros(len(going), np.bool_)
        columns = {"observation": observations[going], "reward": rewards[going], **self._shown(going)}
        # No info is given while an episode goes on.
        flags = {"terminated": none, "truncated": none}
        parts = [Part(going, columns | flags, frozenset({"info"}), NARROW)]
        for index in ended:
            info = dict(infos[index])
            last, truncated = info.pop("terminal_observation"), info.pop("TimeLimit.truncated")
            del info["episode"]
            columns = {
                "observation": last[None],
                "reward": rewards[index : index + 1],
                "terminated": np.array([not truncated]),
                "truncated": np.array([truncated]),
                **one_info(info),
            }
            parts.append(Part(np.array([index]), columns, SHOWN_BY_OURS, NARROW))
        return parts + (self._first(ended, observations) if len(ended) else [])

    def _first(self, indices: NDArray[np.int64], observations: Any) -> list[Part]:
        parts = []
        for index in indices:
            at = np.array([index])
            columns = {
                "observation": observations[at],
                "reward": np.zeros(1, np.float32),
                "terminated": np.zeros(1, np.bool_),
                "truncated": np.zeros(1, np.bool_),
                **one_info(self.envs.reset_infos[index]),
                **self._shown(at),
            }
            parts.append(Part(at, columns, narrow=NARROW))
        return joined(parts)

    def _shown(self, indices: NDArray[np.int64]) -> dict[str, Column]:
        batch = self.envs._task.batch
        shown = {"state": batch.state(), "goals": batch.goals(), "terrain_index": batch.terrain_index()}
        return {name: column[indices] for name, column in shown.items()}

    def snapshot(self) -> bytes:
        """Everything, for `restore`."""
        return self.envs.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot."""
        self.envs.restore(snapshot)


def one_info(info: Mapping[str, Any]) -> dict[str, Column]:
    """The columns of one environment's info."""
    masks = {f"_{key}": np.ones(1, np.bool_) for key in info}
    return info_columns({**{key: np.array([value]) for key, value in info.items()}, **masks})


def synced(id: str, num: int, options: Mapping[str, Any]) -> Batch:
    """gymnasium's `SyncVectorEnv` over `gymnasium.make`."""
    from discjump.verify.environments import VectorBatch

    envs = gymnasium.make_vec(id, num_envs=num, vectorization_mode="sync", **options)
    return VectorBatch(envs, "NextStep", SHOWN_BY_OURS)


SLOW = ("discjump.sb3.make_vec_env",)
"""Those that import torch."""

WAYS: dict[str, Callable[[str, int, Mapping[str, Any]], Batch]] = {
    "gymnasium.make": Singles,
    "gymnasium.make_vec, sync": synced,
    "discjump.sb3.make_vec_env": StableBaselines3,
}
