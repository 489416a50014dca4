"""Baselines: what a trained agent has to be better than.

sight       named readings of an observation
steering    from a direction to keys and a turn
script      the scripted skier, and the same tacking
jumper      the scripted disc jumper
runner      the scripted route runner
tuned.toml  their constants, found on the training courses; it says how
"""

import tomllib
from dataclasses import asdict
from importlib import resources
from typing import Any

import numpy as np

from discjump_training.baselines.jumper import Jumper, JumperParameters
from discjump_training.baselines.runner import Runner, RunnerParameters
from discjump_training.baselines.script import Script, SkierParameters, TackerParameters
from discjump_training.draws import RowDraws
from discjump_training.episodes import Stage
from discjump_training.errors import TrainingError
from discjump_training.policy import BINS, Actions, Mask, Observations, Policy

#: Baselines by name, with the parameters they are tuned in.
Parameters = SkierParameters | JumperParameters
PARAMETERS: dict[str, type[Parameters]] = {
    "skier": SkierParameters,
    "tacker": TackerParameters,
    "jumper": JumperParameters,
    "runner": RunnerParameters,
}
NAMES = ("random", *PARAMETERS)
#: Those of each task; a task that is not listed has `random` alone.
OF_TASK: dict[str, tuple[str, ...]] = {
    "ski": ("random", "skier", "tacker"),
    "disc-jump": ("random", "jumper"),
    "route": ("random", "runner"),
    "flag-run": ("random", "runner"),
}

#: Ranges of the fan that the scripts look at, straight ahead, metres.
RANGES = (6.0, 16.0, 35.0, 70.0, 120.0)
#: Options that make the observations the scripts need and no more.
OPTIONS: dict[str, Any] = {"fan_bearings": [0.0], "fan_ranges": list(RANGES), "landing": False}


class Random:
    """Presses keys at random, anew at each decision; each row of a course has draws of its own.

    Args:
        seed: of the draws.
        bins: of each action.
    """

    name = "random"
    note = "uniform"

    def __init__(self, seed: int = 0, bins: tuple[int, ...] = BINS) -> None:
        def draw(generator: np.random.Generator, count: int) -> Actions:
            return generator.integers(0, bins, size=(count, len(bins)), dtype=np.int64)

        self._draws = RowDraws(seed, draw)

    def begin(self, rows: range) -> None:
        """The episodes of these rows are played next."""
        self._draws.begin(rows)

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        return self._draws.next(len(observations))

    def reset(self, done: Mask) -> None:
        """When all episodes begin anew, so do the draws."""
        if done.all():
            self._draws.restart()


def make(name: str, stage: Stage, parameters: Parameters | None = None) -> Policy:
    """A baseline for the environments of `stage`, which must have been made with `OPTIONS`.

    Args:
        name: one of `NAMES`.
        stage: where it will play.
        parameters: in place of the tuned ones.

    Raises:
        TrainingError: if no baseline has that name.
    """
    if name not in NAMES:
        raise TrainingError(f"no baseline is named {name!r}; there are {', '.join(NAMES)}")
    if name == "random":
        return Random(bins=stage.bins)
    parameters = parameters or tuned(name)
    if isinstance(parameters, JumperParameters):
        return Jumper(parameters, stage.layout, stage.turn_rate)
    if isinstance(parameters, RunnerParameters):
        return Runner(parameters, stage.layout, np.array(RANGES), stage.turn_rate)
    return Script(name, parameters, stage.layout, np.array(RANGES), stage.turn_rate)


def names(task: str) -> tuple[str, ...]:
    """Names of the baselines of a task."""
    return OF_TASK.get(task, ("random",))


def scripts(task: str) -> tuple[str, ...]:
    """Names of the baselines of a task that follow a script."""
    return tuple(name for name in names(task) if name in PARAMETERS)


def options(task: str) -> dict[str, Any]:
    """Options of the task's environment that its baselines need to see what they look at."""
    return dict(OPTIONS) if task in OF_TASK else {}


def tuned(name: str) -> Parameters:
    """The committed constants of a script."""
    text = resources.files(__name__).joinpath("tuned.toml").read_text(encoding="utf-8")
    return PARAMETERS[name](**tomllib.loads(text)[name]["parameters"])


def rounded(parameters: Parameters) -> Parameters:
    """Parameters as `to_toml` prints them, with four digits."""
    return type(parameters)(**tomllib.loads(to_toml(parameters)))


def to_toml(parameters: Parameters) -> str:
    """Parameters as lines of TOML."""
    return "".join(f"{key} = {value:.4g}\n" for key, value in asdict(parameters).items())
