"""Recipes as TOML: read, changed by hand, written with their explanations."""

import ast
import inspect
import json
import textwrap
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from discjump_training.errors import RecipeError


def names() -> list[str]:
    """Names of the recipes that ship with the package."""
    folder = resources.files("discjump_training").joinpath("recipes")
    return sorted(
        entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")
    )


def read(source: str | Path) -> tuple[str, str]:
    """The text of a recipe, and what to call it in errors.

    Raises:
        RecipeError: if it cannot be read.
    """
    if isinstance(source, str) and source in names():
        entry = resources.files("discjump_training").joinpath("recipes", f"{source}.toml")
        return entry.read_text(encoding="utf-8"), f"recipe {source}"
    try:
        return Path(source).read_text(encoding="utf-8"), str(source)
    except (OSError, UnicodeDecodeError) as error:
        known = ", ".join(names())
        raise RecipeError(f"cannot read the recipe {source}: {error}; recipes by name: {known}") from None


def parse_override(text: str) -> dict[str, Any]:
    """The change that `section.field=value` asks for, the value in TOML's syntax.

    >>> parse_override("ppo.gamma=0.99")
    {'ppo': {'gamma': 0.99}}
    """
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise RecipeError(f"expected section.field=value, got {text!r}")
    try:
        return tomllib.loads(f"{key.strip()} = {value.strip()}")
    except tomllib.TOMLDecodeError as error:
        raise RecipeError(
            f"{text!r}: the value must be written as in TOML (strings in quotes): {error}"
        ) from None


def merge(into: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """`into`, with what `new` says otherwise; tables are merged, everything else is replaced."""
    for key, value in new.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            merge(into[key], value)
        else:
            into[key] = value
    return into


def lines(section: BaseModel, prefix: str, help: bool, options: type | None = None) -> list[str]:
    """A section as lines of TOML; with `help`, each field's explanation stands above it.

    Args:
        section: of a recipe.
        prefix: names of the tables around it, with a dot at the end.
        help: explain.
        options: dataclass whose docstrings explain the fields that the section's own class does not know.
    """
    about = {name: field.description or "" for name, field in type(section).model_fields.items()}
    if options is not None:
        about = {**docstrings(options), **about}
    return _table(dict(section), prefix, about if help else None, options)


def _table(
    values: Mapping[str, Any], prefix: str, about: dict[str, str] | None, options: type | None
) -> list[str]:
    flat: list[str] = []
    nested: list[str] = []
    for name, value in values.items():
        text = about.get(name, "") if about is not None else ""
        comment = [f"# {line}" for line in textwrap.wrap(text, 100)]
        if isinstance(value, BaseModel):
            inner = lines(value, f"{prefix}{name}.", about is not None, options)
            nested += ["", *comment, f"[{prefix}{name}]", *inner]
        elif isinstance(value, Mapping):
            nested += ["", *comment, f"[{prefix}{name}]", *_table(value, f"{prefix}{name}.", None, None)]
        else:
            # JSON's spelling of numbers, strings, booleans and lists is TOML's too.
            flat += [*comment, f"{name} = {json.dumps(value)}"]
    return flat + nested


@cache
def docstrings(kind: type) -> dict[str, str]:
    """What the docstrings below the fields of a class say, in one line each; Python does not keep them.

    >>> from discjump.envs.options import SkiOptions
    >>> docstrings(SkiOptions)["time_limit"]
    'Length of an episode, s; it ends truncated.'
    """
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__[:-1]):
        (node,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
        assert isinstance(node, ast.ClassDef)
        for field, text in zip(node.body, node.body[1:], strict=False):
            if (
                isinstance(field, ast.AnnAssign)
                and isinstance(field.target, ast.Name)
                and isinstance(text, ast.Expr)
                and isinstance(text.value, ast.Constant)
                and isinstance(text.value.value, str)
            ):
                found[field.target.id] = " ".join(text.value.value.split())
    return found
