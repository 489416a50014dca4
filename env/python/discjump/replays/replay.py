"""What all replays share: a header and arrays, a file, and being played again."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from discjump._check import known
from discjump.replays import file
from discjump.replays.bare import build, codec, play, worker
from discjump.replays.errors import ReplayError
from discjump.replays.mismatch import Mismatch

Header = codec.Header
Arrays = codec.Arrays

ID = re.compile(r"discjump/[A-Za-z0-9_]+-v[0-9]+")
"""Ids that a replay may name: others could make gymnasium import a module of their choice."""

MOST_EPISODES = 2**24
"""Highest number of an episode: to reach one, all before it are begun."""


@dataclass(frozen=True, eq=False)
class Replay(ABC):
    """A recording: enough to play it again, and digests that tell whether it was the same.

    Attributes:
        header: what it is, as JSON has it.
        arrays: actions or inputs, digests and the final state by name.
    """

    header: Header
    arrays: Arrays

    #: Types that the header's entries must have.
    HEADER: ClassVar[dict[str, type]] = {
        "kind": str,
        "made": dict,
        "options": dict,
        "every": int,
        "fields": list,
    }
    #: Kind, dtype's kinds and dimensions that arrays must have.
    ARRAYS: ClassVar[dict[str, tuple[str, int]]] = {"digests.state": ("u", 2)}
    KIND = ""

    def __post_init__(self) -> None:
        """Check that nothing is missing, so that what reads it need not."""
        for name, kind in {**Replay.HEADER, **self.HEADER}.items():
            if name not in self.header or not isinstance(self.header[name], kind):
                raise ReplayError(f"replay: expected {name} in its header, got {self.header.get(name)!r:.80}")
        for name, (kinds, dimensions) in {**Replay.ARRAYS, **self.ARRAYS}.items():
            array = self.arrays.get(name)
            if array is None or array.dtype.kind not in kinds or array.ndim != dimensions:
                got = None if array is None else f"{array.dtype} of shape {array.shape}"
                raise ReplayError(f"replay: expected the array {name} in it, got {got}")
        if self.header["every"] < 1 or not isinstance(self.header["made"].get("discjump"), str):
            raise ReplayError("replay: expected who made it and how often it was digested, got neither")
        if not isinstance(self.header["options"].get("physics"), dict):
            raise ReplayError("replay: expected switches of the physics in its options, got none")

    @property
    def options(self) -> dict[str, Any]:
        """Options of the environment, or arguments of the simulator."""
        return dict(self.header["options"])

    @property
    def made(self) -> dict[str, Any]:
        """Versions and the way it was recorded; no bit depends on the latter."""
        return dict(self.header["made"])

    @abstractmethod
    def verify(self) -> Mismatch | None:
        """Play it again and compare: the first difference, None where there is none.

        Raises:
            ReplayError: this installation cannot play it; names what is needed.
        """

    def play(self, **way: Any) -> Iterator[play.Frame]:
        """Play it again, tick by tick; `way`: threads, lanes, batch and index as in `bare.play.Way`.

        Raises:
            ReplayError: this installation cannot play it; names what is needed.
        """
        try:
            yield from play.frames(self.header, self.arrays, play.Way(**way))
        except build.CannotBuild as error:
            raise ReplayError(str(error)) from error

    def changed(self, header: Mapping[str, Any] | None = None, arrays: Arrays | None = None) -> Self:
        """A copy with other entries of header or arrays."""
        return type(self)({**self.header, **(header or {})}, {**self.arrays, **(arrays or {})})

    def to_bytes(self) -> bytes:
        """Its file."""
        return file.pack(self.header, self.arrays)

    def save(self, path: str | Path) -> Path:
        """Write its file, with the folders that it lies in."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(self.to_bytes())
        return path

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.header.get('id', self.options.get('scene'))}, ...)"


def made_here(**way: Any) -> dict[str, Any]:
    """What records here; one version is package's and crate's."""
    here = worker.installation()
    here.pop("where")
    return {**here, **way}


def checked_options(options: Mapping[str, Any], names: Any) -> None:
    """Refuse options that this release does not know.

    Raises:
        ReplayError: names the first of them.
    """
    try:
        known("options", options, [*names])
    except ValueError as error:
        raise ReplayError(f"replay: this release does not know all of its {error}") from None


def hexadecimal(digest: Any) -> str:
    """A digest as one reads it."""
    return bytes(np.asarray(digest, np.uint8)).hex()
