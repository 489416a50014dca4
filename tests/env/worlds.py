"""Simulators of several players a world, for their tests."""

from typing import Any

import numpy as np

from discjump import Simulator, Terrain

FLAT = Terrain.from_heights(np.zeros((65, 65)), origin=(-256.0, -256.0))


def pair(fidelity: str = "reference", players: int = 2, **options: Any) -> Simulator:
    """Two players a world; where they stand is the caller's."""
    chosen: dict[str, Any] = {"scene": "disc_jump", "players_per_world": 2, "threads": 1}
    return Simulator(FLAT, players, fidelity=fidelity, **(chosen | options))


def put(sim: Simulator, player: int, **fields: Any) -> None:
    state = sim.state()
    for name, value in fields.items():
        state[name][player] = value
    sim.set_state(state[player : player + 1], [player])


def everything(sim: Simulator) -> tuple[Any, ...]:
    parts = (sim.state(), sim.projectiles(), sim.blasts())
    return (*(part.tobytes() for part in parts), sim.digest(), sim.snapshot())
