"""What the tests of judging share."""

import numpy as np
import pytest
from click.testing import CliRunner

from discjump_training.commands import compare as comparing
from discjump_training.commands import evaluate as evaluating
from discjump_training.commands import leaderboard as ranking
from discjump_training.courses import HELD_OUT
from discjump_training.judge import Conditions, Entrant, Keep, find, from_function, judge

COMMANDS = {
    "evaluate": evaluating.evaluate,
    "compare": comparing.compare,
    "leaderboard": ranking.leaderboard,
}


@pytest.fixture
def invoke():
    def call(command, *arguments):
        return CliRunner().invoke(COMMANDS[command], [str(argument) for argument in arguments])

    return call


@pytest.fixture
def refused(invoke):
    """The words of a command that fails as it should: exit code 1, no traceback."""

    def call(*arguments):
        result = invoke(*arguments)
        assert result.exit_code == 1, result.output
        assert isinstance(result.exception, SystemExit), result.exception
        assert result.output.startswith("Error: ") or "\nError: " in result.output
        return " ".join(result.output.split())

    return call


@pytest.fixture
def play():
    """What a policy, or a function, does in the first episodes of the held-out course."""

    def call(policy, episodes=4, keep=None, **conditions):
        candidate = find(policy, HELD_OUT) if isinstance(policy, str) else from_function(policy, "function")
        asked = Conditions(HELD_OUT, episodes, threads=1, **conditions)
        return judge([Entrant(candidate.name, (candidate,))], asked, keep or Keep())[0]

    return call


def ahead(observation):
    """Forward and jump, for ever."""
    return np.array([2, 1, 1, 0, 3])


def ahead_in_batches(observations):
    return np.tile([2, 1, 1, 0, 3], (len(observations), 1))


class Counting:
    """A policy with a memory: it turns ever further."""

    made = 0

    def __init__(self):
        type(self).made += 1
        self.decisions = 0

    def __call__(self, observations):
        self.decisions += 1
        actions = np.tile([2, 1, 1, 0, 3], (len(observations), 1))
        actions[:, 4] = self.decisions % 7
        return actions

    def reset(self, done):
        assert done.all()
        self.decisions = 0


def raising(observation):
    raise RuntimeError("no idea")


def out_of_range(observation):
    return [2, 1, 1, 0, 9]


def too_short(observation):
    return [2, 1]


def halves(observation):
    return [1.5, 1, 1, 0, 3]


SPOON = 5
