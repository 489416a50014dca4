"""What a policy, or a group of training seeds, did in the episodes of a course."""

from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from discjump_training.episodes import Episodes
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.policies.candidate import Kind
from discjump_training.policy import Floats, Mask

#: What two policies' episodes must have in common to be compared pair by pair.
SHARED = ("start_distance", "terrain", "goals")


@dataclass(frozen=True)
class Judged:
    """A policy and what it did.

    Attributes:
        name: of the policy, or of the group.
        note: how actions are chosen.
        kind: what it is.
        members: names of its policies; more than one: training seeds of one algorithm.
        played: what happened to each of them; all played the same rows, from the first on.
        frame_skip: ticks per decision that it played with.
        usual_skip: the task's; another is named in tables.
        replays: file of the replay of a member's episode, by (member, row), where it was saved.
        runs: folders of training runs, by the name of the member that came out of each.
    """

    name: str
    note: str
    kind: Kind
    members: tuple[str, ...]
    played: tuple[Episodes, ...]
    frame_skip: int
    usual_skip: int
    replays: dict[tuple[int, int], Path] = field(default_factory=dict)
    runs: dict[str, Path] = field(default_factory=dict)

    @property
    def is_model(self) -> bool:
        """No baseline."""
        return self.kind != "baseline"

    @property
    def episodes(self) -> Episodes:
        """What the first member did."""
        return self.played[0]

    @property
    def actions(self) -> str:
        """How actions are chosen, with the ticks per decision where they are not the task's, and the number
        of runs where it is a group.
        """
        words = [self.note] if len(self.members) == 1 else [f"{self.note}, {len(self.members)} runs"]
        return ", ".join(
            words if self.frame_skip == self.usual_skip else [*words, f"frame_skip {self.frame_skip}"]
        )

    def table(self, key: str) -> Floats:
        """A column of all members, (members, episodes)."""
        return np.stack([np.asarray(getattr(one, key), np.float64) for one in self.played])

    @property
    def success(self) -> Mask:
        """(members, episodes)."""
        return np.stack([one.success for one in self.played])

    @property
    def terrain(self) -> NDArray[np.int64]:
        """(episodes,): strata of the statistics."""
        return self.episodes.terrain

    def first(self, count: int) -> "Judged":
        """The same of the first `count` episodes, paths left out."""
        return replace(self, played=tuple(head(one, count) for one in self.played))


def head(episodes: Episodes, count: int) -> Episodes:
    """The first `count` of them, paths left out."""
    cut = {
        one.name: getattr(episodes, one.name)[:count]
        for one in fields(episodes)
        if one.name not in ("paths", "extra")
    }
    return Episodes(**cut, paths={}, extra={key: value[:count] for key, value in episodes.extra.items()})


@dataclass(frozen=True)
class Figure:
    """A column of the table of policies.

    Attributes:
        key: in evaluation.json.
        title: heading.
        unit: m/s and so on; %: shares are shown so.
        digits: after the point.
    """

    key: str
    title: str
    unit: str
    digits: int


def columns(goal: str) -> tuple[Figure, ...]:
    """Of the table of policies of a task with that goal."""
    return (
        Figure("success", "success", "%", 1),
        Figure("seconds", f"time to {goal}", "s", 2),
        Figure("iqm", "interquartile mean", "s", 2),
        Figure("mean_speed", "mean speed", "m/s", 1),
        Figure("top_speed", "top speed", "m/s", 1),
        Figure("damage", "damage", "", 3),
    )


def figures(one: Judged) -> dict[str, Estimate]:
    """Estimates by key of `columns`."""
    found = {"success": statistics.share(one.success, one.terrain)}
    for key in ("seconds", "mean_speed", "top_speed", "damage"):
        found[key] = statistics.estimate(statistics.mean, [one.table(key)], one.terrain)
    found["iqm"] = statistics.estimate(statistics.interquartile_mean, [one.table("seconds")], one.terrain)
    return found
