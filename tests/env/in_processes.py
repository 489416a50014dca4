"""A script as a user would write it: environments in other processes, started by a method.

    python in_processes.py {pool,gymnasium,sb3} METHOD

Exits with 0 if they had the bits of environments in this one.
"""

import functools
import multiprocessing
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv

sys.path.insert(0, str(Path(__file__).parent))

from play import SHORT, random_actions, same_bits  # type: ignore[import-not-found]

# Above the batch that is stepped on the caller's thread alone, so that a pool is used.
MANY = 600
one_env = functools.partial(gymnasium.make, "discjump:discjump/Ski-v0", **SHORT)


def rollout(threads: int) -> bytes:
    """Bits of a rollout on a pool."""
    envs = gymnasium.make_vec("discjump:discjump/Ski-v0", num_envs=MANY, threads=threads, **SHORT)
    envs.reset(seed=0)
    return b"".join(envs.step(action)[0].tobytes() for action in random_actions(0, 10, MANY))


def child(answers: Any) -> None:
    """What the child process does."""
    answers.put(rollout(3))


def pool(method: str) -> None:
    """A child steps on a pool, after its parent did."""
    expected = rollout(3)
    context: Any = multiprocessing.get_context(method)
    answers = context.Queue()
    process = context.Process(target=child, args=(answers,))
    process.start()
    assert answers.get(timeout=60) == expected
    process.join(timeout=60)
    assert process.exitcode == 0


def with_gymnasium(method: str) -> None:
    """gymnasium's `AsyncVectorEnv` against its `SyncVectorEnv`."""
    sync = SyncVectorEnv([one_env] * 3)
    apart = AsyncVectorEnv([one_env] * 3, context=method)
    same_bits(apart.reset(seed=5), sync.reset(seed=5))
    for action in random_actions(2, 40, 3):
        same_bits(apart.step(action), sync.step(action))
    apart.close()


def with_sb3(method: str) -> None:
    """stable-baselines3's `SubprocVecEnv` against its `DummyVecEnv`."""
    # Here, so that the children of the others need not wait for torch.
    from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

    here: Any = DummyVecEnv([one_env] * 2)
    apart: Any = SubprocVecEnv([one_env] * 2, start_method=method)
    for envs in (here, apart):
        envs.seed(5)
    same_bits(apart.reset(), here.reset())
    for action in random_actions(3, 40, 2):
        left, right = apart.step(action), here.step(action)
        for one, two in zip(left[:3], right[:3], strict=True):
            # Theirs keeps rewards as float32 in one and as float64 in the other.
            assert one.astype(np.float32).tobytes() == two.astype(np.float32).tobytes()
    apart.close()


if __name__ == "__main__":
    {"pool": pool, "gymnasium": with_gymnasium, "sb3": with_sb3}[sys.argv[1]](sys.argv[2])
