"""Who takes part in planning for a task: the guide, the objective, and the options they need."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from discjump.envs.tasks import Task
from discjump_training import baselines
from discjump_training.errors import TrainingError
from discjump_training.planner import guides as who
from discjump_training.planner import objectives
from discjump_training.policy import Layout

#: In place of value networks: the task's own objective, without any.
NO_VALUE = "none"


@dataclass(frozen=True)
class Team:
    """What plans.

    Attributes:
        guides: models (files, folders of runs) or one script by name; empty: none.
        values: models whose value networks judge; empty: the task's objective.
        options: of the environments.
    """

    guides: tuple[str, ...]
    values: tuple[str, ...]
    options: dict[str, Any]
    _networks: who.Networks | None
    _value: who.Networks | None

    @classmethod
    def of(cls, task: Task, names: Sequence[str], values: Sequence[str] | None) -> "Team":
        """The team of these names.

        Args:
            task: to be planned for.
            names: of guides.
            values: of models; None: the guides, where they are models.

        Raises:
            TrainingError: if somebody cannot be had, or they need different observations.
        """
        scripts = [name for name in names if name in baselines.NAMES]
        if scripts and len(names) > 1:
            raise TrainingError(f"model: expected models, or one script alone, got {', '.join(names)}")
        if values is None:
            values = [] if scripts else list(names)
        networks = value = None
        options: dict[str, Any] = {}
        if scripts:
            options = who.script(task, scripts[0])
        elif names:
            networks, options = who.load(list(names))
        if values:
            value, theirs = who.load(list(values))
            if names and theirs != options:
                raise TrainingError(
                    f"value: expected a model of the options {options}, as {names[0]} needs them, "
                    f"got {theirs}"
                )
            options = theirs
        return cls(tuple(names), tuple(values), options, networks, value)

    def guide(self, env: Any) -> who.Guide | None:
        """The guide for these environments."""
        if self._networks is not None:
            return self._networks
        return who.Scripts(self.guides[0], who.Sight(env)) if self.guides else None

    def objective(self, task: Task, env: Any, name: str = "task") -> Any:
        """The objective in these environments; `name`: one of `settings.OBJECTIVES`."""
        if self._value is not None:
            return objectives.Rewards(self._value.gamma, self._value.value)
        if name == "rewards":
            return objectives.Rewards()
        return objectives.make(task.name, Layout.of(env.observation_layout), env.options)

    def check(self, env: Any) -> None:
        """Refuse environments that the models do not fit.

        Raises:
            ModelError: naming both spaces.
        """
        for name in dict.fromkeys([*self.guides, *self.values]):
            if name not in baselines.NAMES:
                who.load([name], env)
