"""The replay of a simulator's ticks: bodies without a task."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discjump._native import Terrain
from discjump.replays import grounds
from discjump.replays.bare import build
from discjump.replays.bare.codec import Arrays, Header
from discjump.replays.digests import Digest
from discjump.replays.errors import ReplayError
from discjump.replays.mismatch import Mismatch
from discjump.replays.replay import Replay, checked_options, hexadecimal, made_here
from discjump.simulator import Physics, Simulator

ARGUMENTS = (
    "scene",
    "armor",
    "energy_pack",
    "fidelity",
    "physics",
    "tick_ms",
    "players_per_world",
    "weapon",
    "ammo",
    "precision",
)
"""Arguments of `Simulator` that its bits depend on, beside the terrain and the number of players."""

EVERY = 64
"""Ticks between two digests."""

SHOTS = ("projectiles", "blasts")


class TickReplay(Replay):
    """Ticks of a simulator: its arguments, where its players were, and the inputs of every tick.

    Arrays: `state` (players,) at the beginning (with `snapshot`, its bytes, where projectiles were under
    way),
    `inputs` (ticks, players), `explosions.tick` (k,) before which there were explosions at
    `explosions.points` (k, players, 3), `digests.state` (1 + stretches, 8), `final` (players,).
    """

    HEADER: ClassVar = {"terrain": dict, "players": int, "explosions": list}
    ARRAYS: ClassVar = {
        "state": ("V", 1),
        "inputs": ("V", 2),
        "explosions.tick": ("iu", 1),
        "explosions.points": ("f", 3),
        "final": ("V", 1),
    }
    KIND = "simulator"

    def __post_init__(self) -> None:
        """Check what could make another program of it."""
        super().__post_init__()
        checked_options(self.header["options"], ARGUMENTS)
        players = self.header["players"]
        if self.arrays["state"].shape != (players,) or self.arrays["inputs"].shape[1] != players:
            raise ReplayError(f"replay: expected states and inputs of {players} players, got others")
        if len(self.arrays["explosions.tick"]) != len(self.header["explosions"]):
            raise ReplayError("replay: expected a weapon for each explosion, got another number")

    @classmethod
    def record(
        cls,
        terrain: Terrain,
        inputs: NDArray[Any],
        state: NDArray[Any] | None = None,
        *,
        snapshot: bytes | None = None,
        explosions: Mapping[int, ArrayLike] | None = None,
        weapons: Sequence[str] = (),
        every: int = EVERY,
        **arguments: Any,
    ) -> TickReplay:
        """Play ticks on a simulator, and record them.

        Args:
            terrain: of the simulator.
            inputs: dtype `INPUT`, shape (ticks, players).
            state: where the players begin, (players,), fields as the simulator's; None: as fresh ones.
            snapshot: of such a simulator, in place of `state`: with projectiles under way.
            explosions: points (players, 3) by the tick before which they go off.
            weapons: whose explosions they are, in order of their ticks; discs where there are none.
            every: ticks between two digests.
            **arguments: of `Simulator`.

        Raises:
            TypeError, ValueError: as `Simulator`.
        """
        players = inputs.shape[1]
        sim = Simulator(terrain, players, **arguments)
        if snapshot is not None:
            sim.restore(snapshot)
        elif state is not None:
            sim.set_state(build.states(sim, state))
        arrays: Arrays = {"state": sim.state(), "inputs": inputs}
        if "discs" in sim.scene.models and len(sim.projectiles()):
            arrays["snapshot"] = np.frombuffer(sim.snapshot(), np.uint8)
        given = dict(sorted((explosions or {}).items()))
        points = np.array([np.asarray(at, np.float64) for at in given.values()])
        arrays["explosions.tick"] = np.array([*given], np.int64)
        arrays["explosions.points"] = points.reshape(len(given), players, 3)
        header: Header = {
            "kind": cls.KIND,
            "options": _plain(arguments),
            "terrain": grounds.plain(terrain, arrays, solids="solids" in sim.scene.models),
            "players": players,
            "explosions": [*weapons] or ["disc"] * len(given),
            "every": every,
            "fields": [*(sim.state_dtype.names or ())],
            "made": made_here(threads=arguments.get("threads"), lanes=sim.lanes),
        }
        placeholder = {"digests.state": np.zeros((0, 8), np.uint8), "final": arrays["state"]}
        bare = cls(header, {**arrays, **placeholder})
        digests, final = bare._repeated()
        return bare.changed(arrays={"digests.state": np.array(digests), "final": final})

    @property
    def inputs(self) -> NDArray[Any]:
        """(ticks, players), dtype `INPUT`."""
        made: NDArray[Any] = build.inputs(self.arrays["inputs"])
        return made

    def terrain(self) -> Terrain:
        """The terrain."""
        try:
            return build.terrain(self.header["terrain"], self.arrays)
        except build.CannotBuild as error:
            raise ReplayError(str(error)) from error

    def verify(self) -> Mismatch | None:
        """See `Replay.verify`."""
        got, final = self._repeated(self.arrays["digests.state"])
        expected = self.arrays["digests.state"]
        every, ticks = self.header["every"], len(self.arrays["inputs"])
        for k, (one, other) in enumerate(zip(expected, got, strict=False)):
            if one.tobytes() != other.tobytes():
                first, last = (k - 1) * every + 1 if k else 0, min(k * every, ticks)
                return Mismatch("state", first, last, hexadecimal(one), hexadecimal(other), "tick")
        if len(expected) != len(got):
            return Mismatch("number of digests of state", ticks, ticks, len(expected), len(got), "tick")
        for name in self.arrays["final"].dtype.names or ():
            for player, (one, other) in enumerate(zip(self.arrays["final"][name], final[name], strict=True)):
                if one.tobytes() != other.tobytes():
                    return Mismatch(f"final state[{player}].{name}", ticks, ticks, one, other, "tick")
        return None

    def _repeated(
        self, expected: NDArray[np.uint8] | None = None
    ) -> tuple[list[NDArray[np.uint8]], NDArray[Any]]:
        """Digests of all stretches, up to the first that is not as expected, and the last state."""
        digests: list[NDArray[np.uint8]] = []
        wanted, every = self.header["fields"], self.header["every"]
        final = self.arrays["state"]
        shots = Digest()
        for frame in self.play():
            final = frame.values["state"]
            if lacking := [name for name in wanted if name not in (final.dtype.names or ())]:
                raise ReplayError(f"replay: this release's players have no {', '.join(lacking)}")
            for name in SHOTS:
                if name in frame.values:
                    fields = frame.values[name].dtype.names or ()
                    shots.numbers(frame.values[name][field] for field in fields)
            if frame.tick % every == 0 or frame.over:
                shots.state(final, wanted)
                digests.append(shots.done())
                shots = Digest()
                if expected is not None and not _as_expected(digests, expected):
                    break
        return digests, final[wanted]


def _as_expected(digests: list[NDArray[np.uint8]], expected: NDArray[np.uint8]) -> bool:
    k = len(digests) - 1
    return k < len(expected) and expected[k].tobytes() == digests[k].tobytes()


def _plain(arguments: Mapping[str, Any]) -> Header:
    """Arguments of a simulator as JSON has them, each of them named."""
    defaults = {"scene": "sandbox", "armor": "light", "energy_pack": False, "fidelity": "authentic"}
    defaults |= {"tick_ms": 32, "players_per_world": 1, "weapon": "disc", "ammo": None, "precision": None}
    physics = arguments.get("physics") or Physics()
    known = {name: arguments.get(name, value) for name, value in defaults.items()}
    return {**known, "physics": asdict(physics)}
