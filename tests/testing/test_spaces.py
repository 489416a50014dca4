"""The checks assume nothing of the spaces: every kind passes where the rules are kept."""

import copy
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from discjump.testing import check_vector_env

SPACES = {
    "discrete": spaces.Discrete(7, start=-3),
    "multi_discrete": spaces.MultiDiscrete([3, 2, 5]),
    "multi_binary": spaces.MultiBinary([2, 3]),
    "box": spaces.Box(-1, 1, (2, 2), np.float64),
    "unbounded": spaces.Box(-np.inf, np.inf, (), np.float32),
    "image": spaces.Box(0, 255, (4, 4, 3), np.uint8),
    "dict": spaces.Dict({"a": spaces.Discrete(3), "b": spaces.Dict({"c": spaces.Box(0, 1, (2,))})}),
    "tuple": spaces.Tuple(
        (spaces.Discrete(2), spaces.Tuple((spaces.Box(0, 1, (1,)), spaces.MultiBinary(2))))
    ),
    "text": spaces.Text(5),
    "sequence": spaces.Sequence(spaces.Box(0, 1, (1,))),
}


class Samples(gymnasium.Env[Any, Any]):
    """Observations drawn from a space; an episode ends by chance or by a function of the action."""

    def __init__(self, observation_space: spaces.Space[Any], action_space: spaces.Space[Any]) -> None:
        self.observation_space, self.action_space = observation_space, action_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None:
            self.observation_space.seed(seed)
        return self.observation_space.sample(), {"words": "first"}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        weight = sum(ord(letter) for letter in repr(action)) % 5
        chance = self.np_random.random()
        return self.observation_space.sample(), float(weight), chance < 0.1, weight == 0, {"words": "on"}


MODES = list(AutoresetMode)


# gymnasium's own, of sequences and of numbers without an axis.
@pytest.mark.filterwarnings("ignore:.*Casting input x to numpy array")
@pytest.mark.parametrize(
    ("name", "mode"),
    [(name, MODES[index % 3]) for index, name in enumerate(SPACES)] + [("dict", mode) for mode in MODES[:2]],
)
def test_environments_of_every_space_pass(name, mode):
    def make(num_envs: int) -> SyncVectorEnv[Any, Any]:
        one, other = SPACES[name], SPACES["dict" if name == "box" else name]
        each = [lambda: Samples(copy.deepcopy(one), copy.deepcopy(other))] * num_envs
        return SyncVectorEnv(each, autoreset_mode=mode)

    report = check_vector_env(make, steps=60)
    assert [outcome.name for outcome in report.skipped] == []
