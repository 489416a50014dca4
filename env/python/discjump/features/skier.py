"""A scripted skier who runs to a beacon, in the whole game and with one feature of it left out.

Whatever no public scene leaves out alone is left out by keys or state, with the bits of a scene without it
(core/tests/minimal_scene.rs): a key that does nothing is one that is not pressed, and a tank that costs
nothing is one that is full in every tick.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import Simulator

Floats = NDArray[np.float64]

TICK = 0.032
"""s."""
RADIUS = 8.0
"""Whoever comes so near to the beacon has arrived, horizontally, m."""
MAX_DAMAGE = 0.66
"""What a light survives (core/docs/physics.md, section 2)."""
TURN = 2.34375
"""Fastest that he turns, rad/s."""
AHEAD = 20.0
"""How far ahead he looks at the ground, m."""
SLOW = 15.0
"""Speed below which he uses his jets, m/s."""
SHOT, DOWN = 5, -1.5
"""Tick of his only disc, and its pitch, rad: a disc jump, which a light survives once."""

SCENE_OF = {"solids": "disc_jump"}
"""Scenes that leave out this and nothing else of the whole game."""
KEY_OF = {"jump": "jump", "jet": "jet", "discs": "fire"}
"""Keys that do nothing without the feature."""


@dataclass(frozen=True)
class Route:
    """Where skiers start on a terrain, and where they go."""

    terrain: Terrain
    #: (n, 3), m.
    start: Floats
    #: (n, 2), m.
    beacon: Floats


@dataclass(frozen=True)
class Run:
    """What became of the skiers of a route, after every tick, the start included."""

    #: (ticks + 1, n, 3), m.
    position: Floats
    #: (ticks + 1, n), m/s.
    speed: Floats
    #: (ticks + 1, n); 0 where damage is left out.
    damage: Floats
    #: (n,), tick of the arrival; -1: none, or dead before.
    arrived: NDArray[np.int64]
    #: (n,), whether he died before he arrived.
    killed: NDArray[np.bool_]


def run(route: Route, ticks: int, left_out: str | None) -> Run:
    """Play a route in the whole game, without one feature or with all (None). Who has arrived plays on."""
    count = len(route.start)
    sim = Simulator(route.terrain, count, SCENE_OF.get(left_out or "", "mission"), threads=1)
    state = sim.state()
    full = state["energy"].copy()
    state["position"] = route.start
    to = route.beacon - route.start[:, :2]
    state["yaw"] = np.arctan2(-to[:, 0], to[:, 1])
    sim.set_state(state)
    position, velocity = np.empty((ticks + 1, count, 3)), np.empty((ticks + 1, count, 3))
    damage = np.zeros((ticks + 1, count))
    for tick in range(ticks + 1):
        state = sim.state()
        position[tick], velocity[tick] = state["position"], state["velocity"]
        if left_out != "landing_damage":
            damage[tick] = state["damage"]
        if tick < ticks:
            if left_out == "energy":
                state["energy"] = full
                sim.set_state(state)
            inputs = keys(sim, state, route, tick)
            if left_out in KEY_OF:
                inputs[KEY_OF[left_out]] = False
            sim.step(inputs)
    dead = first(damage > MAX_DAMAGE)
    away = np.linalg.norm(position[:, :, :2] - route.beacon, axis=2)
    there = first(away < RADIUS)
    killed = (dead >= 0) & ((there < 0) | (dead <= there))
    return Run(position, np.linalg.norm(velocity, axis=2), damage, np.where(killed, -1, there), killed)


def keys(sim: Simulator, state: NDArray[np.void], route: Route, tick: int) -> NDArray[np.void]:
    """Forward and jump held, the beacon ahead; jets when slow or the ground rises; a disc jump at first."""
    inputs = sim.inputs()
    inputs["forward"], inputs["jump"], inputs["pitch"] = 1, True, DOWN
    here, yaw = state["position"], state["yaw"].astype(np.float64)
    to = route.beacon - here[:, :2]
    off = np.mod(np.arctan2(-to[:, 0], to[:, 1]) - yaw + np.pi, 2.0 * np.pi) - np.pi
    inputs["turn"] = np.clip(off / TICK, -TURN, TURN)
    ahead = here[:, :2] + AHEAD * np.column_stack([-np.sin(yaw), np.cos(yaw)])
    speed = np.linalg.norm(state["velocity"], axis=1)
    inputs["jet"] = (speed < SLOW) | (route.terrain.height(ahead) > here[:, 2])
    inputs["fire"] = tick == SHOT
    return inputs


def first(happens: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The first tick of each column in which something happens; -1 where it never does.

    >>> first(np.array([[False, False], [True, False], [True, False]])).tolist()
    [1, -1]
    """
    return np.where(happens.any(axis=0), happens.argmax(axis=0), -1)
