"""The recipe of a training run: everything that decides its outcome except the seed, typed and explained.

A recipe is a TOML file with the sections below. It names its task; its section `environment` holds options
of that task's environment. Fields left out take their defaults; fields that are unknown, of the wrong type
or out of range are refused by name.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from discjump.envs.tasks import TASKS, Task
from discjump_training import recipe_file
from discjump_training.courses import COURSES, Course
from discjump_training.errors import RecipeError
from discjump_training.recipe_file import names

__all__ = ["PPO", "Environment", "Recipe", "Rollout", "Section", "Watch", "names"]

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(gt=0)]
Share = Annotated[float, Field(ge=0, le=1)]

#: Options that a recipe cannot set: what is trained on is its course's to say, so that no recipe can train on
#: the terrains that policies are judged on.
GROUND = ("terrain_seeds", "terrains")
#: Options that make learning easier: no policy is judged with them.
EASING = ("difficulty", "curriculum")


class Section(BaseModel):
    """Common to all sections: no unknown fields, no silent conversion of types, no changes after loading."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Environment(Section):
    """What the agent is trained in: the course, and every option of the task's environment that TOML can
    say, whether it was given or not.
    """

    model_config = ConfigDict(extra="allow", frozen=True, strict=True)

    course: str = Field("ski-train-v1", description="course whose terrains are trained on")

    def kwargs(self) -> dict[str, Any]:
        """Keyword arguments of the task's environment, terrains excepted."""
        return self.model_dump(exclude={"course"})

    def judged(self) -> dict[str, Any]:
        """The same for those that policies are judged in: at the task's own difficulty, whatever they learn
        from.
        """
        return at_full(self.kwargs())


class Rollout(Section):
    """How experience is collected."""

    num_envs: Count = Field(1_024, description="environments stepped together")
    n_steps: Count = Field(64, description="decisions per environment between two updates")
    threads: Count = Field(1, description="threads of the simulator; does not change the result")


class PPO(Section):
    """Proximal policy optimisation, as in stable-baselines3."""

    steps: Count = Field(14_000_000, description="decisions in the whole run, over all environments")
    learning_rate: Positive = Field(1e-3, description="of Adam, at the start")
    final_learning_rate: Positive = Field(1e-4, description="of Adam, at the end; linear in between")
    batch_size: Count = Field(16_384, description="decisions per gradient step")
    n_epochs: Count = Field(4, description="passes over the collected experience per update")
    gamma: Share = Field(0.995, description="discount per decision")
    gae_lambda: Share = Field(0.95, description="decay of the generalised advantage estimate")
    clip_range: Positive = Field(0.2, description="clipping of the probability ratio")
    ent_coef: Annotated[float, Field(ge=0)] = Field(0.003, description="weight of the entropy bonus")
    vf_coef: Positive = Field(0.5, description="weight of the value loss")
    max_grad_norm: Positive = Field(0.5, description="largest norm of a gradient")
    hidden: list[Count] = Field(
        [64, 64], description="widths of the hidden layers of policy and value network"
    )
    activation: Literal["tanh", "relu"] = Field("tanh", description="activation of the hidden layers")
    joint: bool = Field(
        False, description="forward, strafe, jump and jet are one choice of 36 in place of four choices"
    )


class Watch(Section):
    """What is measured and kept on the way."""

    evaluate_every: Count = Field(
        1_000_000, description="decisions between two evaluations on validation courses"
    )
    evaluate_course: str = Field("ski-validation-v1", description="course on which the best model is chosen")
    evaluate_episodes: Count = Field(256, description="episodes per evaluation, greedy actions")
    checkpoint_every: Count = Field(2_000_000, description="decisions between two checkpoints")
    keep_checkpoints: Count = Field(3, description="checkpoints kept; older ones are deleted")


