"""A float32 tier of `discjump.Simulator`, checked tick by tick against the plain Python models.

Before every tick the Python player takes over the simulator's state, so nothing adds up: what is left is the
rounding of one tick. Where that falls on a decision (touch or miss, one slice more or less, stop or not) the
two may part; such a tick must have a start within rounding's reach from which the Python model goes the
simulator's way, and is counted."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

import discjump

from .article import Keys, Player, norm
from .ground import Ground
from .models import rules_of, tick
from .pair import keys_of, player_of

MODEL_OF = {"authentic": "sliced", "swept": "swept", "anyway": "anyway", "engine": "engine"}

#: Absolute, in some ulps of float32 at the magnitudes that meet, and relative for what has no bound: heights
#: and velocities. The horizontal position is held near its square and adds no error far from the origin.
TOLERANCES: dict[str, tuple[float | tuple[float, float, float], float]] = {
    "position": ((0.0, 0.0, 2.5e-7), 3e-5),
    "velocity": (1e-6, 3e-5),
    "energy": (0.0, 2e-5),
    "damage": (1e-6, 1e-6),
    "friction": (0.0, 1e-6),
    "jump_normal": (0.0, 1e-6),
}
EXACT = ("jetting", "touched", "crawled", "jump_age")
#: How far a start is moved, in m and m/s, to find the other side of a decision.
REACHES = (3e-6, 1e-5, 3e-5)
TRIES = 30
#: And how much the ends may then differ, in tolerances: a decision is where rounding counts most (the time of
#: a grazing hit is the distance's error by the speed along the normal).
SLACK = 10.0
#: The engine's tick sums up dozens of sub-steps. The article's makes a slice more every 31 m/s.
SUB_STEPS = {"engine": 4.0}
SLICED_SPEED = 100.0
#: The same for the stored jump normal.
NORMAL_REACH = 3e-7


class Synced:
    """`flips` counts the ticks on a decision, `ticks` all of them, `contacts` those with a contact."""

    def __init__(
        self,
        terrain: discjump.Terrain,
        num_players: int,
        fidelity: str,
        armor: str = "light",
        energy_pack: bool = False,
        tick_ms: int = 32,
        switches: dict[str, Any] | None = None,
        **start: Any,
    ) -> None:
        switches = switches or {}
        self.model = MODEL_OF[fidelity]
        self.rules = rules_of(self.model, armor, energy_pack, tick_ms=tick_ms, **switches)
        self.simulator = discjump.Simulator(
            terrain,
            num_players,
            scene="sandbox",
            armor=armor,
            energy_pack=energy_pack,
            fidelity=fidelity,
            physics=discjump.Physics(**switches) if switches else None,
            tick_ms=tick_ms,
            threads=1,
        )
        self.ground = Ground(terrain)
        state = self.simulator.state()
        for name, value in start.items():
            state[name] = value
        self.simulator.set_state(state)
        self.rng = np.random.default_rng(0)
        #: The stored normals in float64: whether a contact is steeper must not hang on their rounding.
        self.normals = [player_of(row).jump_normal for row in state]
        self.ticks = self.flips = self.contacts = 0

    def run(self, keys: Iterator[NDArray[np.void]], ticks: int) -> None:
        for _ in range(ticks):
            self.step(next(keys))

    def step(self, inputs: NDArray[np.void]) -> None:
        before = self.simulator.state()
        self.simulator.step(inputs)
        for i, (start, row, end) in enumerate(zip(before, inputs, self.simulator.state(), strict=True)):
            keys, player = keys_of(row), player_of(start)
            if np.allclose(player.jump_normal, self.normals[i], rtol=0.0, atol=NORMAL_REACH):
                player.jump_normal = self.normals[i]
            tick(self.model, player, keys, self.ground, self.rules)
            self.ticks += 1
            self.contacts += bool(player.contacts)
            self.normals[i] = player.jump_normal
            wrong = self.differences(player, end)
            if not wrong:
                continue
            self.flips += 1
            assert self.explained(start, keys, end), (
                f"{self.model}\n{start}\n{keys}\n{end}\n{player}\n{wrong}"
            )

    def differences(self, player: Player, end: np.void, slack: float = 1.0) -> list[str]:
        """Names of the fields that disagree."""
        wrong = []
        slack *= SUB_STEPS.get(self.model, 1.0) * (1.0 + norm(player.velocity) / SLICED_SPEED)
        for name, (relative, absolute) in TOLERANCES.items():
            there, here = np.asarray(end[name], float), np.asarray(getattr(player, name), float)
            allowed = slack * (absolute + np.multiply(relative, np.abs(here).max()))
            if (np.abs(there - here) > allowed).any():
                wrong.append(name)
        turned = np.sin(0.5 * (float(end["yaw"]) - player.yaw))  # -pi and pi are one view
        if abs(turned) > 1e-6:
            wrong.append("yaw")
        return wrong + [name for name in EXACT if end[name] != getattr(player, name)]

    def explained(self, start: np.void, keys: Keys, end: np.void) -> bool:
        """Whether a start next to this one leads where the simulator went."""
        for reach in REACHES:
            for _ in range(TRIES):
                moved = start.copy()
                for name in ("position", "velocity"):
                    moved[name] = start[name] + self.rng.uniform(-reach, reach, 3)
                moved["jump_normal"][2] += self.rng.uniform(-NORMAL_REACH, NORMAL_REACH)
                player = player_of(moved)
                tick(self.model, player, keys, self.ground, self.rules)
                if not self.differences(player, end, SLACK):
                    return True
        return False
