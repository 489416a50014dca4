"""Tables of what was planned."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console
from rich.table import Table

from discjump_training import intervals
from discjump_training.intervals import Estimate
from discjump_training.markdown import cell
from discjump_training.planner.planned import Planned

Figures = dict[str, float | dict[str, float]]


def figures(planned: Planned) -> Figures:
    """Time, success and cost with their intervals, for JSON.

    `simulated_per_decision` are decisions of all candidates for each real one; seconds are means
    over episodes.
    """
    outcomes = planned.outcomes
    real = sum(one.decisions for one in outcomes)
    costs = [one.cost for one in outcomes]
    return {
        "episodes": len(outcomes),
        "seconds": intervals.mean(planned.seconds).as_dict(),
        "success": intervals.proportion(planned.success).as_dict(),
        "deaths": sum(one.death for one in outcomes),
        "timeouts": sum(one.timeout for one in outcomes),
        "simulated_per_decision": sum(one.decisions for one in costs) / real,
        "ticks_per_decision": sum(one.ticks for one in costs) / real,
        "simulated_seconds": float(np.mean([one.simulated_seconds for one in costs])),
        "wall_seconds": float(np.mean([one.wall_seconds for one in costs])),
        "cpu_seconds": float(np.mean([one.cpu_seconds for one in costs])),
    }


HEADING = (
    "plan",
    "success, %",
    "time, s",
    "simulated decisions / decision",
    "simulated, h / episode",
    "wall, s / episode",
    "CPU, s / episode",
)


def estimate(value: float | dict[str, float]) -> Estimate:
    """An estimate of `figures`."""
    assert isinstance(value, dict)
    return Estimate(**value)


def row(name: str, told: Figures) -> list[str]:
    """A row of the table."""
    return [
        name,
        cell(estimate(told["success"]), "%", 1),
        cell(estimate(told["seconds"]), "s", 2),
        f"{told['simulated_per_decision']:,.0f}",
        f"{told['simulated_seconds'] / 3600:,.1f}",  # type: ignore[operator]
        f"{told['wall_seconds']:,.1f}",
        f"{told['cpu_seconds']:,.1f}",
    ]


def caption(planned: Planned) -> str:
    """What the figures mean."""
    count, wanted = len(planned.outcomes), planned.wanted
    missing = f" PARTIAL: {count} of {wanted} episodes are planned." if planned.partial else ""
    return (
        f"{planned.course.name}: its first {wanted} episodes; in brackets 95% intervals over episodes; "
        f"time-outs and deaths count as the time limit.{missing}"
    )


def show(console: Console, planned: Planned) -> None:
    """Print the table of one plan."""
    table = Table()
    for index, title in enumerate(HEADING):
        table.add_column(title, justify="right" if index else "left", overflow="fold")
    table.add_row(*row(describe(planned), figures(planned)))
    console.print(table)
    console.print(caption(planned))


def describe(planned: Planned) -> str:
    """A plan in a few words."""
    s = planned.settings
    guides = f", guided by {_few(planned.guides)}" if planned.guides and s.guided else ""
    value = f"value of {_few(planned.values)}" if planned.values else "no value network"
    value += ", rewards" if s.objective == "rewards" and not planned.values else ""
    return f"{s.proposal}, {s.candidates} × {s.iterations} × {s.horizon:g} s{guides}, {value}"


def _few(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{len(names)} models"
