"""Model files: a stable-baselines3 zip with a few entries of our own beside its own.

stable-baselines3 ignores entries it does not know, so `PPO.load` opens these files too. A file is written
whole or not at all. Opening one runs code that it contains (pickles): open only files you trust.
"""

import io
import json
import zipfile
from collections.abc import Sequence, Set
from pathlib import Path
from typing import Any

import numpy as np
import torch
from gymnasium.vector import VectorEnv
from stable_baselines3 import PPO
from stable_baselines3.common.base_class import BaseAlgorithm

from discjump_training.errors import ModelError
from discjump_training.files import write_atomically
from discjump_training.policy import Actions, Mask, Observations

#: Entry with the recipe and the steps of the model, as JSON.
ABOUT = "discjump_training.json"
#: Entries that every PPO model of stable-baselines3 has.
ENTRIES = {"data", "policy.pth", "policy.optimizer.pth"}
#: File that holds the best model of a run.
BEST = "best.zip"

#: Attributes of a model that only a training goes on with.
LEARNING = ("_last_obs", "_last_original_obs", "_last_episode_starts", "ep_info_buffer", "ep_success_buffer")


def save(
    model: PPO,
    path: Path,
    about: dict[str, Any],
    entries: dict[str, bytes] | None = None,
    *,
    exclude: Sequence[str] = (),
) -> None:
    """Write `model` without the attributes in `exclude`, the JSON-able `about` and further entries to one
    file, atomically.
    """
    buffer = io.BytesIO()
    model.save(buffer, exclude=list(exclude))
    with zipfile.ZipFile(buffer, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(ABOUT, json.dumps(about))
        for name, content in (entries or {}).items():
            archive.writestr(name, content)
    write_atomically(path, buffer.getvalue())


def save_to_play(model: PPO, path: Path, about: dict[str, Any]) -> None:
    """Write what it takes to play, and not what only a training goes on with: a fifth of the size. The model
    loses it, too.
    """
    model.policy.optimizer.state.clear()
    save(model, path, about, exclude=LEARNING)


def read_entry(path: Path, name: str) -> bytes:
    """One of our own entries of a model file.

    Raises:
        ModelError: if the file is missing or damaged, or has no such entry.
    """
    check_file(path)
    with zipfile.ZipFile(path) as archive:
        try:
            return archive.read(name)
        except KeyError:
            raise ModelError(f"{path} has no entry {name}: it was not written by discjump train") from None


def about(path: Path) -> dict[str, Any]:
    """What `save` was told about the model; empty for a plain stable-baselines3 file of any algorithm."""
    check_file(path, {"data"})
    with zipfile.ZipFile(path) as archive:
        if ABOUT not in archive.namelist():
            return {}
        loaded: dict[str, Any] = json.loads(archive.read(ABOUT))
        return loaded


def check_file(path: Path, entries: Set[str] = frozenset(ENTRIES)) -> None:
    """Refuse a file that is missing or is no whole zip, or lacks one of `entries`.

    Raises:
        ModelError: saying which.
    """
    if not path.is_file():
        raise ModelError(f"no model file at {path}")
    try:
        with zipfile.ZipFile(path) as archive:
            missing = entries - set(archive.namelist())
            damaged = archive.testzip()
    except (zipfile.BadZipFile, OSError, EOFError) as error:
        raise ModelError(f"{path} is not a readable model file: {error}") from None
    # A cut-off model file may still open as a zip: the weights within are zips themselves, whole ones.
    if missing:
        raise ModelError(f"{path} is not a whole model file: it lacks {', '.join(sorted(missing))}")
    if damaged is not None:
        raise ModelError(f"{path} is damaged: its entry {damaged} does not match its checksum")


def load(path: Path, **kwargs: Any) -> PPO:
    """Load a PPO model; `kwargs` go to `PPO.load`.

    Raises:
        ModelError: if the file is missing, damaged or holds something else.
    """
    check_file(path)
    try:
        return PPO.load(path, device="cpu", **kwargs)
    # Whatever a foreign pickle or state dict raises, the user's mistake is the same: this is not such a file.
    except Exception as error:
        raise ModelError(f"{path} does not hold a PPO model of stable-baselines3: {error}") from error


class Greedy:
    """A model's likeliest actions.

    Args:
        ppo: the model.
        name: in tables.
    """

    note = "greedy"

    def __init__(self, ppo: PPO, name: str) -> None:
        self.ppo = ppo
        self.name = name

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        actions, _ = self.ppo.predict(observations, deterministic=True)
        return _typed(actions)

    def reset(self, done: Mask) -> None:
        """Nothing is remembered."""


class Sampled(Greedy):
    """Actions drawn from a model's distribution, with a generator of its own so that they are the same
    every time.

    Args:
        ppo: the model.
        name: in tables.
        seed: of the draws.
    """

    note = "sampled"

    def __init__(self, ppo: PPO, name: str, seed: int = 0) -> None:
        super().__init__(ppo, name)
        self._seed = seed
        self._state = torch.Generator().manual_seed(seed).get_state()

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        # stable-baselines3 draws from torch's global generator: lend it ours for the call.
        with torch.random.fork_rng(devices=[]):
            torch.set_rng_state(self._state)
            actions, _ = self.ppo.predict(observations, deterministic=False)
            self._state = torch.get_rng_state()
        return _typed(actions)


def _typed(actions: Any) -> Actions:
    # Numbers stay numbers: an environment with actions="box" takes no integers, and one with bins no floats.
    made = np.asarray(actions)
    return made if made.dtype == np.float32 else made.astype(np.int64)


def check_spaces(ppo: BaseAlgorithm, path: Path | str, env: VectorEnv[Any, Any, Any]) -> None:
    """Refuse an environment whose spaces are not the model's.

    Raises:
        ModelError: naming both.
    """
    for kind, have, need in (
        ("observations", env.single_observation_space, ppo.observation_space),
        ("actions", env.single_action_space, ppo.action_space),
    ):
        if have != need:
            raise ModelError(f"{path} was trained on {kind} in {need}, but the environment has {have}")
