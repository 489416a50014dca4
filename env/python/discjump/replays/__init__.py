"""Replays: files that are enough to play an episode, or ticks of a simulator, again bit for bit.

    bare             plays plain data by public names alone, in any installation
    file             magic, schema, checksum, compression
    grounds          terrains as plain data
    digests, tape    what is written down while an episode is played
    replay           what both kinds share
    episode          an environment's episode
    ticks            a simulator's ticks
    recorder, vector_recorder    wrappers that record; shelf: where their replays go
    mismatch         where a replay and its repetition part
    card, picture, command    `discjump replay`

Arrows point down only: command -> card, picture, recorders -> episode, ticks -> replay -> file, tape -> bare.

>>> import gymnasium, numpy, discjump
>>> env = record(gymnasium.make("discjump/Ski-v0", terrain_seeds=[0], time_limit=0.5))
>>> observation, info = env.reset(seed=7)
>>> for _ in range(4):
...     step = env.step(numpy.array([2, 1, 1, 0, 3]))
>>> env.replays[0].verify() is None
True
"""

from pathlib import Path

from discjump.replays import file
from discjump.replays.episode import EpisodeReplay
from discjump.replays.errors import ReplayError
from discjump.replays.mismatch import Mismatch
from discjump.replays.recorder import Recorder
from discjump.replays.replay import Arrays, Header, Replay
from discjump.replays.ticks import TickReplay
from discjump.replays.vector_recorder import VectorRecorder, record

KINDS: dict[str, type[Replay]] = {kind.KIND: kind for kind in (EpisodeReplay, TickReplay)}


def load(path: str | Path) -> Replay:
    """The replay in a file: an `EpisodeReplay` or a `TickReplay`. Nothing that is in the file is run.

    Raises:
        ReplayError: no replay, a damaged one, or one of a newer schema; says which.
        OSError: the file cannot be read.
    """
    return of(*file.read(path), str(path))


def loads(data: bytes, name: str = "replay") -> Replay:
    """The same of bytes; `name` stands in messages."""
    return of(*file.unpack(data, name), name)


def of(header: Header, arrays: Arrays, name: str = "replay") -> Replay:
    """The replay of a file's header and arrays."""
    kind = KINDS.get(str(header.get("kind")))
    if kind is None:
        raise ReplayError(f"{name}: expected the replay of an {' or a '.join(KINDS)}, got another kind")
    try:
        return kind(header, arrays)
    except ReplayError as error:
        raise ReplayError(f"{name}: {error}") from None


__all__ = [
    "EpisodeReplay",
    "Mismatch",
    "Recorder",
    "Replay",
    "ReplayError",
    "TickReplay",
    "VectorRecorder",
    "load",
    "loads",
    "record",
]