class Recipe(Section):
    """Everything that decides the outcome of a training run except its seed."""

    task: str = Field("ski", description="what is learned: the short name of a task")
    environment: Environment = Field(Environment(), description="what the agent is trained in")
    rollout: Rollout = Field(Rollout(), description="how experience is collected")
    ppo: PPO = Field(PPO(), description="the learning algorithm")
    watch: Watch = Field(Watch(), description="what is measured and kept on the way")

    @model_validator(mode="before")
    @classmethod
    def _for_its_task(cls, data: Any) -> Any:
        """Fill in what depends on the task: courses, and the options of its environment."""
        if not isinstance(data, Mapping):
            return data
        task = TASKS.get(data.get("task", "ski"))
        if task is None:
            raise ValueError(f"task: expected one of {', '.join(TASKS)}, got {data['task']!r}")
        filled = dict(data)
        for name, kind, field in (
            ("environment", "train", "course"),
            ("watch", "validation", "evaluate_course"),
        ):
            section = data.get(name, {})
            if isinstance(section, Mapping):
                filled[name] = {**section, field: section.get(field) or f"{task.name}-{kind}-v1"}
        if isinstance(filled["environment"], Mapping):
            filled["environment"] = _with_options(task, filled["environment"])
        return filled

    @model_validator(mode="after")
    def _courses_are_the_tasks(self) -> Self:
        _course(self.task, "environment.course", self.environment.course)
        course = _course(self.task, "watch.evaluate_course", self.watch.evaluate_course)
        if self.watch.evaluate_episodes > course.episodes:
            raise ValueError(f"watch.evaluate_episodes: {course.name} has {course.episodes} episodes")
        return self

    @model_validator(mode="after")
    def _keys_are_bins(self) -> Self:
        if self.ppo.joint and self.environment.kwargs()["actions"] != "multi_discrete":
            raise ValueError('ppo.joint: needs environment.actions = "multi_discrete"')
        return self

    @model_validator(mode="after")
    def _batches_divide(self) -> Self:
        collected = self.rollout.num_envs * self.rollout.n_steps
        if collected % self.ppo.batch_size:
            raise ValueError(
                f"ppo.batch_size: must divide rollout.num_envs * rollout.n_steps = {collected}, "
                f"got {self.ppo.batch_size}"
            )
        return self

    @classmethod
    def load(cls, source: str | Path, overrides: tuple[str, ...] = ()) -> Self:
        """Read a recipe from a TOML file, or from the package by name (`ski`).

        Args:
            source: path of a TOML file, or the name of a recipe that ships with the package, or of a task:
                where no recipe has its name, all fields take their defaults.
            overrides: `section.field=value` strings, the value in TOML's syntax.

        Raises:
            RecipeError: if the file cannot be read or a field does not fit.
        """
        if source in TASKS and source not in names():
            text, where = f'task = "{source}"', f"recipe {source}"
        else:
            text, where = recipe_file.read(source)
        try:
            data = tomllib.loads(text)
            for override in overrides:
                recipe_file.merge(data, recipe_file.parse_override(override))
        except tomllib.TOMLDecodeError as error:
            raise RecipeError(f"{where} is not TOML: {error}") from None
        return cls.parse(data, where)

    @classmethod
    def parse(cls, data: dict[str, Any], where: str) -> Self:
        """Check a recipe that was already read; `where` names its origin in errors."""
        try:
            return cls.model_validate(data)
        except ValidationError as error:
            lines = [f"{where} does not fit a recipe:"]
            for fault in error.errors():
                field = "".join(f"{part}." for part in fault["loc"])[:-1]
                given = "" if fault["type"] in ("missing", "value_error") else f", got {fault['input']!r}"
                message = fault["msg"].removeprefix("Value error, ")
                if fault["type"] == "extra_forbidden":
                    message, given = f"unknown field; {_known_fields(cls, fault['loc'])}", ""
                lines.append(f"  {field}{': ' if field else ''}{message}{given}")
            raise RecipeError("\n".join(lines)) from None

    def with_steps(self, steps: int) -> Self:
        """The same recipe with another number of decisions."""
        return self.parse(recipe_file.merge(self.model_dump(), {"ppo": {"steps": steps}}), "--steps")

    def to_toml(self, *, help: bool = False) -> str:
        """This recipe as TOML; with `help`, each field's explanation stands above it."""
        options = TASKS[self.task].options
        return "\n".join(recipe_file.lines(self, "", help, options)).lstrip("\n") + "\n"


def at_full(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of an environment without those that ease learning.

    >>> at_full({"armor": "light", "curriculum": True})
    {'armor': 'light'}
    """
    return {name: value for name, value in options.items() if name not in EASING}


def _with_options(task: Task, section: Mapping[str, Any]) -> dict[str, Any]:
    """The section `environment` with every option that TOML can say, as the task's own class has it."""
    given = {name: value for name, value in section.items() if name != "course"}
    for name in GROUND:
        if name in given:
            raise ValueError(f"environment: {name}: the course says which terrains are trained on")
    try:
        options = task.options.from_keywords(given)
    except (TypeError, ValueError) as error:
        raise ValueError(f"environment: {error}") from None
    said = {field.name: _plain(getattr(options, field.name)) for field in fields(options)}
    return {"course": section["course"]} | {
        name: value for name, value in said.items() if name not in GROUND and value is not None
    }


def _plain(value: object) -> Any:
    """As TOML has it: lists for tuples; None for what it cannot say."""
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Mapping):
        inner = {str(key): _plain(part) for key, part in value.items()}
        return None if None in inner.values() else inner
    if isinstance(value, list | tuple):
        parts = [_plain(part) for part in value]
        return None if None in parts else parts
    return None


def _course(task: str, field: str, name: str) -> Course:
    course = COURSES.get(name)
    if course is None or course.task != task:
        known = ", ".join(one.name for one in COURSES.values() if one.task == task) or "none"
        raise ValueError(f"{field}: no course of {task} is named {name!r}; there are {known}")
    return course


def _known_fields(model: type[BaseModel], location: tuple[int | str, ...]) -> str:
    for part in location[:-1]:
        annotation = model.model_fields[str(part)].annotation
        assert isinstance(annotation, type)
        assert issubclass(annotation, BaseModel)
        model = annotation
    return f"known are {', '.join(model.model_fields)}"
