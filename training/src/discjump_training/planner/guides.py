"""Who completes sequences, and who says what a state is worth: models and scripts.

A network's sums may be rounded differently in a batch of another size. Guides are therefore always asked
about the candidates of one episode at a time, in a buffer of their own: what they say depends on nothing
else.
"""

from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import PPO

from discjump.envs.tasks import Task
from discjump_training import baselines, model
from discjump_training.errors import ModelError, TrainingError
from discjump_training.evaluate import in_task, model_path
from discjump_training.joint import likeliest
from discjump_training.policy import Floats, Layout, Observations, Policy


class Guide(Protocol):
    """Chooses actions while sequences are simulated."""

    def begin(self, slots: int) -> None:
        """Sequences of that many episodes begin."""

    def act(self, observations: Observations, slot: int) -> NDArray[np.int8]:
        """Actions (n, components) for the candidates (n, size) of the episode in that slot."""


class Networks:
    """PPO models of stable-baselines3: as guide and as value.

    Args:
        models: of the same task and observations. Candidates are dealt out to them in equal parts; the value
            is the mean of theirs.
    """

    def __init__(self, models: list[PPO]) -> None:
        self._policies: list[Any] = [one.policy for one in models]
        self.gamma = float(models[0].gamma)
        for one in models:
            if one.gamma != self.gamma:
                raise ModelError(f"models: expected one discount, got {self.gamma} and {one.gamma}")

    def begin(self, slots: int) -> None:
        """Nothing is remembered."""

    def act(self, observations: Observations, slot: int) -> NDArray[np.int8]:
        """The likeliest actions."""
        parts = np.array_split(np.arange(len(observations)), len(self._policies))
        with torch.inference_mode():
            chosen = [
                self._likeliest(policy, torch.from_numpy(observations[part]))
                for policy, part in zip(self._policies, parts, strict=True)
                if part.size
            ]
        return np.concatenate(chosen)

    def value(self, observations: Observations) -> Floats:
        """Expected discounted reward, (n,)."""
        with torch.inference_mode():
            seen = torch.from_numpy(np.array(observations))
            values = [policy.predict_values(seen).numpy()[:, 0] for policy in self._policies]
        mean: Floats = np.mean(np.stack(values).astype(np.float64), axis=0)
        return mean

    @staticmethod
    def _likeliest(policy: Any, observations: torch.Tensor) -> NDArray[np.int8]:
        # policy.get_distribution would build and check a distribution for each component: half of the time.
        features = policy.extract_features(observations, policy.pi_features_extractor)
        logits = policy.action_net(policy.mlp_extractor.forward_actor(features))
        chosen: NDArray[np.int8] = likeliest(policy.action_dist, logits).to(torch.int8).numpy()
        return chosen


class Scripts:
    """A scripted baseline as guide. What it remembers of an episode begins anew with each simulation.

    Args:
        name: of the baseline.
        task_env: environments with the options that it needs.
    """

    def __init__(self, name: str, task_env: Any) -> None:
        self._name = name
        self._env = task_env
        self._one: list[Policy] = []

    def begin(self, slots: int) -> None:
        """Forget everything."""
        while len(self._one) < slots:
            self._one.append(baselines.make(self._name, self._env))
        self._fresh = set(range(slots))

    def act(self, observations: Observations, slot: int) -> NDArray[np.int8]:
        """What the script does."""
        if slot in self._fresh:
            self._one[slot].reset(np.ones(len(observations), np.bool_))
            self._fresh.discard(slot)
        return self._one[slot](observations).astype(np.int8)


class Sight:
    """What a script must know of its environments."""

    def __init__(self, env: Any) -> None:
        self.layout = Layout.of(env.observation_layout)
        self.turn_rate = float(env.options.turn_rate)


def load(paths: list[str], env: Any | None = None) -> tuple[Networks, dict[str, Any]]:
    """Models, and the options of the task that they were trained with.

    Args:
        paths: model files or folders of runs.
        env: environments that they must fit, if there are any yet.

    Raises:
        ModelError: if one cannot be had, or they do not fit each other or the environments.
    """
    loaded = [(path, model.load(model_path(path))) for path in paths]
    options = [_options(model.about(model_path(path))) for path in paths]
    for (path, ppo), theirs in zip(loaded, options, strict=True):
        if not isinstance(ppo.action_space, _multi_discrete()):
            raise ModelError(f"{path}: expected actions in a MultiDiscrete space, got {ppo.action_space}")
        if env is not None:
            model.check_spaces(ppo, Path(path), env)
        if theirs != options[0]:
            raise ModelError(f"{path} was trained with options {theirs}, but {paths[0]} with {options[0]}")
    return Networks([ppo for _, ppo in loaded]), options[0]


def _options(about: dict[str, Any]) -> dict[str, Any]:
    return in_task(about.get("environment", {}), about.get("task", "ski"))


def script(task: Task, name: str) -> dict[str, Any]:
    """Options of the task that a baseline needs.

    Raises:
        TrainingError: if there is none of that name that can guide.
    """
    if name not in baselines.scripts(task.name):
        known = ", ".join(baselines.scripts(task.name)) or "it has none"
        raise TrainingError(
            f"{name}: expected a model file, the folder of a run, or a script of {task.name}: {known}"
        )
    return baselines.options(task.name)


def _multi_discrete() -> type:
    from gymnasium.spaces import MultiDiscrete

    return MultiDiscrete
