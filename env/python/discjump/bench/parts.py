"""Where the time of an environment's step goes, by batch size, and its picture. One thread, frame_skip 1."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from discjump._native import time_environments
from discjump.bench.clock import Effort, Ready, Timed, Times, interleave
from discjump.bench.figure import short
from discjump.bench.ways import Agents, Players, Vector, random_actions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZES = (1, 8, 64, 512, 4096, 32768)
LARGE = 512
"""Batches from here on are drawn in ns: the time of smaller ones is all Python's."""
HIGH = 3000.0
"""Height that no tick of a repeat falls through, m: there nothing marches over terrain."""
NAMES = {
    "input": "input",
    "terrain": "terrain",
    "forces": "forces",
    "observation": "observation",
    "task": "reward, end, reset",
    "output": "output",
    "rest": "rest of the step",
    "python": "Python",
}
"""What each part is called, from the bottom of the picture to its top."""
COLOURS = {
    "input": "#999999",
    "terrain": "#009e73",
    "forces": "#56b4e9",
    "observation": "#0072b2",
    "task": "#e69f00",
    "output": "#cc79a7",
    "rest": "#dddddd",
    "python": "#d55e00",
}
"""Of the parts; told apart by colour-blind eyes too."""


@dataclass(frozen=True)
class Clocked:
    """Steps from Rust while the core keeps a clock on their parts."""

    agents: Agents
    parts: list[dict[str, float]] = field(default_factory=list, compare=False)
    """Of each run, s per environment's step."""
    calls: ClassVar[int | None] = None

    @property
    def units(self) -> int:
        """Agent steps."""
        return self.agents.units

    def make(self) -> Ready:
        """The environments and their actions."""
        batch, actions = self.agents.batch(), random_actions(self.agents.num_envs, np.int8)

        def timed(calls: int) -> float:
            seconds, parts = time_environments(batch, actions, calls, parts=True)
            self.parts.append({name: taken / (calls * self.units) for name, taken in parts})
            return seconds

        return Ready(timed, batch.observation_size)


def measure(effort: Effort, sizes: tuple[int, ...] = SIZES) -> list[dict[str, Any]]:
    """For each size: ns per environment's step in all, and by part."""
    return [_split(size, effort) for size in sizes]


def _split(size: int, effort: Effort) -> dict[str, Any]:
    rust, clocked = Agents(size, threads=1), Clocked(Agents(size, threads=1))
    python = Vector(size, threads=1, dtype="int8")
    ground, high = (Players(size, 1, ticks=1, lift=lift) for lift in (0.0, HIGH))
    times = interleave((rust, clocked, python, ground, high), effort, f"{size:>6} environments")
    runs = clocked.parts[-effort.repeats :]
    parts = {name: 1e9 * float(np.median([run[name] for run in runs])) for name in runs[0]}
    if "physics" in parts:
        # The core does not tell them apart: what the same tick takes where no ground is near is forces.
        share = _ns(times, high) / _ns(times, ground)
        whole = parts.pop("physics")
        parts |= {"forces": whole * min(share, 1.0), "terrain": whole * max(1.0 - share, 0.0)}
    step = _ns(times, rust)
    parts["rest"] = max(step - sum(parts.values()), 0.0)
    parts["python"] = max(_ns(times, python) - step, 0.0)
    return {"num_envs": size, "rust_ns": step, "vector_ns": _ns(times, python), "parts_ns": parts}


def _ns(times: Times, case: Agents | Vector | Players) -> float:
    timed = times[case]
    assert isinstance(timed, Timed), "the lanes that the package chooses are there"
    return float(np.median(1e9 / timed.rate))


def table(rows: list[dict[str, Any]]) -> str:
    """The parts as Markdown.

    >>> print(table([{"num_envs": 8, "vector_ns": 30.0, "parts_ns": {"input": 9.0, "python": 21.0}}]))
    | environments | input | Python | VectorEnv.step, ns per environment |
    |---|---|---|---|
    | 8 | 9.0 | 21.0 | 30.0 |
    """
    names = [name for name in NAMES if any(name in row["parts_ns"] for row in rows)]
    heads = ["environments", *(NAMES[name] for name in names), "VectorEnv.step, ns per environment"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for row in rows:
        cells = [f"{row['parts_ns'].get(name, 0.0):.1f}" for name in names]
        lines.append("| " + " | ".join([f"{row['num_envs']:,}", *cells, f"{row['vector_ns']:.1f}"]) + " |")
    return "\n".join(lines)


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """The picture as a PNG: on the left each part's share of the time, on the right ns of large batches."""
    from matplotlib.figure import Figure  # this command alone needs it

    figure = Figure(figsize=(12.0, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    _bars(left, rows, [100.0 / sum(row["parts_ns"].values()) for row in rows])
    for place, row in enumerate(rows):
        left.text(place, 101.0, f"{short(row['vector_ns'])} ns", ha="center", fontsize=8)
    left.set_ylabel("share of VectorEnv.step, %")
    large = [row for row in rows if row["num_envs"] >= LARGE] or rows
    _bars(right, large, [1.0] * len(large))
    totals = [row["vector_ns"] for row in large]
    right.plot(range(len(large)), totals, "k_", markersize=30, label="with no clock on the parts")
    right.set_ylabel("ns per environment's step")
    handles, labels = right.get_legend_handles_labels()
    figure.legend(handles[::-1], labels[::-1], frameon=False, loc="outside right center")
    figure.suptitle("Where the time of a step goes: one thread, frame_skip 1")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)


def _bars(axes: "Axes", rows: list[dict[str, Any]], scales: list[float]) -> None:
    """A bar for each row, every part times the row's scale."""
    places, bottom = np.arange(len(rows)), np.zeros(len(rows))
    for name, label in NAMES.items():
        parts = [row["parts_ns"].get(name, 0.0) * scale for row, scale in zip(rows, scales, strict=True)]
        if any(parts):
            axes.bar(places, parts, 0.7, bottom, label=label, color=COLOURS[name])
            bottom += parts
    axes.set_xticks(places, [f"{row['num_envs']:,}" for row in rows])
    axes.set_xlabel("environments")
    axes.spines[["top", "right"]].set_visible(False)
