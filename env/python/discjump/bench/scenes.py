"""What a scene costs: nanoseconds a player-tick for every scene and tier, and what solids add to it."""

from collections.abc import Iterator
from typing import Any

from discjump.bench.clock import Effort, Timed, interleave, spread
from discjump.bench.ways import FAR, NEAR, SEED, Players
from discjump.simulator import FIDELITIES, SCENES, Simulator
from discjump.terrains import generated

PLAYERS = 1024
#: Calls of a repeat, of 4 ticks each: keys are held for so long, as by an agent with a frame skip of 4.
CALLS = 16


def measure(effort: Effort) -> list[dict[str, Any]]:
    """The rows of the table."""
    named = list(_cases())
    times = interleave((case for _, case in named), effort, "scenes")
    rows = []
    for name, case in named:
        timed = times[case]
        assert isinstance(timed, Timed), "every processor has the lanes that the package chooses"
        middle = spread(1e9 / timed.rate)
        row = {"case": name, "scene": case.scene, "fidelity": case.fidelity, "solids": case.solids}
        quartiles = [middle.low, middle.high]
        rows.append(
            {**row, "ns_per_player_tick": middle.median, "quartiles": quartiles, "lanes": timed.lanes}
        )
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


def _cases() -> Iterator[tuple[str, Players]]:
    for scene in SCENES:
        for fidelity in FIDELITIES:
            yield (
                "scene",
                Players(PLAYERS, 1, scene=scene, fidelity=fidelity, square=FAR, solids=None, calls=CALLS),
            )

    def mission(square: tuple[tuple[float, float], float], solids: int | None) -> Players:
        return Players(PLAYERS, 1, scene="mission", square=square, solids=solids, calls=CALLS)

    yield "no solids", mission(FAR, 0)
    yield "10 solids, players far from them", mission(FAR, 10)
    yield "1,000 solids, players far from them", mission(FAR, 1000)
    yield "1,000 solids, players among them", mission(NEAR, 1000)
    terrain = generated(SEED)
    area = terrain.mission["area_min"] if terrain.mission else (0.0, 0.0)
    yield "the mission's own, players by base 0", mission(((float(area[0]), float(area[1])), 400.0), None)
