"""Python callables: `obs -> action`, or a factory that makes one."""

import hashlib
import importlib
import inspect
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.judge.policies.candidate import Candidate
from discjump_training.policy import Actions, Mask, Observations


def imported(name: str) -> Candidate:
    """The callable `package.module:function`; the working directory is searched, too.

    Raises:
        ModelError: there is no such module or function, or its import fails; says how.
    """
    place, _, attribute = name.partition(":")
    here = str(Path.cwd())
    if here not in sys.path:
        sys.path.insert(0, here)
    try:
        module = importlib.import_module(place)
    # Importing runs the user's code: whatever it raises is theirs to mend.
    except Exception as error:
        raise ModelError(f"{name}: cannot import {place}: {type(error).__name__}: {error}") from error
    found: Any = module
    for part in attribute.split("."):
        try:
            found = getattr(found, part)
        except AttributeError:
            raise ModelError(f"{name}: the module {place} has no {attribute}") from None
    if not callable(found):
        raise ModelError(f"{name}: expected a callable obs -> action, got {type(found).__name__}")
    made = from_function(found, name)
    source = getattr(module, "__file__", None)
    content = Path(source).read_bytes() if source else b""
    identity = hashlib.blake2b(content + name.encode(), digest_size=16).hexdigest()
    return Candidate(name, "function", made.make, made.needs, identity)


def from_function(function: Callable[..., Any], name: str | None = None) -> Candidate:
    """A candidate from a callable.

    Args:
        function: `obs -> action`, or a factory: callable without arguments, it returns such a callable, which
            may have `reset(done)` as `policy.Policy` has. Observations are (n, size) and actions (n, k) where
            it takes that; else it is called for one observation (size,) at a time. An attribute `batched`
            (True or False) decides it. An attribute `options` (a dict) names options of the environment.
        name: in tables; its own by default.
    """
    called = name or str(getattr(function, "__qualname__", type(function).__name__))
    needs = dict(getattr(function, "options", None) or {})
    identity = hashlib.blake2b(repr((called, id(function))).encode(), digest_size=16).hexdigest()
    return Candidate(called, "function", lambda stage: Function(function, called, stage), needs, identity)


def takes_nothing(function: Callable[..., Any]) -> bool:
    """Whether it can be called without arguments and with none of its own: a factory."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return False
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return not any(
        one.kind is inspect.Parameter.VAR_POSITIONAL or (one.kind in positional and one.default is one.empty)
        for one in parameters
    )


class Function:
    """What a callable does.

    Args:
        function: see `from_function`.
        name: in tables.
        stage: where it will play.

    Raises:
        ModelError: a factory fails, or makes nothing that can be called.
    """

    note = "function"

    def __init__(self, function: Callable[..., Any], name: str, stage: Stage) -> None:
        self.name = name
        self._factory = function if takes_nothing(function) else None
        self._function = function
        space = stage.env.single_action_space
        self._width = int(np.prod(space.shape or ()))
        self._space = space
        self._batched: bool | None = None
        if self._factory is not None:
            self._make()

    def begin(self, rows: range) -> None:
        """Other episodes are played next: a factory makes another policy for them."""
        if self._factory is not None:
            self._make()

    def reset(self, done: Mask) -> None:
        """Tell it, if it wants to know."""
        told = getattr(self._function, "reset", None)
        if callable(told):
            self._call(told, done)

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations.

        Raises:
            ModelError: it raises something itself, or what it returns are no actions of the environment.
        """
        if self._batched is None:
            self._batched = self._takes_batches(observations)
        if self._batched:
            actions = self._call(self._function, observations)
        else:
            actions = [self._call(self._function, one) for one in observations]
        return self._checked(actions, len(observations))

    def _make(self) -> None:
        assert self._factory is not None
        made = self._call(self._factory)
        if not callable(made):
            raise ModelError(
                f"{self.name}: called without arguments it should make a policy, "
                f"it made {type(made).__name__}"
            )
        self._function = made
        said = getattr(made, "batched", getattr(self._factory, "batched", None))
        self._batched = None if said is None else bool(said)

    def _takes_batches(self, observations: Observations) -> bool:
        said = getattr(self._function, "batched", None)
        if said is not None:
            return bool(said)
        try:
            return bool(np.shape(self._function(observations)) == (len(observations), self._width))
        except Exception:
            # It may be meant for one observation: if not, what it raises then is told.
            return False

    def _call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        try:
            return function(*arguments)
        except Exception as error:
            raise ModelError(f"{self.name} raised {type(error).__name__}: {error}") from error

    def _checked(self, actions: Any, count: int) -> Actions:
        try:
            table: NDArray[Any] = np.asarray(actions)
        except ValueError:
            table = np.zeros(0)
        if table.shape != (count, self._width) or table.dtype.kind not in "iubf":
            raise ModelError(
                f"{self.name}: expected actions of shape ({count}, {self._width}) in {self._space}, "
                f"got {table.dtype} of shape {table.shape}"
            )
        if self._space.dtype is not None and self._space.dtype.kind == "i":
            if not (np.equal(np.mod(table, 1), 0)).all():
                raise ModelError(
                    f"{self.name}: expected whole numbers as actions, got {table.dtype} with fractions"
                )
            table = table.astype(np.int64)
        else:
            table = table.astype(np.float32)
        for row, action in enumerate(table):
            if not self._space.contains(action.astype(self._space.dtype)):
                raise ModelError(
                    f"{self.name}: expected an action in {self._space}, got {action.tolist()} in row {row}"
                )
        return table
