"""The recipe of a training run: everything that decides its outcome except the seed, typed and explained.

A recipe is a TOML file with the sections below. Fields left out take their defaults; fields that are
unknown, of the wrong type or out of range are refused by name.
"""

import json
import tomllib
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from discjump.envs.options import FAN_BEARINGS, FAN_RANGES, REWARD, SkiOptions
from discjump.terrains import SURFACES
from discjump_training.courses import COURSES
from discjump_training.errors import RecipeError

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(gt=0)]
Share = Annotated[float, Field(ge=0, le=1)]


class Section(BaseModel):
    """Common to all sections: no unknown fields, no silent conversion of types, no changes after loading."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Reward(Section):
    """Weights of the terms of the reward."""

    progress: float = Field(
        REWARD["progress"], description="per metre by which the distance to the beacon shrank"
    )
    time: float = Field(REWARD["time"], description="per second of the episode")
    arrival: float = Field(REWARD["arrival"], description="once, on reaching the beacon")


class Environment(Section):
    """What the agent is trained in."""

    course: str = Field("ski-train-v1", description="course whose terrains are trained on")
    fidelity: str = Field("authentic", description="fidelity tier of the physics")
    tick_ms: Count = Field(SkiOptions.tick_ms, description="length of a tick, milliseconds")
    surface: str = Field(SURFACES[0], description="what lies between the heights: triangles or bilinear")
    frame_skip: Count = Field(4, description="ticks per decision")
    fan_bearings: list[float] = Field(
        list(FAN_BEARINGS),
        description="bearings of the fan (rise of the terrain over range, dimensionless), degrees, 0 ahead, "
        "positive left; empty: no fan",
    )
    fan_ranges: list[float] = Field(
        list(FAN_RANGES),
        description="ranges of the fan, metres; empty: no fan",
    )
    landing: bool = Field(True, description="observe features of the ballistic landing")
    reward: Reward = Field(Reward(), description="weights of the terms of the reward")

    @model_validator(mode="after")
    def _course_exists(self) -> Self:
        if self.course not in COURSES:
            raise ValueError(f"course: no course is named {self.course!r}; there are {', '.join(COURSES)}")
        return self

    @model_validator(mode="after")
    def _fan_is_whole(self) -> Self:
        if bool(self.fan_bearings) != bool(self.fan_ranges):
            raise ValueError("fan_bearings and fan_ranges: either both are empty (no fan) or neither is")
        return self

    @model_validator(mode="after")
    def _environment_takes_it(self) -> Self:
        try:
            SkiOptions.from_keywords(self.kwargs())
        except (TypeError, ValueError) as error:
            raise ValueError(str(error)) from None
        return self

    def kwargs(self) -> dict[str, Any]:
        """Keyword arguments of `discjump/Ski-v0`, terrains excepted."""
        return self.model_dump(exclude={"course"})


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


class Watch(Section):
    """What is measured and kept on the way."""

    evaluate_every: Count = Field(
        1_000_000, description="decisions between two evaluations on validation courses"
    )
    evaluate_course: str = Field("ski-validation-v1", description="course on which the best model is chosen")
    evaluate_episodes: Count = Field(256, description="episodes per evaluation, greedy actions")
    checkpoint_every: Count = Field(2_000_000, description="decisions between two checkpoints")
    keep_checkpoints: Count = Field(3, description="checkpoints kept; older ones are deleted")

    @model_validator(mode="after")
    def _course_has_them(self) -> Self:
        course = COURSES.get(self.evaluate_course)
        if course is None:
            raise ValueError(
                f"evaluate_course: no course is named {self.evaluate_course!r}; "
                f"there are {', '.join(COURSES)}"
            )
        if self.evaluate_episodes > course.episodes:
            raise ValueError(f"evaluate_episodes: {course.name} has {course.episodes} episodes")
        return self


class Recipe(Section):
    """Everything that decides the outcome of a training run except its seed."""

    environment: Environment = Field(Environment(), description="what the agent is trained in")
    rollout: Rollout = Field(Rollout(), description="how experience is collected")
    ppo: PPO = Field(PPO(), description="the learning algorithm")
    watch: Watch = Field(Watch(), description="what is measured and kept on the way")

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
            source: path of a TOML file, or the name of a recipe that ships with the package.
            overrides: `section.field=value` strings, the value in TOML's syntax.

        Raises:
            RecipeError: if the file cannot be read or a field does not fit.
        """
        text, where = _read(source)
        try:
            data = tomllib.loads(text)
            for override in overrides:
                _merge(data, _parse_override(override))
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
                field = ".".join(str(part) for part in fault["loc"]) or "recipe"
                given = "" if fault["type"] in ("missing", "value_error") else f", got {fault['input']!r}"
                message = fault["msg"].removeprefix("Value error, ")
                if fault["type"] == "extra_forbidden":
                    message, given = f"unknown field; {_known_fields(cls, fault['loc'])}", ""
                lines.append(f"  {field}: {message}{given}")
            raise RecipeError("\n".join(lines)) from None

    def with_steps(self, steps: int) -> Self:
        """The same recipe with another number of decisions."""
        return self.parse(_merge(self.model_dump(), {"ppo": {"steps": steps}}), "--steps")

    def to_toml(self, *, help: bool = False) -> str:
        """This recipe as TOML; with `help`, each field's explanation stands above it."""
        return "\n".join(_toml_lines(self, "", help)).lstrip("\n") + "\n"


def names() -> list[str]:
    """Names of the recipes that ship with the package."""
    folder = resources.files("discjump_training").joinpath("recipes")
    return sorted(
        entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")
    )


def _read(source: str | Path) -> tuple[str, str]:
    if isinstance(source, str) and source in names():
        entry = resources.files("discjump_training").joinpath("recipes", f"{source}.toml")
        return entry.read_text(encoding="utf-8"), f"recipe {source}"
    try:
        return Path(source).read_text(encoding="utf-8"), str(source)
    except (OSError, UnicodeDecodeError) as error:
        known = ", ".join(names())
        raise RecipeError(f"cannot read the recipe {source}: {error}; recipes by name: {known}") from None


def _parse_override(text: str) -> dict[str, Any]:
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise RecipeError(f"expected section.field=value, got {text!r}")
    try:
        return tomllib.loads(f"{key.strip()} = {value.strip()}")
    except tomllib.TOMLDecodeError as error:
        raise RecipeError(
            f"{text!r}: the value must be written as in TOML (strings in quotes): {error}"
        ) from None


def _merge(into: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    for key, value in new.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            _merge(into[key], value)
        else:
            into[key] = value
    return into


def _known_fields(model: type[BaseModel], location: tuple[int | str, ...]) -> str:
    for part in location[:-1]:
        annotation = model.model_fields[str(part)].annotation
        assert isinstance(annotation, type)
        assert issubclass(annotation, BaseModel)
        model = annotation
    return f"known are {', '.join(model.model_fields)}"


def _toml_lines(section: BaseModel, prefix: str, help: bool) -> list[str]:
    lines: list[str] = []
    nested: list[str] = []
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if isinstance(value, BaseModel):
            comment = [f"# {field.description}"] if help else []
            nested += ["", *comment, f"[{prefix}{name}]", *_toml_lines(value, f"{prefix}{name}.", help)]
            continue
        if help:
            lines.append(f"# {field.description}")
        # JSON's spelling of numbers, strings, booleans and lists is TOML's too.
        lines.append(f"{name} = {json.dumps(value)}")
    return lines + nested
