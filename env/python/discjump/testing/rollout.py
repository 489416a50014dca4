"""Rollouts: what was done to an environment and what it returned, and where two of them part."""

import copy
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from gymnasium import Space
from gymnasium.vector.utils import concatenate, create_empty_array
from numpy.typing import NDArray

from discjump.testing.trees import Difference, difference, frozen, row, take, without

CORE = ("observation", "reward", "terminated", "truncated")
FIELDS = (*CORE, "info")


@dataclass(frozen=True)
class Frame:
    """One call and copies of what it returned; `reward` and flags are None for a reset.

    `ended` is (num_envs,) bool, terminated or truncated; `mask` the reset mask of a partial reset; `returned`
    the very objects that came back, in the order of `FIELDS`.
    """

    call: Literal["reset", "step"]
    observation: Any
    info: dict[str, Any]
    returned: tuple[Any, ...]
    reward: Any = None
    terminated: Any = None
    truncated: Any = None
    mask: NDArray[np.bool_] | None = None

    @property
    def ended(self) -> NDArray[np.bool_]:
        """(num_envs,): which episodes ended in this call."""
        return np.asarray(np.logical_or(self.terminated, self.truncated))


@dataclass
class Rollout:
    """Frames from a reset on; environment i of the batch has the seed `seeds[i]`."""

    seeds: tuple[int, ...]
    frames: list[Frame] = field(default_factory=list)

    @property
    def steps(self) -> list[Frame]:
        """The frames of steps."""
        return [frame for frame in self.frames if frame.call == "step"]

    def ends(self) -> list[tuple[int, NDArray[np.bool_]]]:
        """Frames in which an episode ended: their index, and of which environments, (num_envs,) bool."""
        return [(at, f.ended) for at, f in enumerate(self.frames) if f.call == "step" and f.ended.any()]


class Actions:
    """Random actions of a space, the same for the same stream and step.

    Each stream is drawn from a copy of the single action space seeded with the stream's number, so an
    environment's actions are known from its seed alone, wherever it stands in a batch.
    """

    def __init__(self, single_space: Space[Any]) -> None:
        self.space = single_space
        self._streams: dict[int, tuple[Space[Any], list[Any]]] = {}

    def one(self, stream: int, step: int) -> Any:
        """The action of this stream at this step."""
        if stream not in self._streams:
            space = copy.deepcopy(self.space)
            space.seed(stream)
            self._streams[stream] = (space, [])
        space, drawn = self._streams[stream]
        while len(drawn) <= step:
            drawn.append(space.sample())
        return drawn[step]

    def batch(self, streams: Sequence[int], step: int) -> Any:
        """The actions of these streams at this step as an element of the batched space, in memory of its
        own."""
        items = [self.one(stream, step) for stream in streams]
        # Spaces that batch to a tuple of items would hand out the drawn ones themselves.
        empty: Any = create_empty_array(self.space, n=len(items))
        return frozen(concatenate(self.space, items, empty))


@dataclass(frozen=True)
class Parting:
    """Where two rollouts part: index of the call (0 is the reset), environment, field, and both values."""

    call: int
    kind: str
    environment: int | None
    field: str
    at: Difference

    def __str__(self) -> str:
        where = "" if self.environment is None else f", environment {self.environment}"
        path = f"{self.field}{self.at.path}"
        return f"call {self.call} ({self.kind}){where}, {path}: {self.at.left} against {self.at.right}"


def parting(
    left: Rollout,
    right: Rollout,
    rows: Sequence[tuple[int, int]] | None = None,
    ignored: frozenset[str] = frozenset(),
    fields: Sequence[str] = FIELDS,
    prefix: bool = False,
) -> Parting | None:
    """The first call and environment in which two rollouts differ in any bit, or None.

    Args:
        left, right: rollouts of the same calls.
        rows: pairs (environment of left, environment of right); None: all, each with itself, and everything
            in `info` that belongs to no environment as well. Resets of other environments alone are passed
            over.
        ignored: keys of info that are not compared, dotted.
        fields: what is compared.
        prefix: whether one may be longer.
    """
    if rows is None:
        found = _parting(list(enumerate(left.frames)), right.frames, None, ignored, fields)
        if found is None and not prefix and len(left.frames) != len(right.frames):
            lengths = Difference("", f"{len(left.frames)} calls", f"{len(right.frames)} calls")
            return Parting(min(len(left.frames), len(right.frames)), "end", None, "rollout", lengths)
        return found
    if any(frame.mask is not None for frame in (*left.frames, *right.frames)):
        every = [
            _parting(_calls_of(left, i), [f for _, f in _calls_of(right, j)], [(i, j)], ignored, fields)
            for i, j in rows
        ]
        return min(
            (found for found in every if found is not None), key=lambda found: found.call, default=None
        )
    return _parting(list(enumerate(left.frames)), right.frames, rows, ignored, fields)


def info_of(info: dict[str, Any], index: int) -> dict[str, Any]:
    """What `info` says of one environment: keys whose `_key` mask leaves it out are absent."""
    own: dict[str, Any] = {}
    for key, value in info.items():
        if key.startswith("_") and key[1:] in info:
            continue
        mask = info.get(f"_{key}")
        if isinstance(mask, np.ndarray) and not mask[index]:
            continue
        own[key] = info_of(value, index) if isinstance(value, dict) else row(value, index)
    return own


def _calls_of(rollout: Rollout, index: int) -> list[tuple[int, Frame]]:
    """The calls that touched one environment."""
    return [(at, f) for at, f in enumerate(rollout.frames) if f.mask is None or f.mask[index]]


def _parting(
    left: list[tuple[int, Frame]],
    right: list[Frame],
    rows: Sequence[tuple[int, int]] | None,
    ignored: frozenset[str],
    fields: Sequence[str],
) -> Parting | None:
    for (index, one), other in zip(left, right, strict=False):
        if one.call != other.call:
            return Parting(index, one.call, None, "call", Difference("", one.call, other.call))
        for name in fields:
            found = _field_parting(name, getattr(one, name), getattr(other, name), rows, ignored)
            if found is not None:
                return Parting(index, one.call, found[0], name, found[1])
    return None


def _field_parting(
    name: str, left: Any, right: Any, rows: Sequence[tuple[int, int]] | None, ignored: frozenset[str]
) -> tuple[int | None, Difference] | None:
    if name == "info":
        left, right = without(left, ignored), without(right, ignored)
    if rows is None:
        found = difference(left, right)
        return None if found is None else (_environment(left, right, name), found)
    if difference(take(left, [i for i, _ in rows]), take(right, [j for _, j in rows])) is None:
        return None
    for i, j in rows:
        pair = (info_of(left, i), info_of(right, j)) if name == "info" else (row(left, i), row(right, j))
        found = difference(*pair)
        if found is not None:
            return i, found
    return None


def _environment(left: Any, right: Any, name: str) -> int | None:
    """The environment of a difference, where the first axis of an array says it."""
    if name == "info" or not isinstance(left, np.ndarray) or left.shape != np.shape(right) or not left.ndim:
        return None
    for index in range(len(left)):
        if difference(left[index], right[index]) is not None:
            return index
    return None
