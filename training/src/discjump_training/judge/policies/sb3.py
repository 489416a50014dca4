"""Models of stable-baselines3, of any algorithm, saved by it or by `discjump train`."""

import json
import zipfile
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import stable_baselines3
import torch
from stable_baselines3.common.base_class import BaseAlgorithm

from discjump_training import model
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.judge.policies.candidate import Candidate, digest_of
from discjump_training.policy import Actions, Mask, Observations, Policy

#: Entries that a model of any algorithm has.
ENTRIES = {"data", "policy.pth"}


def candidate(path: Path, name: str, task: str, *, sampled: bool) -> Candidate:
    """The model in a file.

    Raises:
        ModelError: it is missing, damaged or no such model, or was trained for another task.
    """
    model.check_file(path, ENTRIES)
    about = model.about(path)
    trained_for = about.get("task", task)
    if trained_for != task:
        raise ModelError(f"{path} was trained for the task {trained_for}, and is asked to play {task}")
    loaded = load(path)
    needs = dict(about.get("environment", {}))
    if isinstance(loaded.action_space, gymnasium.spaces.Box):
        needs.setdefault("actions", "box")

    def make(stage: Stage) -> Policy:
        model.check_spaces(loaded, path, stage.env)
        return Model(loaded, name, sampled=sampled)

    run = path.parent if (path.parent / "run.json").is_file() else None
    return Candidate(name, "model", make, needs, digest_of(path), run)


def load(path: Path) -> BaseAlgorithm:
    """A model of whatever algorithm.

    Raises:
        ModelError: the file holds something else, or an algorithm that is not installed.
    """
    model.check_file(path, ENTRIES)
    kind = algorithm(path)
    try:
        # Off-policy algorithms would make room for a million steps of experience.
        return kind.load(path, device="cpu", custom_objects={"buffer_size": 1})
    # Whatever a foreign pickle or state dict raises, the user's mistake is the same: this is not such a file.
    except Exception as error:
        raise ModelError(
            f"{path} does not hold a {kind.__name__} model of stable-baselines3: "
            f"{type(error).__name__}: {error}"
        ) from error


def algorithm(path: Path) -> type[BaseAlgorithm]:
    """The class that saved a model: files do not say, but what they keep tells it.

    Raises:
        ModelError: the file holds something else, or an algorithm of sb3-contrib, which is not installed.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            data = json.loads(archive.read("data"))
        policy = str(data["policy_class"]["__module__"])
    except (ValueError, KeyError, TypeError) as error:
        raise ModelError(
            f"{path} does not hold a model of stable-baselines3: {type(error).__name__}: {error}"
        ) from None
    if policy.startswith("sb3_contrib") or "lstm_hidden_state_shape" in data:
        return _contributed(path, policy)
    if "clip_range" in data:
        name = "PPO"
    elif "target_entropy" in data:
        name = "SAC"
    elif "target_policy_noise" in data:
        name = "TD3"
    elif "exploration_fraction" in data:
        name = "DQN"
    elif "gae_lambda" in data:
        name = "A2C"
    else:
        raise ModelError(f"{path} does not hold a model of an algorithm of stable-baselines3")
    found: type[BaseAlgorithm] = getattr(stable_baselines3, name)
    return found


def _contributed(path: Path, policy: str) -> type[BaseAlgorithm]:
    names = {
        "recurrent": "RecurrentPPO",
        "maskable": "MaskablePPO",
        "tqc": "TQC",
        "qrdqn": "QRDQN",
        "crossq": "CrossQ",
        "ars": "ARS",
        "trpo": "TRPO",
    }
    name = next((one for key, one in names.items() if key in policy), "RecurrentPPO")
    try:
        import sb3_contrib
    except ImportError:
        raise ModelError(
            f"{path} holds a {name} model: it needs sb3-contrib, which is not installed: "
            "pip install sb3-contrib"
        ) from None
    found: type[BaseAlgorithm] = getattr(sb3_contrib, name)
    return found


class Model:
    """What a model does: recurrent ones remember their episode.

    Args:
        loaded: the model.
        name: in tables.
        sampled: draw actions, with a generator of its own so that they are the same every time.
        seed: of the draws.
    """

    def __init__(self, loaded: BaseAlgorithm, name: str, *, sampled: bool = False, seed: int = 0) -> None:
        self.name = name
        self.note = "sampled" if sampled else "greedy"
        self._model = loaded
        self._seed = seed
        self._sampled = sampled
        self._memory: tuple[np.ndarray[Any, Any], ...] | None = None
        self._starts: Mask = np.ones(0, np.bool_)
        self.begin(range(0))

    def begin(self, rows: range) -> None:
        """The episodes of these rows are played next."""
        generator = torch.Generator().manual_seed(self._seed + (rows.start << 20))
        self._draws = generator.get_state()

    def reset(self, done: Mask) -> None:
        """Episodes begin in `done`."""
        if done.all():
            self._memory = None
        self._starts = done.copy()

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        # stable-baselines3 draws from torch's global generator: lend it ours for the call.
        with torch.random.fork_rng(devices=[], enabled=self._sampled):
            if self._sampled:
                torch.set_rng_state(self._draws)
            actions, self._memory = self._model.predict(
                observations,
                state=self._memory,
                episode_start=self._starts,
                deterministic=not self._sampled,
            )
            if self._sampled:
                self._draws = torch.get_rng_state()
        self._starts = np.zeros_like(self._starts)
        return np.asarray(actions)
