"""What both recorders share: where replays go, and what names an episode."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from discjump.envs.options import TaskOptions
from discjump.envs.placement import KEYS
from discjump.replays.episode import EpisodeReplay

EVERY = 16
"""Decisions between two digests."""

Deliver = Callable[[EpisodeReplay], object]


class Shelf:
    """Where finished replays go.

    Attributes:
        replays: all of them, where they are neither saved nor given to somebody.
    """

    def __init__(self, folder: str | Path | None, deliver: Deliver | None) -> None:
        self._folder = None if folder is None else Path(folder)
        self._deliver = deliver
        self.replays: list[EpisodeReplay] = []

    def put(self, replay: EpisodeReplay) -> None:
        """Save it, hand it over, or keep it."""
        if self._folder is not None:
            replay.save(self._folder / filename(replay))
        if self._deliver is not None:
            self._deliver(replay)
        if self._folder is None and self._deliver is None:
            self.replays.append(replay)


def filename(replay: EpisodeReplay) -> str:
    """A name that tells the episode: its id, seed and number."""
    name = str(replay.header["id"]).removeprefix("discjump/")
    return f"{name}-seed{replay.seed}-episode{replay.episode}.replay"


def id_of(env: Any) -> str:
    """The id that the environment was made by; by its class where it was made without one."""
    if env.unwrapped.spec is not None:
        return str(env.unwrapped.spec.id).removeprefix("discjump:")
    made = type(env.unwrapped)
    place = f"{made.__module__}:{made.__qualname__}"
    for name, spec in gymnasium.registry.items():
        if name.startswith("discjump/") and place in (spec.entry_point, spec.vector_entry_point):
            return name
    raise ValueError(f"env: expected one of a registered id, got a {made.__qualname__} without")


def alone(options: TaskOptions) -> None:
    """Refuse options under which an episode is not a function of its seed, its number and where it is put.

    Raises:
        ValueError: `curriculum=True`.
    """
    if options.curriculum:
        raise ValueError(
            "env: expected one without curriculum, whose episodes can be played again alone, got "
            "curriculum=True: there an episode depends on how those before it ended (record one with "
            "difficulty='easy', 'standard' or 'hard')"
        )


def placed_at(options: Mapping[str, Any] | None, row: int | None) -> dict[str, Any]:
    """Where a reset's options put one environment: its row of what has one each; a row of NaN is drawn."""
    placed: dict[str, Any] = {}
    for key in KEYS:
        value = (options or {}).get(key)
        if value is None:
            continue
        width = 1 if key == "terrain_seed" else 2
        given = np.asarray(value)
        if row is not None and given.ndim == width:
            given = given[row]
        if key == "terrain_seed":
            placed[key] = int(given)
        elif not np.isnan(given).all():
            placed[key] = [float(number) for number in given]
    return placed
