"""Numbers that are none, and speeds beyond what a state holds: refused by name, and nothing is changed."""

from collections.abc import Callable

import numpy as np

from discjump import Terrain
from discjump.stress.cases import Column, Setting
from discjump.stress.play import simulator

NOT_NUMBERS = (np.nan, np.inf, -np.inf)
OUT_OF_RANGE = {
    "velocity": (1.0000001e6, -2e6, 1e30),
    "position": (1.1e9, -1e300),
    "energy": (-1e-6, 1e9),
    "friction": (-1e-6, 1.001),
    "damage": (-1e-6,),
    "yaw": (1.1e6,),
    "jump_age": (-1, (1 << 30) + 1),
}


def refusals(column: Column, terrain: Terrain, setting: Setting) -> list[str]:
    """What was not refused, or not by name, or changed something; nothing where all is well."""
    sim = simulator(terrain, column, setting, 4)
    sim.step(sim.inputs(), 3)
    before = (sim.digest(), sim.snapshot())
    wrong: list[str] = []

    def refused(what: str, name: str, call: Callable[[], object]) -> None:
        try:
            call()
        except (ValueError, TypeError) as error:
            if name not in str(error):
                wrong.append(f"{what}: the message does not name {name}: {error}")
        else:
            wrong.append(f"{what}: accepted")
        if (sim.digest(), sim.snapshot()) != before:
            wrong.append(f"{what}: refused, but the state changed")
            sim.restore(before[1])

    for name in sim.state_dtype.names or ():
        numbers = sim.state_dtype[name].base.kind == "f"
        for bad in (*(NOT_NUMBERS if numbers else ()), *OUT_OF_RANGE.get(name, ())):
            for player in (0, 3):
                state = sim.state()
                state[name].reshape(4, -1)[player, -1] = bad
                refused(f"set_state {name}={bad:g}", name, lambda state=state: sim.set_state(state))  # type: ignore[misc]
    for name in ("turn", "pitch"):
        for bad in NOT_NUMBERS:
            inputs = sim.inputs()
            inputs[name][2] = bad
            refused(f"step {name}={bad:g}", name, lambda inputs=inputs: sim.step(inputs))  # type: ignore[misc]
    if "blast" in sim.scene.models:
        for bad in (np.inf, -np.inf, 1e300):
            points = np.zeros((4, 3))
            points[1, 0] = bad
            refused(f"explode at {bad:g}", "points[1]", lambda points=points: sim.explode(points))  # type: ignore[misc]
    for bad in (*NOT_NUMBERS, 1.1e4):
        heights = np.zeros((3, 3))
        heights[1, 1] = bad
        refused(
            f"from_heights {bad:g}",
            "heights",
            lambda heights=heights: Terrain.from_heights(heights),  # type: ignore[misc]
        )
    return wrong
