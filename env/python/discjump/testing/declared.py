"""Environments that a project declares for `pytest --discjump-verify`, and its settings.

A line of the ini setting `discjump_envs`, or the value of `--discjump-env`, is a target and words
`key=value`:

    CartPole-v1
    CartPole-v1 vectorization_mode=async autoreset_mode=SameStep
    discjump:discjump/Ski-v0 frame_skip=1
    my_package.envs:make_env size=3 skip=seeds_differ,close_twice steps=2000

A target is an id for `gymnasium.make_vec`, with `module:` before it if it must be imported first, or
`module:name` of a factory, which is called with the number of environments. `skip`, `ignore_info` (both by
commas), `num_envs`, `steps`, `seed`, `timeout` and `strict` are settings of `check_vector_env` for this
environment alone; all other words go to the environment, as Python literals or else as text.
"""

import ast
import importlib
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import gymnasium
import pytest

from discjump.testing.subject import Factory

LISTS = ("skip", "ignore_info")
NUMBERS: dict[str, Callable[[str], float]] = {"num_envs": int, "steps": int, "seed": int, "timeout": float}

FACTORY = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_][\w.]*")
"""`module:name`; no id of gymnasium, whose names end with a version, looks like it."""

OF_VECTOR = ("autoreset_mode", "copy", "shared_memory", "context", "observation_mode")
"""Words that SyncVectorEnv and AsyncVectorEnv take; `make_vec` has them in a dict of their own."""

_KEY = pytest.StashKey[dict[str, "Declared"]]()


@dataclass(frozen=True)
class Declared:
    """A declared environment: its text, how to find its factory, and settings of its own."""

    name: str
    find: Callable[[], Factory]
    settings: dict[str, Any] = field(default_factory=dict)

    def factory(self) -> Factory:
        """The factory; imports the project's module."""
        return self.find()


def parsed(line: str) -> Declared:
    """A line of `discjump_envs`.

    >>> parsed("my_package.envs:make_env size=3 skip=seeds_differ steps=2000").settings
    {'skip': ['seeds_differ'], 'steps': 2000}
    >>> parsed("CartPole-v1 autoreset_mode=SameStep vectorization_mode=sync").factory()(2)
    SyncVectorEnv(CartPole-v1, num_envs=2)
    >>> parsed("CartPole-v1 sync")
    Traceback (most recent call last):
    pytest.UsageError: discjump_envs: expected words key=value after 'CartPole-v1', got 'sync'
    """
    target, *words = shlex.split(line)
    settings: dict[str, Any] = {}
    options: dict[str, Any] = {}
    for word in words:
        key, equals, text = word.partition("=")
        if not equals or not key.isidentifier():
            raise pytest.UsageError(f"discjump_envs: expected words key=value after {target!r}, got {word!r}")
        if key in LISTS:
            settings[key] = text.split(",")
        elif key in NUMBERS:
            settings[key] = _number(f"discjump_envs: {target}: {key}", text, NUMBERS[key])
        elif key == "strict":
            settings[key] = _literal(text)
        else:
            options[key] = _literal(text)
    find = _factory if FACTORY.fullmatch(target) else _id
    return Declared(" ".join([target, *words]), partial(find, target, options), settings)


def of(config: pytest.Config) -> dict[str, Declared]:
    """All declared environments by name: of the ini file, of `--discjump-env` and of the hook in
    conftest.py."""
    if _KEY not in config.stash:
        lines = [*config.getini("discjump_envs"), *config.getoption("--discjump-env")]
        every = [parsed(line) for line in lines if line.strip()]
        for given in config.hook.pytest_discjump_envs(config=config):
            if not isinstance(given, Mapping):
                got = type(given).__name__
                raise pytest.UsageError(
                    f"pytest_discjump_envs: expected a dict of factories by name, got {got}"
                )
            every += [Declared(name, partial(_given, name, factory)) for name, factory in given.items()]
        names = [one.name for one in every]
        twice = {name for name in names if names.count(name) > 1}
        if twice:
            raise pytest.UsageError(f"discjump_envs: declared twice: {', '.join(sorted(twice))}")
        if not every:
            raise pytest.UsageError(
                "no environment to verify: set discjump_envs in the ini file, define pytest_discjump_envs in "
                "conftest.py, or pass --discjump-env ID or --discjump-env MODULE:FACTORY"
            )
        config.stash[_KEY] = {one.name: one for one in every}
    return config.stash[_KEY]


def settings(config: pytest.Config) -> dict[str, Any]:
    """Keyword arguments of `check_vector_env` that the ini file and the command line set."""
    found: dict[str, Any] = {name: config.getini(f"discjump_{name}") for name in LISTS}
    for name, number in NUMBERS.items():
        text = config.getini(f"discjump_{name}")
        if text:
            found[name] = _number(f"discjump_{name}", text, number)
    found["strict"] = bool(config.getini("discjump_strict") or config.getoption("--discjump-strict"))
    return found


def _id(target: str, options: dict[str, Any]) -> Factory:
    """A factory by `gymnasium.make_vec`."""
    module, colon, name = target.rpartition(":")
    if colon:
        importlib.import_module(module)
    options = dict(options)
    spec = gymnasium.spec(name)
    mode = options.pop("vectorization_mode", "vector_entry_point" if spec.vector_entry_point else "sync")
    own: dict[str, Any] = {}
    if mode != "vector_entry_point":
        own = {key: options.pop(key) for key in OF_VECTOR if key in options}
    return lambda n: gymnasium.make_vec(
        name, n, vectorization_mode=mode, vector_kwargs=own or None, **options
    )


def _factory(target: str, options: dict[str, Any]) -> Factory:
    """A factory by its name in a module."""
    module, _, name = target.partition(":")
    found: Any = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found, part)
    return partial(found, **options) if options else found


def _given(name: str, factory: object) -> Factory:
    if not callable(factory):
        got = type(factory).__name__
        raise pytest.UsageError(f"pytest_discjump_envs: {name}: expected a factory, a callable, got {got}")
    return factory


def _literal(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return text


def _number(name: str, text: str, number: Callable[[str], float]) -> float:
    try:
        return number(text)
    except ValueError:
        raise pytest.UsageError(f"{name}: expected a number, got {text!r}") from None
