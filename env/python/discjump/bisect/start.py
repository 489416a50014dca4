"""A replay that starts where two sides part."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.bisect.lockstep import Parting
from discjump.bisect.sides import Side
from discjump.replays import EpisodeReplay, Replay, TickReplay
from discjump.replays.bare import build, play
from discjump.replays.ticks import ARGUMENTS
from discjump.simulator import INPUT, Physics

TICKWISE = ("state.", "action", "inputs", "terminated", "truncated")
"""Beginnings of the fields that a simulator's ticks can show apart."""


def starting(sides: tuple[Side, Side], parting: Parting) -> Replay:
    """The replay of the first side that this installation plays, from just before the tick.

    It is one of a simulator's ticks, with the players' states as they were, or, where only rewards,
    observations or info differ, the episode up to that decision.
    """
    k = 1 if sides[0].python is not None and sides[1].python is None else 0
    replay = sides[k].replay
    if isinstance(replay, TickReplay):
        return _ticks_later(replay, max(parting.tick - 1, 0))
    assert isinstance(replay, EpisodeReplay)
    if parting.before is None or not parting.difference.field.startswith(TICKWISE):
        return replay.again(-(-parting.tick // replay.options["frame_skip"]))
    options = replay.options
    real = parting.before[k].values["state"]["velocity"].dtype
    rows = np.repeat(replay.actions, options["frame_skip"], axis=0)[parting.tick - 1 :]
    inputs = inputs_of(rows, options["turn_rate"], real)
    seat = play.Seat(replay.header, replay.arrays, play.Way())
    seat.begin()
    return TickReplay.record(
        seat.terrain(),
        inputs[:, np.newaxis],
        parting.before[k].values["state"],
        scene="ski",
        every=1,
        **arguments(options),
    )


def arguments(options: dict[str, Any]) -> dict[str, Any]:
    """Those of a replay's options that are a simulator's, with its physics."""
    found = {name: value for name, value in options.items() if name in ARGUMENTS}
    return {**found, "physics": Physics(**options["physics"])}


def inputs_of(actions: NDArray[np.generic], turn_rate: float, real: np.dtype[np.generic]) -> NDArray[np.void]:
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


def _ticks_later(replay: TickReplay, ticks: int) -> TickReplay:
    """The replay from so many ticks on."""
    header, arrays, inputs = replay.header, replay.arrays, replay.inputs
    sim = build.simulator(header, arrays)
    for tick in range(ticks):
        play.play_tick(sim, header, arrays, tick, inputs[tick])
    later = arrays["explosions.tick"] - ticks
    return TickReplay.record(
        replay.terrain(),
        inputs[ticks:],
        snapshot=sim.snapshot(),
        explosions={int(at): arrays["explosions.points"][k] for k, at in enumerate(later) if at >= 0},
        weapons=[name for name, at in zip(header["explosions"], later, strict=True) if at >= 0],
        every=1,
        **arguments(replay.options),
    )


def changes(sides: tuple[Side, Side]) -> str:
    """What makes the second side of the replay that `starting` gives: where its options and way differ."""
    k = 1 if sides[0].python is not None and sides[1].python is None else 0
    one, other = sides[k], sides[1 - k]
    made = []
    for name, value in arguments(other.replay.options).items():
        if name == "physics":
            mine = one.replay.options["physics"]
            given = other.replay.options["physics"]
            made += [f"physics.{key}={json.dumps(given[key])}" for key in given if given[key] != mine.get(key)]
        elif value != one.replay.options.get(name):
            made.append(f"{name}={value if isinstance(value, str) else json.dumps(value)}")
    for name in ("threads", "lanes", "batch", "index"):
        if getattr(other.way, name) != getattr(play.Way(), name):
            made.append(f"{name}={getattr(other.way, name)}")
    return ",".join([*made, *([f"python={other.python}"] if other.python else [])])
