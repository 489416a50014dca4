"""What a scene costs: time and instructions of a player-tick, for every scene and tier; what solids add."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import click

from discjump.bench import instructions
from discjump.bench.clock import Effort, Timed, interleave, spread
from discjump.bench.ways import FAR, NEAR, SEED, Players
from discjump.simulator import SCENES, SIMULATOR_FIDELITIES, Simulator
from discjump.terrains import generated

PLAYERS = 1024
#: Calls of a repeat, of 4 ticks each: keys are held for so long, as by an agent with a frame skip of 4.
CALLS = 16
BY_TIER = ("scene", "float64")
"""Cases that there is one of for every tier."""
LANES_OF = dict.fromkeys(("authentic", "swept", "fast"), instructions.LANES)
"""Players side by side that are counted, by tier; of the others one."""


def measure(effort: Effort) -> list[dict[str, Any]]:
    """The rows of the table; instructions are counted where valgrind is installed."""
    named = list(_cases())
    times = interleave((case for _, case in named), effort, "scenes")
    counts = _count([case for _, case in named], effort) if instructions.available() else {}
    rows = []
    for name, case in named:
        timed = times[case]
        assert isinstance(timed, Timed), "every processor has the lanes that the package chooses"
        middle = spread(1e9 / timed.rate)
        row = {"case": name, "scene": case.scene, "fidelity": case.fidelity, "solids": case.solids}
        quartiles = [middle.low, middle.high]
        rows.append(
            {
                **row,
                "ns_per_player_tick": middle.median,
                "quartiles": quartiles,
                "lanes": timed.lanes,
                "instructions": counts.get(case, {}),
            }
        )
    return rows


def _count(cases: list[Players], effort: Effort) -> dict[Players, dict[str, float]]:
    """Instructions of a player-tick by lanes, one player at a time and 8 where the tier has lanes."""
    counted = [(case, lanes) for case in cases for lanes in _lanes_of(case)]
    with click.progressbar(length=len(counted), label="instructions") as bar:
        ready = [replace(case, lanes=lanes) for case, lanes in counted]
        if effort.quick:
            ready = [replace(case, count=64, calls=2) for case in ready]
        counts = instructions.count(ready, progress=bar.update)
    made: dict[Players, dict[str, float]] = {}
    for (case, lanes), taken in zip(counted, counts, strict=True):
        made.setdefault(case, {})[str(lanes)] = taken
    return made


def _lanes_of(case: Players) -> tuple[int, ...]:
    return (1,) if case.precision == "float64" else LANES_OF.get(case.fidelity, (1,))


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
    lines = _grid(rows, "ns per player-tick", _cell)
    if all(row["instructions"] for row in rows):
        lines += ["", *_grid(rows, "instructions per player-tick, one player at a time / 8", counted)]
    others = [row for row in rows if row["case"] not in BY_TIER]
    base = next(row for row in others if row["case"] == "no solids")["ns_per_player_tick"]
    lines += [
        "",
        "| scene mission, authentic | ns per player-tick | over no solids | instructions |",
        "|---|---|---|---|",
    ]
    for row in others:
        share = row["ns_per_player_tick"] / base
        lines.append(f"| {row['case']} | {_cell(row)} | {share:.2f} | {counted(row)} |")
    return "\n".join(lines)


def _grid(rows: list[dict[str, Any]], what: str, cell: Callable[[dict[str, Any]], str]) -> list[str]:
    """A row for every scene, and one for float64; a column for every tier."""
    lines = [f"| {what} | " + " | ".join(SIMULATOR_FIDELITIES) + " |"]
    lines.append("|---" * (len(SIMULATOR_FIDELITIES) + 1) + "|")
    cells: dict[str, list[str]] = {}
    for row in rows:
        if row["case"] in BY_TIER:
            name = row["scene"] + (", float64" if row["case"] == "float64" else "")
            cells.setdefault(name, []).append(cell(row))
    return lines + [f"| {name} | " + " | ".join(of) + " |" for name, of in cells.items()]


def counted(row: dict[str, Any]) -> str:
    """Instructions of a row, by lanes.

    >>> counted({"instructions": {"1": 1783.7, "8": 129.4}}), counted({"instructions": {}})
    ('1,784 / 129', '-')
    """
    return " / ".join(f"{taken:,.0f}" for taken in row["instructions"].values()) or "-"


def _cell(row: dict[str, Any]) -> str:
    low, high = row["quartiles"]
    return f"{row['ns_per_player_tick']:.0f} ({low:.0f} .. {high:.0f})"


def _cases() -> Iterator[tuple[str, Players]]:
    for fidelity in SIMULATOR_FIDELITIES:
        ski = Players(PLAYERS, 1, fidelity=fidelity, square=FAR, solids=None, calls=CALLS)
        yield from (("scene", replace(ski, scene=scene)) for scene in SCENES)
        yield "float64", replace(ski, precision="float64")

    def mission(square: tuple[tuple[float, float], float], solids: int | None) -> Players:
        return Players(PLAYERS, 1, scene="mission", square=square, solids=solids, calls=CALLS)

    yield "no solids", mission(FAR, 0)
    yield "10 solids, players far from them", mission(FAR, 10)
    yield "1,000 solids, players far from them", mission(FAR, 1000)
    yield "1,000 solids, players among them", mission(NEAR, 1000)
    terrain = generated(SEED)
    area = terrain.mission["area_min"] if terrain.mission else (0.0, 0.0)
    yield "the mission's own, players by base 0", mission(((float(area[0]), float(area[1])), 400.0), None)
