"""A replay that starts where two sides part."""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.bisect.lockstep import Parting
from discjump.bisect.sides import EPISODE, Side
from discjump.replays import EpisodeReplay, Replay, TickReplay
from discjump.replays.bare import build, play
from discjump.replays.ticks import ARGUMENTS
from discjump.simulator import INPUT, Physics, Simulator

TICKWISE = ("state.", "action", "inputs", "terminated", "truncated")
"""Beginnings of the fields that a simulator's ticks can show apart."""


def starting(sides: tuple[Side, Side], parting: Parting) -> Replay:
    """The replay of the first side that this installation plays, from just before the tick.

    It is one of a simulator's ticks, with the players' states as they were, or, where only rewards,
    observations or info differ, the episode up to that decision.
    """
    k = chosen(sides)
    replay = sides[k].replay
    if isinstance(replay, EpisodeReplay) and (
        parting.before is None or not parting.difference.field.startswith(TICKWISE)
    ):
        return replay.again(-(-parting.tick // replay.options["frame_skip"]))
    sim, inputs, later = just_before(sides[k], parting, k)
    return TickReplay.record(
        terrain_of(replay), inputs, snapshot=sim.snapshot(), every=1, **later, **arguments(replay.options)
    )


def chosen(sides: tuple[Side, Side]) -> int:
    """Which side the replay is of: the first one, unless the other installation plays that alone."""
    return 1 if sides[0].python is not None and sides[1].python is None else 0


def just_before(side: Side, parting: Parting, k: int) -> tuple[Simulator, NDArray[np.void], dict[str, Any]]:
    """A simulator of a side as it is just before the tick after which the sides differ.

    Args:
        side: the side.
        parting: where they part.
        k: 0 of A, 1 of B.

    Returns:
        The simulator, the inputs (ticks, players) from there on, and the explosions among them as
        `TickReplay.record` takes them.
    """
    replay, first = side.replay, max(parting.tick - 1, 0)
    if isinstance(replay, TickReplay):
        header, arrays, inputs = replay.header, replay.arrays, replay.inputs
        sim = build.simulator(header, arrays)
        for tick in range(first):
            play.play_tick(sim, header, arrays, tick, inputs[tick])
        left = [(int(at) - first, i) for i, at in enumerate(arrays["explosions.tick"]) if at >= first]
        explosions = {at: arrays["explosions.points"][i] for at, i in left}
        weapons = [header["explosions"][i] for _, i in left]
        return sim, inputs[first:], {"explosions": explosions, "weapons": weapons}
    options = replay.options
    sim = Simulator(terrain_of(replay), 1, **arguments(options))
    assert parting.before is not None
    sim.set_state(build.states(sim, parting.before[k].values["state"]))
    rows = np.repeat(replay.arrays["actions"], options["frame_skip"], axis=0)[first:]
    real = sim.state_dtype["velocity"].base
    return sim, inputs_of(rows, options["turn_rate"], real)[:, np.newaxis], {}


def terrain_of(replay: Replay) -> Terrain:
    """The terrain that a replay is played on."""
    if isinstance(replay, TickReplay):
        return replay.terrain()
    seat = play.Seat(replay.header, replay.arrays, play.Way())
    seat.begin()
    terrain: Terrain = seat.terrain()
    return terrain


def arguments(options: dict[str, Any]) -> dict[str, Any]:
    """Those of a replay's options that are a simulator's, with its physics; an environment's scene is ski."""
    found = {name: value for name, value in options.items() if name in ARGUMENTS}
    return {"scene": "ski", **found, "physics": Physics(**options["physics"])}


def inputs_of(actions: NDArray[Any], turn_rate: float, real: np.dtype[Any]) -> NDArray[np.void]:
    """The keys that actions (n, 5) stand for, (n,) of dtype `INPUT`, with turns as the tier computes them.

    Discrete ones are bins: forward and strafe -1, 0, 1; jump; jet; turn in thirds of the largest rate from
    right to left. Numbers of a box press a key beyond a third of the way, jump and jet above 0.
    """
    made = np.zeros(len(actions), INPUT)
    kind = real.type
    if actions.dtype.kind == "f":
        third = np.float32(1) / np.float32(3)
        for name, column in (("forward", 0), ("strafe", 1)):
            made[name] = (actions[:, column] > third).astype(np.int8) - (actions[:, column] < -third)
        made["jump"], made["jet"] = actions[:, 2] > 0, actions[:, 3] > 0
        made["turn"] = actions[:, 4].astype(real) * kind(turn_rate)
    else:
        made["forward"], made["strafe"] = actions[:, 0].astype(np.int8) - 1, actions[:, 1].astype(np.int8) - 1
        made["jump"], made["jet"] = actions[:, 2] > 0, actions[:, 3] > 0
        made["turn"] = (actions[:, 4].astype(np.int8) - 3).astype(real) / kind(3) * kind(turn_rate)
    return made


def changes(sides: tuple[Side, Side], start: Replay) -> str:
    """What makes the second side of `start`, which `starting` gave: where its options and way differ.

    A simulator's replay takes an environment's options as far as they are a simulator's, an episode all.
    """
    k = chosen(sides)
    one, other = sides[k], sides[1 - k]
    mine, theirs = (dict(_words(side.replay, isinstance(start, EpisodeReplay))) for side in (one, other))
    made = [f"{name}={value}" for name, value in theirs.items() if value != mine.get(name)]
    for name in ("threads", "lanes", "batch", "index"):
        if getattr(other.way, name) != getattr(play.Way(), name):
            made.append(f"{name}={getattr(other.way, name)}")
    return ",".join([*made, *([f"python={other.python}"] if other.python else [])])


def _words(replay: Replay, episode: bool) -> Iterator[tuple[str, str]]:
    """Names and values of a replay's options as one types them, the switches of a group one by one."""
    options = replay.header["options"]
    if episode:
        options = {**options, **{name: replay.header[name] for name in EPISODE}}
    else:
        options = {**arguments(options), "physics": options["physics"]}
    for name, value in options.items():
        group = (
            {f"{name}.{key}": one for key, one in value.items()} if isinstance(value, dict) else {name: value}
        )
        for key, one in group.items():
            # Without spaces, and so without a need of quotes in most shells.
            yield key, one if isinstance(one, str) else json.dumps(one, separators=(",", ":"))
