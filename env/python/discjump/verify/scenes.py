"""Scenes of `Simulator` as subjects: players, or small worlds of them, about the bridge and in a base.

An environment is a world; its seed says where its players start, and what keys they press.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import FIDELITIES, INPUT, Simulator
from discjump.verify.draws import mix, share
from discjump.verify.environments import IN_LANES, WIDTHS
from discjump.verify.interface import Batch
from discjump.verify.parts import Column, Part

ACTION = np.dtype([("keys", INPUT), ("explode", "?")], align=True)
SHOTS = np.dtype([("count", "<i4"), ("position", "<f8", (3,)), ("velocity", "<f8", (3,)), ("age", "<i8")])
"""Of a player: how many projectiles burst or fly, and the last of them."""
STEPS = 48
"""Calls of `step`, each of 1, 2 or 4 ticks by turns."""
TICKS = (1, 2, 4)
EXPLODE_EVERY = 16


@dataclass(frozen=True)
class SceneSubject:
    """A scene in one fidelity tier."""

    scene: str
    tier: str
    per_world: int = 1

    modes = ("",)
    steps = STEPS + 1
    digested = 8

    @property
    def name(self) -> str:
        """The scene, and how many share a world."""
        return f"scene {self.scene}" + ("" if self.per_world == 1 else f", worlds of {self.per_world}")

    def simulator(self, worlds: int, threads: int, lanes: int) -> Simulator:
        """So many worlds."""
        return Simulator(
            ground(),
            worlds * self.per_world,
            self.scene,
            fidelity=self.tier,
            threads=threads,
            lanes=lanes,
            players_per_world=self.per_world,
        )

    def batch(self, num: int, *, threads: int, lanes: int, mode: str) -> Batch:
        """So many worlds."""
        return Worlds(self.simulator(num, threads, lanes), self.per_world)

    def widths(self) -> list[int]:
        """Lane widths of this processor, where tier and worlds have lanes."""
        if self.tier not in IN_LANES or self.per_world > 1:
            return [1]
        return [width for width in WIDTHS if self._has(width)]

    def _has(self, width: int) -> bool:
        try:
            self.simulator(1, 1, width)
        except ValueError:
            return False
        return True

    def ways(self) -> Sequence[str]:
        """There is no other way in."""
        return ()

    def way(self, name: str, num: int) -> Batch:
        """There is none."""
        raise NotImplementedError(name)

    def action(self, seed: int, decision: int, columns: Mapping[str, Column]) -> Any:
        """Keys of the players of a world, (per_world,) of dtype `ACTION`; mostly they go forward."""
        return pressed(self.per_world, seed, decision)

    def describe(self, leaf: str) -> str:
        """The names say all."""
        return ""


class Worlds:
    """A simulator, seen as one environment per world."""

    def __init__(self, sim: Simulator, per_world: int) -> None:
        self.sim, self.per_world = sim, per_world
        self.num = sim.num_players // per_world
        self.shots = {"discs", "blast"} <= set(sim.scene.models)
        self.explodes = "blast" in sim.scene.models
        self.calls = 0

    def reset(self, seeds: Sequence[int | None] | None, mask: NDArray[np.bool_] | None = None) -> list[Part]:
        """Put the players where their seeds say."""
        assert seeds is not None
        assert mask is None
        state = self._by_world(self.sim.state())
        each, worlds = np.unique(np.array(seeds, np.int64), return_inverse=True)
        starts = np.repeat(state[:1], len(each), axis=0)
        for row, seed in enumerate(each.tolist()):
            for player in range(self.per_world):
                place(starts[row], player, seed)
        self.sim.set_state(starts[worlds].reshape(-1))
        self.calls = 0
        return [self._part()]

    def step(self, actions: Column) -> list[Part]:
        """One call."""
        flat = actions.reshape(-1)
        self.sim.step(np.ascontiguousarray(flat["keys"]), TICKS[self.calls % len(TICKS)])
        self.calls += 1
        if self.explodes and flat["explode"].any():
            points = self.sim.state()["position"] + (1.0, 0.0, 0.0)
            points[~flat["explode"]] = np.nan
            self.sim.explode(points)
        return [self._part()]

    def _part(self) -> Part:
        columns = {"state": self._by_world(self.sim.state())}
        if self.shots:
            columns["burst"] = self._by_world(self._last(self.sim.blasts()))
            columns["flying"] = self._by_world(self._last(self.sim.projectiles()))
        return Part(np.arange(self.num), columns)

    def _last(self, shots: NDArray[np.void]) -> NDArray[np.void]:
        last = np.zeros(self.sim.num_players, SHOTS)
        np.add.at(last["count"], shots["player"], 1)
        for name in ("position", "velocity", "age"):
            last[name][shots["player"]] = shots[name]
        return last

    def _by_world(self, players: NDArray[np.void]) -> NDArray[np.void]:
        return players.reshape(self.num, self.per_world)

    def snapshot(self) -> bytes:
        """Everything, for `restore`."""
        return self.calls.to_bytes(8, "little") + self.sim.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot."""
        self.sim.restore(snapshot[8:])
        self.calls = int.from_bytes(snapshot[:8], "little")


@cache
def ground() -> Terrain:
    """The terrain of seed 0, with bridge and bases."""
    return Terrain.raindance(0)


@cache
def pressed(players: int, seed: int, decision: int) -> NDArray[np.void]:
    """What the players of a world are told, the same in all tiers."""
    action = np.zeros(players, ACTION)
    keys = action["keys"]
    for player in range(players):
        words = (seed, player, decision // 5)
        keys["forward"][player] = 1 if mix(*words, 0) % 4 else mix(*words, 1) % 3 - 1
        keys["strafe"][player] = mix(*words, 2) % 3 - 1
        keys["jump"][player] = mix(*words, 3) % 4 > 0
        keys["jet"][player] = mix(*words, 4) % 2
        keys["fire"][player] = mix(*words, 5) % 2
        keys["turn"][player] = 0.25 * (mix(*words, 6) % 13) - 1.5
        keys["pitch"][player] = 0.25 * (mix(*words, 7) % 9) - 1.5
        action["explode"][player] = (decision + player) % EXPLODE_EVERY == EXPLODE_EVERY - 1
    return action


def place(world: NDArray[np.void], player: int, seed: int) -> None:
    """Put one player on the bridge, in a base or in the open, a few metres from the others of his world."""
    mission = ground().mission
    assert mission is not None
    middle = mission["bridge_centre"] if seed % 4 else mission["flag_stands"][seed // 4 % 2]
    aside = [8 * share(seed, axis) - 4 for axis in (0, 1)]
    there = middle + np.array([aside[0] + 3.0 * player, aside[1], 0.25])
    if seed % 4 > 1:
        there += [256 * share(seed, 5) - 128, 128.0, 0.0]
        there[2] = ground().height(there[None, :2])[0] + 0.25
    world["position"][player] = there
    world["velocity"][player] = [16 * share(seed, player, 2) - 8, 16 * share(seed, player, 3) - 8, 0.0]
    world["yaw"][player] = 0.5 * (mix(seed, player, 4) % 12) - 3.0


def subjects(scenes: Sequence[str], tiers: Sequence[str] = FIDELITIES) -> list[SceneSubject]:
    """These scenes in these tiers, and the mission with worlds of three."""
    chosen = [SceneSubject(scene, tier) for scene in scenes for tier in tiers]
    return chosen + [SceneSubject("mission", tier, 3) for tier in tiers if "mission" in scenes]
