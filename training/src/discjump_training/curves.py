"""Learning curves: the score on the validation course over the decisions trained for."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from discjump.envs.tasks import Task
from discjump_training import intervals
from discjump_training.policy import Floats


@dataclass(frozen=True)
class Curves:
    """What is drawn.

    Attributes:
        task: of all of them: whether the score is a time or a share of successes.
        runs: CSV files that runs leave (`curve.csv`), by name of the policy; several are training seeds of
            one algorithm.
        levels: score of each script on the same episodes.
    """

    task: Task
    runs: Mapping[str, Sequence[Path]]
    levels: Mapping[str, float]

    @property
    def title(self) -> str:
        """Of the axis of scores."""
        if self.task.score == "seconds":
            return f"time to {self.task.goal}, validation, s"
        return "success, validation, %"

    def read(self, path: Path) -> tuple[Floats, Floats]:
        """Decisions in millions, and scores, of one run."""
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        steps = np.array([float(row["steps"]) for row in rows]) / 1e6
        if self.task.score == "seconds":
            return steps, np.array([float(row["validation_seconds"]) for row in rows])
        return steps, 100.0 * np.array([float(row["validation_success"]) for row in rows])


def draw(axes: Axes, curves: Curves) -> None:
    """Draw a line per policy: of several training seeds the mean, with its 95% interval over seeds."""
    for name, paths in curves.runs.items():
        read = [curves.read(path) for path in paths]
        # Runs of one recipe are evaluated after the same numbers of decisions; some may be shorter.
        steps = min((one for one, _ in read), key=len)
        table = np.stack([scores[: len(steps)] for _, scores in read])
        (line,) = axes.plot(
            steps,
            table.mean(axis=0),
            marker=".",
            label=name if len(read) == 1 else f"{name}, {len(read)} seeds",
        )
        if len(read) > 1:
            found = [intervals.mean(column) for column in table.T]
            low, high = [one.low for one in found], [one.high for one in found]
            axes.fill_between(steps, low, high, color=line.get_color(), alpha=0.25, linewidth=0)
    for (name, level), style in zip(curves.levels.items(), ("dashed", "dotted", "dashdot"), strict=False):
        axes.axhline(level, color="gray", linestyle=style, label=name)
    axes.set_xlabel("decisions, millions")
    axes.set_ylabel(curves.title)
    if curves.task.score == "seconds":
        # The first minutes fall from the time limit, the rest is a matter of tenths: only a logarithm shows
        # both.
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0)))
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
