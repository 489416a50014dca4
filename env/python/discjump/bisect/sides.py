"""What is run on a side: a replay, what is changed in it, in which way, and by which installation."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from discjump import _check, replays
from discjump.replays import EpisodeReplay, Replay, ReplayError, TickReplay, grounds
from discjump.replays.bare import build, play
from discjump.replays.replay import MOST_EPISODES

WAYS = ("threads", "lanes", "batch", "index")
"""How a side is played: what must change no bit."""

EPISODE = ("seed", "episode")
FIXED = ("frame_skip", "tick_ms", "actions", "terrain_seeds", "terrains", "scene", "players_per_world")
"""What cannot be changed: ticks and actions of the two sides would not mean the same, or it is no word."""

ALONE = play.Way()

CROWD = 1024
"""Environments beside which one is played where threads are asked for and no batch: enough to be split."""

_CHANGE = re.compile(r"[a-z_]+(\.[a-z_]+)?=.*")


class SideError(ValueError):
    """A side that cannot be run; the message says why."""


@dataclass(frozen=True)
class Side:
    """One of the two runs.

    Attributes:
        text: what the user typed.
        replay: with the changes in it.
        way: in which it is played.
        python: interpreter of the installation that plays it; None: this one.
    """

    text: str
    replay: Replay
    way: play.Way = ALONE
    python: str | None = None

    @classmethod
    def parsed(cls, text: str, other: Side | None = None) -> Side:
        """A side from `FILE[,NAME=VALUE...]`; without FILE it is the other side's.

        >>> split("runs/a,b.replay,fidelity=fast,threads=3")
        ('runs/a,b.replay', {'fidelity': 'fast', 'threads': 3})

        Raises:
            SideError: no such change; says which there are.
            ReplayError, OSError: the file is no replay, or cannot be read.
        """
        path, changes = split(text)
        if path:
            replay = replays.load(Path(path))
        elif other is not None:
            replay = replays.load(split(other.text)[0])
        else:
            raise SideError(f"{text}: expected the file of a replay first")
        python = changes.pop("python", None)
        way = {name: changes.pop(name) for name in WAYS if name in changes}
        if "threads" in way and "batch" not in way:
            way["batch"] = CROWD
        return cls(text, changed(replay, changes), checked_way(way), None if python is None else str(python))


def split(text: str) -> tuple[str, dict[str, Any]]:
    """File and changes of a side; numbers, true, false and null are what JSON says, the rest are words."""
    parts = text.split(",")
    changes: dict[str, Any] = {}
    while parts and _CHANGE.fullmatch(parts[-1]):
        name, _, value = parts.pop().partition("=")
        try:
            changes[name] = json.loads(value)
        except ValueError:
            changes[name] = value
    return ",".join(parts), dict(reversed(changes.items()))


def checked_way(way: Mapping[str, Any]) -> play.Way:
    """How a side is played.

    Raises:
        SideError: a number that is out of range.
    """
    try:
        batch = _check.integer("batch", way.get("batch", 1), 1, 2**20)
        for name, most in (("threads", 256), ("lanes", 32), ("index", batch - 1)):
            if way.get(name) is not None:
                _check.integer(name, way[name], 0 if name == "index" else 1, most)
    except (TypeError, ValueError) as error:
        raise SideError(str(error)) from None
    return play.Way(way.get("threads"), way.get("lanes"), batch, way.get("index", batch // 2))


def changed(replay: Replay, changes: Mapping[str, Any]) -> Replay:
    """The replay with other options.

    Raises:
        SideError: no such option, or one that both sides must share.
    """
    options = {
        name: dict(value) if isinstance(value, dict) else value
        for name, value in replay.header["options"].items()
    }
    groups = {name: value for name, value in options.items() if isinstance(value, dict)}
    header: dict[str, Any] = {}
    for name, value in changes.items():
        group, _, switch = name.partition(".")
        if switch in groups.get(group, ()):
            groups[group][switch] = value
        elif name in EPISODE and isinstance(replay, EpisodeReplay):
            header[name] = _episode_number(name, value)
        elif name == "surface" and isinstance(replay, TickReplay):
            continue
        elif name in options and name not in (*FIXED, *groups):
            options[name] = value
        else:
            free = sorted({*options} - {*FIXED, *groups})
            free += [f"{group}.{key}" for group, keys in groups.items() for key in keys]
            also = (*EPISODE, *WAYS, "python") if isinstance(replay, EpisodeReplay) else (*WAYS, "python")
            raise SideError(f"{name}: expected one of {', '.join([*also, *free])}, got something else")
    made = replay.changed(header={**header, "options": options})
    if "surface" in changes:
        made = _resurfaced(made, str(changes["surface"]))
    return made


def _episode_number(name: str, value: object) -> int:
    try:
        return _check.integer(name, value, 0, _check.SEEDS - 1 if name == "seed" else MOST_EPISODES)
    except (TypeError, ValueError) as error:
        raise SideError(str(error)) from None


def _resurfaced(replay: Replay, surface: str) -> Replay:
    """The same on terrains of another surface, where the replay has them in it."""
    arrays = dict(replay.arrays)
    try:
        if isinstance(replay, TickReplay):
            terrain = replay.terrain().with_surface(surface)
            return replay.changed({"terrain": grounds.plain(terrain, arrays, solids=True)}, arrays)
        if replay.header["terrains"] is None:
            return replay
        made = [build.terrain(one, arrays).with_surface(surface) for one in replay.header["terrains"]]
        return replay.changed(
            {"terrains": [grounds.plain(one, arrays, solids=False) for one in made]}, arrays
        )
    except ValueError as error:
        if isinstance(error, ReplayError):
            raise
        raise SideError(str(error)) from None
