"""Section: how long a training takes in each physics, by the wall clock.

Short trainings from nothing, each physics once in every round, one after the other, so that a busy machine
slows all alike. What a tier gains here is less than what it gains by itself: most of a training is learning.
"""

import json
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from discjump._results import machine
from discjump.bench.clock import spread
from discjump_training import train as training
from discjump_training.runs import PARTS, seconds_of
from discjump_training.tradeoff import homes as places
from discjump_training.tradeoff.grid import Plan
from discjump_training.tradeoff.homes import Home, homes, train
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds
from discjump_training.tradeoff.speed import digits
from discjump_training.tradeoff.store import Store, build, code


class Training:
    """The section."""

    name = "training"

    def work(self, plan: Plan) -> int:
        """Trainings."""
        return plan.training_repeats * len(homes(plan))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Time what is not in the store, round by round."""
        spent: dict[Home, list[dict[str, float]]] = {home: [] for home in homes(plan)}
        for number in range(plan.training_repeats):
            for home, rounds in spent.items():
                identity = {
                    "home": [home.config.keys, home.frame_skip],
                    "steps": plan.training_steps,
                    "quick": plan.quick,
                    "round": number,
                    "machine": machine(),
                    "build": build(),
                    "code": code(training.__file__, places),
                }
                rounds.append(store.piece(self.name, identity, partial(timed, home, plan)))
                done(1)
        return {
            "steps": plan.training_steps,
            "recipe_steps": plan.steps,
            "rows": [_row(home, rounds, plan) for home, rounds in spent.items()],
        }

    def tables(self, made: Made) -> list[str]:
        """Rates, what they come to, and the shares."""
        lines = [
            "## Time of a training",
            "",
            f"Trainings of {made['steps']:,} decisions from nothing, one physics after the other, "
            "simulator and learner on a thread each: median (quartiles).",
            "",
            f"| trained in | decisions/s | {made['recipe_steps']:,} decisions, s | environment | policy "
            "| update |",
            "|---" * 6 + "|",
        ]
        for one in made["rows"]:
            rate = one["rate"]
            middle, low, high = (digits(rate[name]) for name in ("median", "low", "high"))
            shares = " | ".join(f"{one['shares'][part]:.1%}" for part in PARTS)
            took = made["recipe_steps"] / rate["median"]
            lines.append(f"| {one['home']} | {middle} ({low} .. {high}) | {took:.0f} | {shares} |")
        return [*lines, ""]

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """None."""
        return []


def timed(home: Home, plan: Plan) -> dict[str, float]:
    """Seconds that a short training spent on each part, and its decisions."""
    short = replace(plan, steps=plan.training_steps)
    with tempfile.TemporaryDirectory() as folder:
        where = train(home, short, Path(folder), 0)
        run = json.loads((where / "run.json").read_text())
    return {"steps": run["steps"], **{part: seconds_of(run, [part]) for part in PARTS}}


def _row(home: Home, rounds: list[dict[str, float]], plan: Plan) -> dict[str, Any]:
    taken = np.array([[one[part] for part in PARTS] for one in rounds])
    rates = np.array([one["steps"] for one in rounds]) / taken.sum(axis=1)
    shares = np.median(taken / taken.sum(axis=1, keepdims=True), axis=0)
    return {
        "home": home.name,
        **home.config.keys,
        "frame_skip": home.frame_skip,
        "rate": spread(rates)._asdict(),
        "rates": rates.tolist(),
        "shares": dict(zip(PARTS, shares.tolist(), strict=True)),
    }
