"""Frames of a recording, tick by tick: everything that can be seen after each."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import build
from .codec import Arrays, Header

Values = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Way:
    """How a recording is played: nothing that may change a bit.

    Attributes:
        threads: that step the batch; None: one per core.
        lanes: players side by side in a register; None: as the processor has them.
        batch: of an environment: environments in all; of a simulator: times its players are there. 1: alone.
        index: which of them is looked at.
    """

    threads: int | None = None
    lanes: int | None = None
    batch: int = 1
    index: int = 0


class Frame(NamedTuple):
    """What is seen after so many ticks; tick 0 is the beginning.

    Attributes:
        tick: ticks played.
        over: whether the recording ends here.
        values: by name. Of an environment the `action`, `state` (its player), `terminated` and `truncated`
            after every tick; where a decision ends also its `observation`, `reward`, `info` and flags. Of a
            simulator `inputs` and `state` (n,), `projectiles` and `blasts`.
    """

    tick: int
    over: bool
    values: Values


def frames(header: Header, arrays: Arrays, way: Way) -> Iterator[Frame]:
    """The frames of a recording, the beginning first."""
    played = environment_frames if header["kind"] == "environment" else simulator_frames
    return played(header, arrays, way)


def environment_frames(header: Header, arrays: Arrays, way: Way) -> Iterator[Frame]:
    """The frames of an episode.

    Two environments play it: one with a tick per decision, which shows every tick, and the recorded one,
    which has the rewards and observations. That both have one state where a decision ends is seen, too: it is
    among the values as `decision.state`.
    """
    skip = int(header["options"]["frame_skip"])
    ticks, decisions = (Seat(header, arrays, way, frame_skip=number) for number in (1, skip))
    ticks.begin()
    observation, info = decisions.begin()
    yield Frame(
        0,
        False,
        {"state": ticks.state(), "goal": ticks.goal(), "observation": observation, **_named("info", info)},
    )
    tick = 0
    for action in arrays["actions"]:
        for last in [False] * (skip - 1) + [True]:
            tick += 1
            flags = ticks.step(action)[2]
            values = {"action": action, "state": ticks.state(), **_named("", flags)}
            ended = any(flags.values())
            over = ended
            if last or ended:
                observation, reward, flags, info = decisions.step(action)
                values |= {"decision.state": decisions.state(), "observation": observation}
                values |= {"reward": np.asarray(reward), **_named("decision", flags), **_named("info", info)}
                over |= any(flags.values()) or tick == skip * len(arrays["actions"])
            yield Frame(tick, over, values)
            if over:
                return


def simulator_frames(header: Header, arrays: Arrays, way: Way) -> Iterator[Frame]:
    """The frames of a simulator's ticks."""
    sim = build.simulator(header, arrays, copies=way.batch, threads=way.threads, lanes=way.lanes)
    players = header["players"]
    mine = slice(way.index * players, (way.index + 1) * players)
    shoots = "discs" in sim.scene.models
    inputs = build.inputs(arrays["inputs"])

    def values() -> Values:
        seen = {"state": sim.state()[mine]}
        if shoots:
            for name, shown in (("projectiles", sim.projectiles()), ("blasts", sim.blasts())):
                own = shown[(shown["player"] >= mine.start) & (shown["player"] < mine.stop)]
                own["player"] -= mine.start
                seen[name] = own
        return seen

    yield Frame(0, not len(inputs), values())
    for tick, row in enumerate(inputs):
        play_tick(sim, header, arrays, tick, row, way.batch)
        yield Frame(tick + 1, tick + 1 == len(inputs), {"inputs": row, **values()})


def play_tick(sim: Any, header: Header, arrays: Arrays, tick: int, inputs: Any, copies: int = 1) -> None:
    """Play a tick of a recording on its simulator, with the explosions before it."""
    for k in np.flatnonzero(arrays["explosions.tick"] == tick):
        sim.explode(np.tile(arrays["explosions.points"][k], (copies, 1)), header["explosions"][k])
    sim.step(np.tile(inputs, copies))


class Seat:
    """An environment of the recorded kind, alone or in a batch where the others do as they please.

    Args:
        header, arrays: the recording.
        way: where it sits.
        more: keyword arguments that differ from the recorded ones.
    """

    def __init__(self, header: Header, arrays: Arrays, way: Way, **more: Any) -> None:
        self._header, self._way = header, way
        self._alone = way.batch == 1 and way.threads is None
        if self._alone:
            made, _ = build.environment(header, arrays, lanes=way.lanes, **more)
        else:
            made, _ = build.environment(
                header, arrays, way.batch, threads=way.threads, lanes=way.lanes, **more
            )
        self.env = made.unwrapped
        self._draws = np.random.default_rng(header["seed"])

    def begin(self) -> tuple[NDArray[Any], dict[str, Any]]:
        """Observation and info of the recorded episode's beginning.

        An episode is named by its seed and number: a reset with the seed begins number 0, each further one
        the next.
        """
        header = self._header
        seed: Any = header["seed"]
        if not self._alone:
            others = [(seed + 1 + k) % 2**64 for k in range(self._way.batch - 1)]
            seed = [*others[: self._way.index], seed, *others[self._way.index :]]
        asked = {key: value for key, value in header["reset"].items() if value is not None} or None
        last = header["episode"]
        for number in range(last + 1):
            placed = {"options": asked} if number == last and asked else {}
            observation, info = self.env.reset(seed=seed if number == 0 else None, **placed)
        return self._own(observation), self._told(info)

    def step(self, action: NDArray[Any]) -> tuple[NDArray[Any], Any, dict[str, bool], dict[str, Any]]:
        """Observation, reward, the two flags by name, info."""
        given = action if self._alone else self._among(action)
        observation, reward, terminated, truncated, info = self.env.step(given)
        flags = {"terminated": bool(self._own(terminated)), "truncated": bool(self._own(truncated))}
        return self._own(observation), self._own(reward), flags, self._told(info)

    def state(self) -> NDArray[Any]:
        """The player, structured, of shape (1,)."""
        state = self.env.state()
        return np.array([state if self._alone else state[self._way.index]], state.dtype)

    def goal(self) -> NDArray[Any]:
        """The beacon, (3,), m."""
        return np.asarray(self.env.goal() if self._alone else self.env.goals()[self._way.index])

    def terrain(self) -> Any:
        """The terrain of the episode."""
        if self._alone:
            return self.env.terrain
        return self.env.terrains[int(self.env.terrain_index[self._way.index])]

    def _own(self, rows: Any) -> Any:
        return rows if self._alone else rows[self._way.index]

    def _told(self, info: dict[str, Any]) -> dict[str, Any]:
        """The environment's own info: a batch has columns of all, with masks of who has something to say."""
        if self._alone:
            return info
        told = {}
        for name, column in info.items():
            if not name.startswith("_") and info[f"_{name}"][self._way.index]:
                told[name] = column[self._way.index]
        return told

    def _among(self, action: NDArray[Any]) -> NDArray[Any]:
        """Actions of all, which the others draw."""
        shape = (self._way.batch, len(action))
        if action.dtype.kind == "f":
            rows = self._draws.uniform(-1, 1, shape).astype(np.float32)
        else:
            rows = self._draws.integers(0, self.env.single_action_space.nvec, shape).astype(action.dtype)
        rows[self._way.index] = action
        return rows


def _named(group: str, values: dict[str, Any]) -> Values:
    return {f"{group}.{name}" if group else name: np.asarray(value) for name, value in values.items()}
