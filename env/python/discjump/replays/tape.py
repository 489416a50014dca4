"""What is written down of an episode while it is played, and how it is summed up."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.replays.bare.codec import Arrays, Header
from discjump.replays.digests import Digest

INFO = ("distance", "speed", "time", "outside_mission_area")
"""Keys of info that are digested: those that every step has."""

OUTCOME = (
    "is_success",
    "death",
    "timeout",
    "time",
    "return",
    "length",
    "top_speed",
    "mean_speed",
    "path",
    "damage",
    "start_distance",
    "distance",
    "marker_height",
    "carrying",
    "flags_taken",
)
"""Keys of the last info that are kept, as far as the task has them."""


@dataclass
class Stretch:
    """What was seen in the decisions since the last digest, one entry each."""

    observations: list[NDArray[np.float32]] = field(default_factory=list)
    rewards: list[float] = field(default_factory=list)
    terminated: list[bool] = field(default_factory=list)
    truncated: list[bool] = field(default_factory=list)
    infos: list[Mapping[str, Any]] = field(default_factory=list)

    def add(
        self, observation: Any, reward: Any, terminated: Any, truncated: Any, info: Mapping[str, Any]
    ) -> None:
        """Add a decision's."""
        self.observations.append(observation)
        self.rewards.append(reward)
        self.terminated.append(terminated)
        self.truncated.append(truncated)
        self.infos.append(info)

    def digest(self) -> NDArray[np.uint8]:
        """Of all of it, quantity by quantity, (8,): float32 observations, float64 rewards and info, flags."""
        made = Digest()
        made.numbers([np.array(self.observations, np.float32), np.array(self.rewards, np.float64)])
        made.numbers([np.array(self.terminated, np.bool_), np.array(self.truncated, np.bool_)])
        made.numbers(np.array([info[key] for info in self.infos], np.float64) for key in INFO)
        return made.done()


def state_digest(state: Any, fields: Sequence[str]) -> NDArray[np.uint8]:
    """Of a player's state, (8,), field by field in this order."""
    made = Digest()
    made.state(state, fields)
    return made.done()


class Tape:
    """One episode, from its first observation on.

    Args:
        every: decisions between two digests.
        state: the player at the beginning, structured.
        observation, info: the first ones.
        goal: the beacon, (3,), m.

    Attributes:
        states, outputs: digests so far, each (8,): the beginning's, then those of every stretch.
        outcome: the last info, once the episode is over.
    """

    def __init__(self, every: int, state: Any, observation: Any, info: Mapping[str, Any], goal: Any) -> None:
        self.every = every
        self.fields = list(state.dtype.names)
        first = Stretch()
        first.add(observation, 0.0, False, False, info)
        beginning = Digest()
        beginning.state(state, self.fields)
        beginning.numbers([np.asarray(goal, np.float64)])
        self.states = [beginning.done()]
        self.outputs = [first.digest()]
        self._stretch = Stretch()
        self._actions: list[NDArray[Any]] = []
        self._at = 0
        self._last: Any = state
        self.outcome: dict[str, Any] | None = None

    @property
    def decisions(self) -> int:
        """How many were taken."""
        return len(self._actions)

    @property
    def due(self) -> bool:
        """Whether the next decision ends a stretch, so that the state after it is wanted."""
        return (len(self._actions) + 1) % self.every == 0

    def add(
        self,
        action: NDArray[Any],
        observation: Any,
        reward: Any,
        terminated: Any,
        truncated: Any,
        info: Mapping[str, Any],
        state: Any,
    ) -> None:
        """A decision: its action, what came of it, and the state after it where that is `due` or the last."""
        self._actions.append(np.asarray(action))
        self._stretch.add(observation, reward, terminated, truncated, info)
        if terminated or truncated:
            self.outcome = {key: _python(info[key]) for key in OUTCOME if key in info}
        if self.decisions % self.every == 0 or terminated or truncated:
            self._close(state)

    def cut(self, state: Any) -> None:
        """Nothing more comes, though the episode is not over."""
        if self._at < self.decisions:
            self._close(state)

    def _close(self, state: Any) -> None:
        """End the stretch. A last state that nobody can have any more (None) has a digest of zeros."""
        self._at = self.decisions
        self.states.append(np.zeros(8, np.uint8) if state is None else state_digest(state, self.fields))
        self.outputs.append(self._stretch.digest())
        self._stretch = Stretch()
        self._last = state

    def arrays(self, actions: str) -> Arrays:
        """Arrays of the replay; `actions` is their kind in the environment's options."""
        dtype = np.dtype(np.float32) if actions == "box" else np.dtype(np.int8)
        rows = np.array(self._actions).astype(dtype) if self._actions else np.zeros((0, 5), dtype)
        made = {"actions": rows}
        made |= {"digests.state": np.array(self.states), "digests.output": np.array(self.outputs)}
        if self._last is not None:
            made["final"] = np.array([self._last], self._last.dtype)
        return made

    def header(self) -> Header:
        """Its share of the replay's header."""
        return {"every": self.every, "fields": self.fields, "outcome": self.outcome}


def _python(value: Any) -> Any:
    """A number as JSON writes it."""
    return value.item() if isinstance(value, np.generic) else value
