"""`info` holds what the table of `discjump.envs.infos` says, and nothing else."""

import re

import numpy as np

from discjump.envs import infos
from discjump.envs.named import SkiEnv

from .play import SHORT, random_actions


def documented():
    """Keys of the two tables: of every step, and of an episode's end."""
    assert infos.__doc__ is not None
    # The third table is of some tasks and options alone: tests/env/test_tasks.py.
    tables = re.split("and when an episode ends|and then", infos.__doc__)[:2]
    rows = [re.findall(r"^\| ([a-z_, ]+?) \|", table, re.MULTILINE) for table in tables]
    step, end = ([key for row in table if row != "key" for key in row.split(", ")] for table in rows)
    return step, end


def test_keys():
    step, end = documented()
    env = SkiEnv(**SHORT)
    assert list(env.reset(seed=0)[1]) == step
    for action in random_actions(0, 200, 1)[:, 0]:
        *_, terminated, truncated, info = env.step(action)
        assert list(info) == (step + end if terminated or truncated else step)
        if terminated or truncated:
            break
    assert terminated or truncated
    assert sum((info["is_success"], info["death"], info["timeout"])) == 1
    assert info["length"] >= 1
    assert all(np.isfinite(value) for value in info.values())
