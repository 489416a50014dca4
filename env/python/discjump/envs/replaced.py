"""A batch whose observation and reward are replaced: what must be remembered from step to step."""

import struct
import zlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from discjump._native import TaskBatch
from discjump.envs.callables import Checked, Transition, locked

Step = tuple[NDArray[Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]
One = tuple[NDArray[Any], float, bool, bool, dict[str, Any]]

MAGIC = b"returns\n"
TAIL = struct.Struct("<II8s")
"""What ends a snapshot with returns: how many there are, their CRC-32, the magic."""


class Native(NamedTuple):
    """The task's own results of the last call."""

    observations: NDArray[np.float32]
    rewards: NDArray[np.float64]
    info: dict[str, Any]


class Replaced:
    """The functions at work.

    Args:
        checked: the functions.
        batch: what is stepped.
        autoreset: `next_step`, `same_step` or `disabled`.

    Attributes:
        native: the task's own results of the last call, for recorders.
        finals: observations of the episodes that the last step ended, where the next ones have begun.
    """

    def __init__(self, checked: Checked, batch: TaskBatch, autoreset: str) -> None:
        self.checked, self.batch, self.autoreset = checked, batch, autoreset
        self.returns = np.zeros(batch.num_envs)
        self._sums = np.zeros(batch.num_envs)
        self.native: Native | None = None
        self.finals: NDArray[Any] = np.zeros(0)
        self._over = np.zeros(batch.num_envs, np.bool_)
        self._before: NDArray[np.float32] | None = None
        self._failed = False

    def reset(self, observations: NDArray[np.float32], mask: NDArray[np.bool_] | None) -> NDArray[Any]:
        """What is observed instead, after a reset of the environments in `mask` (None: all)."""
        if mask is None or mask.all():
            self._failed = False
            self._over, self.returns = np.zeros_like(self._over), np.zeros_like(self.returns)
        else:
            self._over, self.returns = self._over & ~mask, np.where(mask, 0.0, self.returns)
        self._before = observations
        self.native = Native(observations, np.zeros(len(observations)), {})
        with self._failing():
            return self._observed(observations)

    def ready(self) -> None:
        """Refuse to go on where a function failed.

        Raises:
            ResetNeeded: it did.
        """
        if self._failed:
            raise ResetNeeded(
                "expected a reset of all environments, or a restore, first: observation_fn or reward_fn "
                "failed after the simulator had gone on"
            )

    def step(self, play: Callable[[Any], Step], actions: Any) -> Step:
        """A decision of all environments, which `play` takes."""
        self.ready()
        before = self._observations()
        observations, rewards, terminated, truncated, info = play(actions)
        ended = terminated | truncated
        after, last = observations, None
        if self.autoreset == "same_step" and ended.any():
            last = self.batch.final_observations()
            after = observations.copy()
            after[ended] = last
        self.native = Native(observations, rewards, info)
        with self._failing():
            made = self._rewarded(before, after, actions, rewards, terminated, truncated)
            shown = self._observed(observations)
            self.finals = np.zeros(0) if last is None else self._observed(last)
        self._count(made, observations, ended)
        if ended.any():
            info = self._ended(info, ended, last is not None)
        return shown, made, terminated, truncated, info

    def step_one(self, play: Callable[[Any], One], action: Any) -> One:
        """A decision of the only environment, without the dimension of the batch."""
        self.ready()
        before = self._observations()
        observation, reward, terminated, truncated, info = play(action)
        rows, rewards = observation[None], np.array([reward])
        self.native = Native(rows, rewards, info)
        flags = np.array([terminated]), np.array([truncated])
        with self._failing():
            made = self._rewarded(before, rows, np.asarray(action)[None], rewards, *flags)
            shown = self._observed(rows)
        self._count(made, rows, flags[0] | flags[1])
        if terminated or truncated:
            [info] = self.infos_with_returns([info], np.array([0]))
        return shown[0], float(made[0]), terminated, truncated, info

    def infos_with_returns(
        self, infos: list[dict[str, Any]], ended: NDArray[np.int64]
    ) -> list[dict[str, Any]]:
        """Last infos of these environments' episodes, with the sums of the new rewards."""
        if not self.checked.rewards:
            return infos
        return [
            {**info, "return": float(self._sums[env]), "native_return": info["return"]}
            for info, env in zip(infos, ended, strict=True)
        ]

    def packed(self, snapshot: bytes, index: int | None) -> bytes:
        """A snapshot with the sums of the rewards so far."""
        self.ready()
        if not self.checked.rewards:
            return snapshot
        sums = (self.returns if index is None else self.returns[index : index + 1]).astype("<f8").tobytes()
        return snapshot + sums + TAIL.pack(len(sums) // 8, zlib.crc32(sums), MAGIC)

    def restored(self, sums: NDArray[np.float64] | None, index: int | None) -> None:
        """The batch, or one environment of it, was put elsewhere; None: the sums begin at 0 there."""
        rows = slice(None) if index is None else slice(index, index + 1)
        self.returns = self.returns.copy()
        self.returns[rows] = 0.0 if sums is None else sums
        self._over = (self.batch.flags() & 2).astype(np.bool_)
        self._before = None
        self._failed &= index is not None

    def _observations(self) -> NDArray[np.float32]:
        """The task's observations now."""
        if self._before is None:
            # Nobody is reset, and everybody observed.
            self._before = self.batch.reset(None, np.zeros(len(self.returns), np.bool_))
        return self._before

    def _observed(self, rows: NDArray[np.float32]) -> NDArray[Any]:
        if self.checked.space is None:
            return rows
        return self.checked.observed(self.checked.named(rows))

    def _rewarded(
        self,
        before: NDArray[np.float32],
        after: NDArray[np.float32],
        actions: Any,
        rewards: NDArray[np.float64],
        terminated: NDArray[np.bool_],
        truncated: NDArray[np.bool_],
    ) -> NDArray[np.float64]:
        if not self.checked.rewards:
            return rewards
        named = self.checked.named
        made = self.checked.rewarded(
            Transition(
                named(before),
                named(after),
                *map(locked, (np.asarray(actions), rewards, terminated, truncated)),
            )
        )
        # Where a step begins the next episode nothing was decided.
        made[self._over] = 0.0
        return made

    def _count(
        self, rewards: NDArray[np.float64], observations: NDArray[np.float32], ended: NDArray[np.bool_]
    ) -> None:
        """Sum up, and remember where the next step begins."""
        sums = np.where(self._over, 0.0, self.returns) + rewards
        self._sums = sums
        self.returns = np.where(ended, 0.0, sums) if self.autoreset == "same_step" else sums
        self._over = ended if self.autoreset != "same_step" else self._over
        self._before = observations

    def _ended(self, info: dict[str, Any], ended: NDArray[np.bool_], restarted: bool) -> dict[str, Any]:
        """A step's info with the new sums and last observations."""
        info = dict(info)
        where = info
        if restarted:
            where = info["final_info"] = dict(info["final_info"])
            if self.checked.space is not None:
                rows = np.full(len(ended), None, object)
                for row, last in zip(np.flatnonzero(ended), self.finals, strict=True):
                    rows[row] = last
                info["final_obs"] = rows
        if self.checked.rewards:
            where["native_return"], where["_native_return"] = where["return"], where["_return"].copy()
            where["return"] = np.where(ended, self._sums, 0.0)
        return info

    def _failing(self) -> "_Failing":
        return _Failing(self)


class _Failing:
    """Marks a failure of what is done meanwhile."""

    def __init__(self, owner: Replaced) -> None:
        self._owner = owner

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, *_: object) -> None:
        self._owner._failed |= kind is not None


def unpacked(snapshot: bytes, wanted: int) -> tuple[bytes, NDArray[np.float64] | None]:
    """A snapshot without the sums of rewards at its end, and so many `wanted` sums; None: it has none.

    Raises:
        ValueError: they are damaged, or of another number of environments.
    """
    if not snapshot.endswith(MAGIC) or len(snapshot) < TAIL.size:
        return snapshot, None
    count, checksum, _ = TAIL.unpack(snapshot[-TAIL.size :])
    first = len(snapshot) - TAIL.size - 8 * count
    sums = snapshot[max(first, 0) : -TAIL.size]
    if first < 0 or zlib.crc32(sums) != checksum:
        raise ValueError("snapshot: expected what snapshot() returned, got damaged sums of rewards")
    if count != wanted:
        raise ValueError(f"snapshot: expected one of {wanted} environments, got one of {count}")
    return snapshot[:first], np.frombuffer(sums, "<f8")
