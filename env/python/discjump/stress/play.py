"""Plays a case in a column, and keeps every state."""

from dataclasses import dataclass

import numpy as np

from discjump._native import Terrain
from discjump.simulator import Simulator
from discjump.stress.cases import Case, Column, Setting, Start
from discjump.stress.rules import Floats, Rows


@dataclass(frozen=True)
class Record:
    """What was seen of n players in so many ticks."""

    column: Column
    setting: Setting
    terrain: Terrain
    start: Start
    #: (ticks + 1, n), the start included. Explosions come before a tick: `states[t]` is before them.
    states: Rows
    #: (ticks, n): states with the explosions before the tick in them.
    begun: Rows
    #: (ticks, n): projectiles that burst in the player's world.
    bursts: Floats
    #: Digest after the last tick.
    digest: str


def prepared(case: Case, column: Column, ground: Terrain | None = None) -> tuple[Terrain, Start]:
    """The terrain with the column's surface, and the start on it."""
    terrain = (case.ground() if ground is None else ground).with_surface(column.surface)
    return terrain, case.begin(terrain, column)


def simulator(
    terrain: Terrain,
    column: Column,
    setting: Setting,
    players: int,
    threads: int = 1,
    lanes: int | None = None,
) -> Simulator:
    """The simulator of a column."""
    return Simulator(
        terrain,
        players,
        setting.scene,
        setting.armor,
        setting.energy_pack,
        column.tier,
        setting.physics,
        setting.tick_ms,
        threads,
        players_per_world=setting.players_per_world,
        lanes=lanes,
        precision=column.precision,
    )


def place(sim: Simulator, start: Start) -> None:
    """Put the players where they begin."""
    state = sim.state()
    state["position"], state["velocity"] = start.position, start.velocity
    for name, values in start.fields.items():
        state[name] = values
    sim.set_state(state)


def play(
    terrain: Terrain,
    start: Start,
    column: Column,
    setting: Setting,
    threads: int = 1,
    lanes: int | None = None,
) -> Record:
    """Play all ticks of a start."""
    ticks, players = start.inputs.shape
    sim = simulator(terrain, column, setting, players, threads, lanes)
    place(sim, start)
    states = np.empty((ticks + 1, players), sim.state_dtype)
    begun = np.empty((ticks, players), sim.state_dtype)
    bursts = np.zeros((ticks, players))
    states[0] = sim.state()
    worlds = np.arange(players) // setting.players_per_world
    shoots = "discs" in sim.scene.models
    for tick, inputs in enumerate(start.inputs):
        begun[tick] = states[tick]
        if tick in start.blasts:
            sim.explode(start.blasts[tick])
            begun[tick] = sim.state()
        sim.step(inputs)
        states[tick + 1] = sim.state()
        if shoots:
            bursts[tick] = np.bincount(worlds[sim.blasts()["player"]], minlength=len(worlds))[worlds]
    return Record(column, setting, terrain, start, states, begun, bursts, sim.digest())


def again(record: Record, threads: int = 2, least: int = 0) -> Rows:
    """The same players once more, among others, at other indices, and in other lanes or on other threads.

    Args:
        record: what is repeated.
        threads: how many step the batch.
        least: so many players at least: the crowd is repeated. Else a few strangers come before them, and all
            are stepped one by one. (Few players are stepped on the caller's thread alone.)

    Returns:
        Their last states, (copies, n).
    """
    start, per_world = record.start, record.setting.players_per_world
    players = start.inputs.shape[1]
    copies = max(1, -(-least // players))
    strangers = 0 if copies > 1 else 3 * per_world
    order = np.concatenate([np.arange(strangers) % players, np.tile(np.arange(players), copies)])
    crowd = start.take(order)
    sim = simulator(
        record.terrain, record.column, record.setting, len(order), threads, 1 if copies == 1 else None
    )
    place(sim, crowd)
    for tick, inputs in enumerate(crowd.inputs):
        if tick in crowd.blasts:
            sim.explode(crowd.blasts[tick])
        sim.step(inputs)
    return sim.state()[strangers:].reshape(copies, players)
