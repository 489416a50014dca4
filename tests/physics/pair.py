"""A float64 `discjump.Simulator` and the plain Python model, side by side, compared after every tick."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import discjump

from .article import ARMORS, Keys, Player, Rules
from .blast import explode
from .disc import Launcher
from .ground import Ground, Vec
from .world import World

MODEL_OF = {"reference": "sliced", "swept": "swept", "anyway": "anyway", "engine": "engine"}

#: m and m/s: what section 12 expects of a correct float64 implementation.
TOLERANCE = 1e-6


def player_of(state: np.void) -> Player:
    x, y, z = state["position"].tolist()
    vx, vy, vz = state["velocity"].tolist()
    nx, ny, nz = state["jump_normal"].tolist()
    return Player(
        position=(x, y, z),
        velocity=(vx, vy, vz),
        yaw=float(state["yaw"]),
        energy=float(state["energy"]),
        damage=float(state["damage"]),
        jetting=bool(state["jetting"]),
        touched=bool(state["touched"]),
        crawled=bool(state["crawled"]),
        friction=float(state["friction"]),
        jump_normal=(nx, ny, nz),
        jump_age=int(state["jump_age"]),
    )


def keys_of(row: np.void) -> Keys:
    return Keys(
        forward=int(row["forward"]),
        strafe=int(row["strafe"]),
        jump=bool(row["jump"]),
        jet=bool(row["jet"]),
        turn=float(row["turn"]),
    )


class Pair:
    """Both hold the same players. `start` changes fields of the fresh state, for all or one by one."""

    def __init__(
        self,
        terrain: discjump.Terrain,
        num_players: int,
        *,
        armor: str = "light",
        energy_pack: bool = False,
        tick_ms: int = 32,
        hysteresis: bool = True,
        ski_bug: bool = False,
        scene: str = "sandbox",
        fidelity: str = "reference",
        launcher: Launcher | None = None,
        **start: Any,
    ) -> None:
        launcher = launcher or Launcher()
        weapon: dict[str, Any] = (
            {}
            if launcher.weapon == "disc"
            else {"weapon": "grenade" if launcher.weapon == "grenade_launcher" else launcher.weapon}
        )
        armed: dict[str, Any] = {
            "knockback": launcher.formula,
            "cutoff": launcher.cutoff,
            "accel": launcher.accel,
            "disc": launcher.disc,
        }
        self.simulator = discjump.Simulator(
            terrain,
            num_players,
            scene=scene,
            **weapon,
            armor=armor,
            energy_pack=energy_pack,
            fidelity=fidelity,
            precision="float64",
            physics=discjump.Physics(
                ski_bug=ski_bug, hysteresis=hysteresis, **(armed if scene != "sandbox" else {})
            ),
            tick_ms=tick_ms,
            threads=1,
        )
        recharge = 11.0 if energy_pack else 8.0
        self.rules = Rules(ARMORS[armor], tick_ms, recharge, hysteresis, ski_bug)
        self.ground = Ground(terrain)
        state = self.simulator.state()
        for name, value in start.items():
            state[name] = value
        self.simulator.set_state(state)
        self.players = [player_of(row) for row in state]
        model = MODEL_OF[fidelity]
        self.worlds = [World(player, self.ground, self.rules, launcher, model) for player in self.players]
        self.launcher = launcher
        #: Where discs burst in the last tick, by shooter, and how many did so far.
        self.last_bursts: list[list[Vec]] = [[] for _ in self.players]
        self.bursts = 0
        self.ticks = 0
        #: Largest difference so far: position (m), velocity (m/s).
        self.worst = np.zeros(2)
        #: Contacts of every player, and how many in the fullest tick.
        self.contacts = np.zeros(num_players, int)
        self.most_contacts = 0

    def inputs(self) -> NDArray[np.void]:
        return self.simulator.inputs()

    def step(self, inputs: NDArray[np.void], ticks: int = 1) -> None:
        for _ in range(ticks):
            self.simulator.step(inputs)
            for i, (world, row) in enumerate(zip(self.worlds, inputs, strict=True)):
                self.last_bursts[i] = world.step(keys_of(row), float(row["pitch"]), bool(row["fire"]))
                self.bursts += len(self.last_bursts[i])
                self.contacts[i] += len(world.player.contacts)
                self.most_contacts = max(self.most_contacts, len(world.player.contacts))
            self.ticks += 1
            self.compare()

    def explode(self, points: NDArray[np.float64]) -> None:
        """One explosion for every player; none where the row is NaN."""
        self.simulator.explode(points)
        arms = self.launcher
        for player, (x, y, z) in zip(self.players, points.tolist(), strict=True):
            if not np.isnan(x):
                explode(
                    player, self.rules.armor, (x, y, z), self.ground, arms.charge, arms.formula, arms.cutoff
                )
        self.compare()

    def own(self, name: str) -> NDArray[Any]:
        return np.array([getattr(player, name) for player in self.players])

    def compare(self) -> None:
        """All fields: numbers within the tolerance, flags and ages the same."""
        state = self.simulator.state()
        differences = [
            np.abs(state[name] - self.own(name)).reshape(len(self.players), -1).max(axis=1)
            for name in ("position", "velocity")
        ]
        self.worst = np.maximum(self.worst, [d.max() for d in differences])
        for name in ("position", "velocity", "energy", "damage", "friction", "jump_normal"):
            where = f"tick {self.ticks}, {name}"
            np.testing.assert_allclose(state[name], self.own(name), rtol=0.0, atol=TOLERANCE, err_msg=where)
        if "ammo" in (state.dtype.names or ()):
            shooters = [world.shooter for world in self.worlds]
            np.testing.assert_array_equal(state["ammo"], [s.ammo for s in shooters], f"tick {self.ticks}")
            # The simulator counts a tick off when it begins, this model when it ends.
            wait = np.maximum(state["cooldown"] - 1, 0)
            np.testing.assert_array_equal(wait, [s.wait for s in shooters], f"tick {self.ticks}")
        turned = np.abs(np.sin(0.5 * (state["yaw"] - self.own("yaw"))))  # -pi and pi are one view
        assert turned.max() < TOLERANCE, f"tick {self.ticks}, yaw"
        for name in ("jetting", "touched", "crawled", "jump_age"):
            np.testing.assert_array_equal(state[name], self.own(name), f"tick {self.ticks}, {name}")
