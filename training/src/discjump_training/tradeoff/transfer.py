"""Section: what a policy loses where it counts that was trained in other physics.

The same recipe, the same number of decisions, several training seeds in each physics. The last policy of
every run (not the best, which was chosen by how it does at home) is judged twice on the same episodes on
terrain it never saw: at home, in the physics it was trained in, and in the task. Two differences follow:

- the *gap*, task minus home, of the same policies: what home promised and the task does not keep;
- the *cost*, in the task, minus the policies that were trained there: what decides where to train.

A policy decides as often in the task as at home.
"""

import hashlib
import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from discjump_training import courses, episodes, evaluate, intervals, model
from discjump_training.courses import HELD_OUT
from discjump_training.evaluate import on_stage
from discjump_training.intervals import Estimate
from discjump_training.runs import seconds_of
from discjump_training.tradeoff.grid import Config, Plan
from discjump_training.tradeoff.homes import TASK, Home, homes, train
from discjump_training.tradeoff.outcomes import at_most
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds, points
from discjump_training.tradeoff.store import Missing, Store, build, code

RUNS = "runs"
"""Folder of all trainings; they outlive `--anew`."""
FLOOR = 0.05
"""Of the picture's error axis, s."""


class Transfer:
    """The section."""

    name = "transfer"

    def work(self, plan: Plan) -> int:
        """Trainings."""
        return plan.seeds * len(homes(plan))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Train and judge what is not done yet, seed by seed over all homes."""
        out = store.folder / RUNS
        played: dict[Home, list[dict[str, Any]]] = {home: [] for home in homes(plan)}
        for seed in range(plan.seeds):
            for home, runs in played.items():
                final = home.folder(out, seed) / "final.zip"
                if store.frozen and not final.exists():
                    raise Missing(f"{self.name}: {final} was not trained yet")
                where = train(home, plan, out, seed)
                identity = {
                    "model": hashlib.blake2b(final.read_bytes(), digest_size=16).hexdigest(),
                    "course": HELD_OUT.name,
                    "episodes": plan.episodes,
                    "build": build(),
                    "code": code(courses, episodes, evaluate),
                }
                make = partial(judged, where, plan.episodes)
                spent = json.loads((where / "run.json").read_text())
                runs.append({"run": spent, **store.piece(self.name, identity, make)})
                done(1)
        return {
            "course": HELD_OUT.name,
            "episodes": plan.episodes,
            "steps": plan.steps,
            "seeds": plan.seeds,
            "interval": f"{intervals.CONFIDENCE:.0%}, bootstrap over training seeds and episodes, crossed; "
            "success: exact",
            "rows": [row(home, runs, played[TASK]) for home, runs in played.items()],
        }

    def tables(self, made: Made) -> list[str]:
        """A line for each home."""
        lines = [
            "## Transfer",
            "",
            f"PPO by the trade-off's own recipe, {made['steps']:,} decisions and {made['seeds']} training "
            f"seeds in each physics, judged on {made['episodes']} episodes of {made['course']}; failures "
            f"count as 60 s. Gap: the same policies in the task (`{TASK.name}`) minus at home. Cost: in the "
            f"task, minus those that were trained there: above 0 is worse. In brackets {made['interval']}.",
            "",
            "| trained in | time at home, s | time in the task, s | gap, s | gap, success | cost, s "
            "| cost, success | success in the task, % | failures | trained for, s |",
            "|---" * 10 + "|",
        ]
        for one in made["rows"]:
            of = {key: Estimate(**value) for key, value in one.items() if isinstance(value, dict)}
            itself = one["home"] == TASK.name
            cells = [
                _cell(of["home_seconds"]),
                _cell(of["task_seconds"]),
                _cell(of["gap_seconds"], "+"),
                _cell(of["gap_success"], "+", 100.0),
                "" if itself else _cell(of["cost_seconds"], "+"),
                "" if itself else _cell(of["cost_success"], "+", 100.0),
                _cell(of["task_success"], "", 100.0),
                f"{one['failures']} of {one['seeds'] * made['episodes']:,}",
                f"{one['trained_seconds']:.0f}",
            ]
            lines.append(f"| {one['home']} | {' | '.join(cells)} |")
        return [
            *lines,
            "",
            "Trained for: median over the seeds of what each run's own clock said, on a machine that may "
            "have been busy; the next table is timed in turns.",
            "",
        ]

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """What it costs to train there, at most."""
        rows = [one for one in made["rows"] if one["frame_skip"] == Config.of(one).frame_skip]
        costs = {Config.of(one): max(0.0, one["cost_seconds"]["high"]) for one in rows}
        return [
            Panel(
                "Policy trained there, judged in the task",
                "agents, a decision each 128 ms",
                "slower than one trained in the task by at most (95%)",
                "s",
                points(costs, speeds.agents),
                FLOOR,
            )
        ]


def judged(run: Path, count: int) -> dict[str, Any]:
    """What the last model of a run does at home and in the task, episode by episode."""
    # As in training: two threads are slower than one for so small a network where another job runs.
    torch.set_num_threads(1)
    return {"home": _played(run, count, at_home=True), "task": _played(run, count, at_home=False)}


def _played(run: Path, count: int, *, at_home: bool) -> dict[str, Any]:
    stage, ppo = on_stage(run / "final.zip", HELD_OUT, count, threads=None, at_home=at_home)
    episodes = stage.play(model.Greedy(ppo, run.name))
    stage.close()
    return {
        "frame_skip": stage.frame_skip,
        "seconds": [round(value, 3) for value in episodes.seconds.tolist()],
        "success": episodes.success.tolist(),
        "mean_speed": [round(value, 4) for value in episodes.mean_speed.tolist()],
    }


def row(home: Home, runs: list[dict[str, Any]], task: list[dict[str, Any]]) -> dict[str, Any]:
    """Summary of the runs of one home, beside those that were trained in the task."""

    def table(of: list[dict[str, Any]], where: str, what: str) -> Any:
        return np.array([run[where][what] for run in of], dtype=np.float64)

    at_home, in_task = (table(runs, where, "seconds") for where in ("home", "task"))
    kept, success = (table(runs, where, "success") for where in ("home", "task"))
    cost_seconds = cost_success = Estimate(0.0, 0.0, 0.0)
    if home != TASK:
        cost_seconds = intervals.over_seeds_difference(in_task, table(task, "task", "seconds"))
        cost_success = intervals.over_seeds_difference(success, table(task, "task", "success"))
    estimates = {
        "home_seconds": intervals.over_seeds(at_home),
        "task_seconds": intervals.over_seeds(in_task),
        "gap_seconds": intervals.over_seeds(in_task - at_home),
        "gap_success": intervals.over_seeds(success - kept),
        "cost_seconds": cost_seconds,
        "cost_success": cost_success,
        "task_success": intervals.proportion(success.ravel() > 0.5),
    }
    return {
        "home": home.name,
        **home.config.keys,
        "frame_skip": home.frame_skip,
        "task_frame_skip": runs[0]["task"]["frame_skip"],
        "seeds": len(runs),
        **{key: value.as_dict() for key, value in estimates.items()},
        "failures": int((success < 0.5).sum()),
        "seconds_by_seed": in_task.mean(axis=1).tolist(),
        "trained_seconds": float(np.median([seconds_of(one["run"]) for one in runs])),
        "environment_share": float(np.median([one["run"]["environment_share"] for one in runs])),
        "largest_cost": at_most(cost_seconds.as_dict()),
    }


def _cell(of: Estimate, sign: str = "", scale: float = 1.0) -> str:
    """A value with its interval; a scale of 100 makes percent of shares.

    >>> _cell(Estimate(18.634, 18.2, 19.0)), _cell(Estimate(-0.01, -0.02, 0.0), "+", 100.0)
    ('18.63 [18.20, 19.00]', '-1.0 [-2.0, +0.0]')
    """
    digits = 2 if scale == 1.0 else 1
    value, low, high = (f"{scale * end:{sign}.{digits}f}" for end in (of.value, of.low, of.high))
    return f"{value} [{low}, {high}]"
