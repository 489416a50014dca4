"""What a user would pick instead, in the same run: agent steps a second, and the size of an observation."""

import importlib
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import gymnasium
import numpy as np

from discjump.bench.clock import Case, Effort, Ready, Timed, Unavailable, interleave, loop, spread
from discjump.bench.figure import short
from discjump.bench.ways import SETS, Vector

INSTALL = "not installed: pip install 'discjump[peers]'"
SIZES = (1, 64, 1024, 4096)


@dataclass(frozen=True)
class Peer:
    """A batch of another package's environments, random actions, autoreset."""

    name: str
    num_envs: int
    threads: int
    calls: ClassVar[int | None] = None

    @property
    def units(self) -> int:
        """Agent steps."""
        return self.num_envs

    def make(self) -> Ready:
        """The environments, reset, and their actions."""
        envs, actions = OPEN[self.name](self.num_envs, self.threads)
        observations, _ = envs.reset()
        return Ready(loop(envs.step, actions), int(np.prod(observations.shape[1:])))


def _gymnasium(mode: str, env_id: str) -> Callable[[int, int], tuple[Any, list[Any]]]:
    def open_(num_envs: int, threads: int) -> tuple[Any, list[Any]]:
        envs = gymnasium.make_vec(env_id, num_envs=num_envs, vectorization_mode=mode)
        envs.action_space.seed(0)
        return envs, [envs.action_space.sample() for _ in range(SETS)]

    return open_


def _envpool(task: str) -> Callable[[int, int], tuple[Any, list[Any]]]:
    def open_(num_envs: int, threads: int) -> tuple[Any, list[Any]]:
        try:
            envpool = importlib.import_module("envpool")
        except ImportError as error:
            raise Unavailable(INSTALL) from error
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            # Its bounds of float64 become float32 spaces: nothing that a user of this command could mend.
            warnings.simplefilter("ignore")
            try:
                envs = envpool.make_gymnasium(task, num_envs=num_envs, num_threads=min(threads, num_envs))
            except Exception as error:
                # Tasks come and go with its versions and with the libraries of the machine.
                raise Unavailable(f"envpool does not make {task}: {error}") from error
        space = envs.action_space
        space.seed(0)
        samples = [np.stack([space.sample() for _ in range(num_envs)]) for _ in range(SETS)]
        return envs, [sample.astype(space.dtype) for sample in samples]

    return open_


OPEN = {
    "gymnasium CartPole-v1, SyncVectorEnv": _gymnasium("sync", "CartPole-v1"),
    "gymnasium CartPole-v1, CartPoleVectorEnv": _gymnasium("vector_entry_point", "CartPole-v1"),
    "EnvPool CartPole-v1": _envpool("CartPole-v1"),
    "EnvPool HalfCheetah-v4": _envpool("HalfCheetah-v4"),
}
"""How each peer is opened: its environments and some actions, by number of environments and threads."""
LARGEST = {"EnvPool HalfCheetah-v4": 1024}
"""A batch of more takes long to make, and is no faster."""


def measure(effort: Effort, threads: int, sizes: tuple[int, ...] = SIZES) -> list[dict[str, Any]]:
    """The rows of the table: by size, ours first."""
    rows = []
    for size in sizes:
        ours: dict[str, Case] = {
            f"discjump/Ski-v0, VectorEnv, frame_skip {skip}": Vector(size, skip, threads) for skip in (1, 4)
        }
        theirs: dict[str, Case] = {
            name: Peer(name, size, threads) for name in OPEN if size <= LARGEST.get(name, size)
        }
        cases = ours | theirs
        times = interleave(cases.values(), effort, f"{size:>6} environments")
        base = times[next(iter(ours.values()))]
        assert isinstance(base, Timed), "ours is installed"
        for name, case in cases.items():
            timed = times[case]
            row: dict[str, Any] = {"num_envs": size, "name": name}
            if isinstance(timed, Timed):
                row |= {
                    "observation": timed.observation,
                    **spread(timed.rate)._asdict(),
                    "ours_over_this": spread(base.rate / timed.rate)._asdict(),
                }
            else:
                row["missing"] = str(timed)
            rows.append(row)
    return rows


def table(rows: list[dict[str, Any]]) -> str:
    """The rows as Markdown.

    >>> row = {"num_envs": 64, "name": "a", "observation": 4, "median": 2e5, "low": 1e5, "high": 3e5}
    >>> ratio = {"median": 12.0, "low": 11.0, "high": 13.0}
    >>> print(table([row | {"ours_over_this": ratio}, {"num_envs": 64, "name": "b", "missing": "gone"}]))
    | environments | | numbers in an observation | agent steps/s (quartiles) | ours, frame_skip 1, over it |
    |---|---|---|---|---|
    | 64 | a | 4 | 200,000 (100,000 .. 300,000) | 12.0 |
    | 64 | b | | gone | |
    """
    lines = [
        "| environments | | numbers in an observation | agent steps/s (quartiles) "
        "| ours, frame_skip 1, over it |",
        "|---|---|---|---|---|",
    ]
    for row in rows:
        head = f"| {row['num_envs']:,} | {row['name']} |"
        if "missing" in row:
            lines.append(f"{head} | {row['missing']} | |")
            continue
        median, low, high = (f"{row[name]:,.0f}" for name in ("median", "low", "high"))
        ratio = short(row["ours_over_this"]["median"])
        lines.append(f"{head} {row['observation']} | {median} ({low} .. {high}) | {ratio} |")
    return "\n".join(lines)
