"""What a scene costs: nanoseconds a player-tick for every scene and tier, and what solids add to it."""

import time
from collections.abc import Callable
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import FIDELITIES, SCENES, Simulator
from discjump.solids import Solid
from discjump.terrains import generated

PLAYERS = 1024
#: Ticks of a call: keys are held for so long, as by an agent with a frame skip of 4.
TICKS = 4
CALLS = 16
#: Side of the square that players start in, and of the one that many solids stand in, m.
FIELD = 400.0
SEED = 7

Play = Callable[[], None]


def measure(repeats: int) -> list[dict[str, Any]]:
    """The rows of the table; in each repeat every case is played once, so that all are slowed alike."""
    cases = _cases()
    rows: list[dict[str, Any]] = []
    times: list[list[float]] = [[] for _ in cases]
    with click.progressbar(range(repeats), label="scenes") as bar:
        for _ in bar:
            for (_, play), taken in zip(cases, times, strict=True):
                taken.append(_timed(play))
    for (row, _), taken in zip(cases, times, strict=True):
        ns = np.array(taken) / (PLAYERS * TICKS * CALLS) * 1e9
        low, median, high = np.quantile(ns, [0.25, 0.5, 0.75])
        rows.append({**row, "ns_per_player_tick": median, "quartiles": [low, high]})
    return rows


def lists() -> str:
    """What each scene models, leaves out, and stores, as Markdown.

    >>> print(lists().splitlines()[2])
    | ski | jump, jet, energy, landing_damage | discs, blast, solids, flags, bump_limits | 76 / 136 |
    """
    lines = [
        "| scene | models | leaves out | bytes per player (float32 / reference) |",
        "|---|---|---|---|",
    ]
    terrain = generated(SEED)
    for scene in SCENES.values():
        sizes = [
            Simulator(terrain, scene=scene.name, fidelity=fidelity, threads=1).player_bytes
            for fidelity in ("authentic", "reference")
        ]
        models, leaves_out = ", ".join(scene.models), ", ".join(scene.leaves_out)
        lines.append(f"| {scene.name} | {models} | {leaves_out} | {sizes[0]} / {sizes[1]} |")
    return "\n".join(lines)


def table(rows: list[dict[str, Any]]) -> str:
    """The costs as Markdown: scenes by tiers, then what solids add."""
    costs = {(row["scene"], row["fidelity"]): row for row in rows if row["case"] == "scene"}
    lines = ["| ns per player-tick | " + " | ".join(FIDELITIES) + " |", "|---" * (len(FIDELITIES) + 1) + "|"]
    for scene in SCENES:
        cells = [_cell(costs[scene, fidelity]) for fidelity in FIDELITIES]
        lines.append(f"| {scene} | " + " | ".join(cells) + " |")
    others = [row for row in rows if row["case"] != "scene"]
    base = next(row for row in others if row["case"] == "no solids")["ns_per_player_tick"]
    lines += ["", "| scene mission, authentic | ns per player-tick | over no solids |", "|---|---|---|"]
    for row in others:
        share = row["ns_per_player_tick"] / base
        lines.append(f"| {row['case']} | {_cell(row)} | {share:.2f} |")
    return "\n".join(lines)


def _cell(row: dict[str, Any]) -> str:
    low, high = row["quartiles"]
    return f"{row['ns_per_player_tick']:.0f} ({low:.0f} .. {high:.0f})"


def _cases() -> list[tuple[dict[str, Any], Play]]:
    terrain = generated(SEED)
    here = (-600.0, -600.0)
    cases: list[tuple[dict[str, Any], Play]] = []

    def add(case: str, where: Terrain, scene: str, fidelity: str, corner: tuple[float, float]) -> None:
        row = {"case": case, "scene": scene, "fidelity": fidelity, "solids": len(where.solids)}
        cases.append((row, _player(where, scene, fidelity, corner)))

    for scene in SCENES:
        for fidelity in FIDELITIES:
            add("scene", terrain, scene, fidelity, here)
    for count in (0, 10, 1000):
        where = terrain.with_solids(_towers(terrain, count))
        name = "no solids" if count == 0 else f"{count:,} solids, players far from them"
        add(name, where, "mission", "authentic", here)
    add("1,000 solids, players among them", where, "mission", "authentic", (200.0, 200.0))
    area = terrain.mission["area_min"] if terrain.mission else (0.0, 0.0)
    add("the mission's own, players by base 0", terrain, "mission", "authentic", (area[0], area[1]))
    return cases


def _towers(terrain: Terrain, count: int) -> list[Solid]:
    """So many towers of 4 x 4 x 12 m in a lattice, on the ground."""
    side = max(1, int(np.ceil(np.sqrt(count))))
    k = np.arange(count)
    xy = 200.0 + FIELD * np.stack([k % side, k // side], 1) / side
    heights = terrain.height(xy).tolist()
    return [Solid.box((4, 4, 12), (x, y, z + 4)) for (x, y), z in zip(xy.tolist(), heights, strict=True)]


def _player(terrain: Terrain, scene: str, fidelity: str, corner: tuple[float, float]) -> Play:
    """A game of `CALLS` calls from the same start: skiing, jets a third of the time, the trigger held."""
    sim = Simulator(terrain, PLAYERS, scene=scene, fidelity=fidelity, threads=1)
    generator = np.random.default_rng(0)
    start = sim.state()
    xy = np.asarray(corner) + generator.uniform(0.0, FIELD, (PLAYERS, 2))
    start["position"][:, :2] = xy
    start["position"][:, 2] = terrain.height(xy)
    yaw = generator.uniform(-np.pi, np.pi, PLAYERS)
    start["yaw"] = yaw
    start["velocity"][:, 0] = -20.0 * np.sin(yaw)
    start["velocity"][:, 1] = 20.0 * np.cos(yaw)
    sim.set_state(start)
    fresh = sim.snapshot()
    calls: list[NDArray[np.void]] = []
    for call in range(CALLS):
        inputs = sim.inputs()
        inputs["forward"] = 1
        inputs["jump"] = True
        inputs["fire"] = True
        inputs["jet"] = (call + np.arange(PLAYERS)) % 12 < 4
        inputs["turn"] = 0.05
        inputs["pitch"] = -0.3
        calls.append(inputs)

    def play() -> None:
        sim.restore(fresh)
        for inputs in calls:
            sim.step(inputs, TICKS)

    return play


def _timed(play: Play) -> float:
    begin = time.perf_counter()
    play()
    return time.perf_counter() - begin
