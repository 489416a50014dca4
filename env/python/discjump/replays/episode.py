"""The replay of an environment's episode."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.envs.options import TaskOptions
from discjump.envs.placement import KEYS
from discjump.envs.tasks import BY_ID, SKI
from discjump.replays import grounds
from discjump.replays.bare import build, play
from discjump.replays.errors import ReplayError
from discjump.replays.mismatch import Mismatch
from discjump.replays.replay import (
    ID,
    MOST_EPISODES,
    Header,
    Replay,
    checked_options,
    hexadecimal,
    made_here,
)
from discjump.replays.tape import Tape


class EpisodeReplay(Replay):
    """An episode of an environment: its seed and number, where it was put, and every action.

    Arrays: `actions` (decisions, 5), with a launcher (decisions, 7), `digests.state` and `digests.output`
    (1 + stretches, 8) after every so many decisions, the beginning's first, `final` (1,): the last state
    where it could still be had.
    """

    HEADER: ClassVar = {"id": str, "seed": int, "episode": int, "reset": dict}
    ARRAYS: ClassVar = {"actions": ("if", 2), "digests.output": ("u", 2)}
    KIND = "environment"

    def __post_init__(self) -> None:
        """Check what could make another program of it."""
        super().__post_init__()
        if not ID.fullmatch(self.header["id"]):
            raise ReplayError(f"replay: expected an id like discjump/Ski-v0, got {self.header['id']!r:.80}")
        if not 0 <= self.header["episode"] <= MOST_EPISODES:
            raise ReplayError(
                f"replay: expected an episode from 0 to {MOST_EPISODES}, got {self.header['episode']}"
            )
        task = BY_ID.get(self.header["id"].removeprefix("discjump:"), SKI)
        checked_options(self.header["options"], [f.name for f in fields(task.options)])
        checked_options(self.header["reset"], KEYS)
        skip = self.header["options"].get("frame_skip")
        if not isinstance(skip, int) or not 1 <= skip <= 64:
            raise ReplayError(f"replay: expected a frame_skip from 1 to 64, got {skip!r:.80}")
        if not isinstance(self.header.get("terrains"), (list, type(None))):
            raise ReplayError("replay: expected a list of terrains or none")

    @classmethod
    def of(
        cls,
        tape: Tape,
        *,
        name: str,
        options: TaskOptions,
        terrain: Terrain,
        seed: int,
        episode: int,
        reset: Mapping[str, Any],
        way: Mapping[str, Any],
    ) -> EpisodeReplay:
        """The replay of what was taped.

        Args:
            tape: the episode.
            name: id of the environment.
            options: of the environment.
            terrain: what the episode was played on. Of a pool that was given as terrains it alone is kept: an
                episode does not depend on the others once its terrain is drawn.
            seed, episode: what names the episode.
            reset: `start`, `goal` and `terrain_seed`, as far as they were asked for.
            way: threads, lanes, batch and index it was recorded with.
        """
        arrays = tape.arrays(options.actions)
        terrains = None
        if options.terrains is not None:
            terrains = [grounds.plain(terrain, arrays, solids=options.GROUNDS == "stands")]
        header = {
            "kind": cls.KIND,
            "id": name,
            "options": plain_options(options),
            "terrains": terrains,
            "terrain": terrain.digest(),
            "seed": seed,
            "episode": episode,
            "reset": dict(reset),
            "made": made_here(**way),
            **tape.header(),
        }
        return cls(header, arrays)

    @property
    def seed(self) -> int:
        """Of the environment."""
        return int(self.header["seed"])

    @property
    def episode(self) -> int:
        """Number of the episode since the seed was given."""
        return int(self.header["episode"])

    @property
    def actions(self) -> NDArray[Any]:
        """(decisions, 5 or, with a launcher, 7): int8, or float32 of `actions="box"`."""
        return self.arrays["actions"]

    @property
    def outcome(self) -> dict[str, Any] | None:
        """The last info; None where recording stopped before the episode's end."""
        found = self.header["outcome"]
        return None if found is None else dict(found)

    def decisions(self) -> Iterator[tuple[play.Seat, Any]]:
        """The environment after its reset and after every decision, with what that returned."""
        try:
            seat = play.Seat(self.header, self.arrays, play.Way())
            yield seat, seat.begin()
            for action in self.actions:
                yield seat, seat.step(action)
        except build.CannotBuild as error:
            raise ReplayError(str(error)) from error
        except (TypeError, ValueError) as error:
            raise ReplayError(f"replay: discjump does not take what is in it: {error}") from error

    def taped(self, fields: Sequence[str] | None = None) -> Iterator[tuple[Tape, play.Seat, Any, bool]]:
        """The episode played anew: a tape of it, the environment, its player, and whether it is over.

        Args:
            fields: of the state that are digested; None: all.

        Raises:
            ReplayError: this installation cannot play it, or its players lack a field.
        """
        tape: Tape | None = None
        for seat, seen in self.decisions():
            state = seat.state()[0]
            names = state.dtype.names
            if lacking := [name for name in fields or () if name not in names]:
                raise ReplayError(f"replay: this release's players have no {', '.join(lacking)}")
            player, over = state[[*(fields or names)]], False
            if tape is None:
                observation, info = seen
                tape = Tape(self.header["every"], player, observation, info, seat.goal())
            else:
                observation, reward, flags, info = seen
                over = flags["terminated"] or flags["truncated"]
                action = self.actions[tape.decisions]
                tape.add(action, observation, reward, flags["terminated"], flags["truncated"], info, player)
            yield tape, seat, player, over

    def again(self, decisions: int | None = None) -> EpisodeReplay:
        """The same played anew: digests, final state and outcome are what comes of it here.

        Args:
            decisions: so many at most; None: all.
        """
        for found in self.changed(arrays={"actions": self.actions[:decisions]}).taped():
            tape, seat, last, over = found
            if over:
                break
        tape.cut(last)
        terrain = seat.terrain().digest()
        arrays = {**self.arrays, **tape.arrays(self.options["actions"])}
        made = made_here(**{name: self.made.get(name) for name in ("lanes", "batch", "index")})
        return EpisodeReplay({**self.header, "terrain": terrain, "made": made, **tape.header()}, arrays)

    def verify(self) -> Mismatch | None:
        """See `Replay.verify`. Actions past the episode's end, or none where it goes on, differ, too."""
        compared = 0
        for tape, seat, player, over in self.taped(self.header["fields"]):
            last, taken = player, tape.decisions
            if taken == 0 and (got := seat.terrain().digest()) != self.header["terrain"]:
                return Mismatch("terrain", 0, 0, self.header["terrain"], got)
            if over and taken < len(self.actions):
                return Mismatch("length", taken, taken, len(self.actions), taken)
            if len(tape.states) > compared:
                compared = len(tape.states)
                if found := self._compare(tape):
                    return found
        tape.cut(last)
        return self._compare(tape) or self._ends(tape, last)

    def _compare(self, tape: Tape) -> Mismatch | None:
        """The latest digest of the tape, if it is not the replay's."""
        k = len(tape.states) - 1
        first, last = (k - 1) * tape.every + 1, min(k * tape.every, tape.decisions)
        if k == 0:
            first = last = 0
        for field, got in (("state", tape.states[k]), ("output", tape.outputs[k])):
            expected = self.arrays[f"digests.{field}"]
            if k >= len(expected):
                return Mismatch(field, first, last, "no more digests", hexadecimal(got))
            if field == "state" and k == len(expected) - 1 and "final" not in self.arrays:
                continue
            if expected[k].tobytes() != got.tobytes():
                return Mismatch(field, first, last, hexadecimal(expected[k]), hexadecimal(got))
        return None

    def _ends(self, tape: Tape, state: Any) -> Mismatch | None:
        """What differs at the end: the number of digests, the final state, the outcome."""
        last = tape.decisions, tape.decisions
        for field, got in (("state", tape.states), ("output", tape.outputs)):
            expected = len(self.arrays[f"digests.{field}"])
            if expected != len(got):
                return Mismatch(f"number of digests of {field}", *last, expected, len(got))
        final = self.arrays.get("final", np.zeros(0))
        for name in final.dtype.names or ():
            if final[name][0].tobytes() != np.asarray(state[name]).tobytes():
                return Mismatch(f"final state.{name}", *last, final[name][0], state[name])
        if (self.outcome is None) != (tape.outcome is None):
            return Mismatch("outcome", *last, self.outcome, tape.outcome)
        for name, value in (self.outcome or {}).items():
            found = (tape.outcome or {}).get(name)
            if type(found) is not type(value) or found != value:
                return Mismatch(f"outcome.{name}", *last, value, found)
        return None


def plain_options(options: TaskOptions) -> Header:
    """Options as JSON has them, terrains left out."""
    plain: Header = {f.name: getattr(options, f.name) for f in fields(options) if f.name != "terrains"}
    plain["physics"] = asdict(options.physics)
    plain["reward"] = dict(options.reward)
    for name, value in plain.items():
        if isinstance(value, tuple):
            plain[name] = list(value)
    return plain
