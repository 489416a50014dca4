"""The transfer gap: what a policy that was trained in cheaper physics loses where it counts.

The same recipe, the same number of decisions, several training seeds in each physics. Every policy is judged
twice on the same episodes on terrain it never saw: at home, in the physics it was trained in, and in the
task (`authentic`, ticks of 32 ms, cut triangles). Two differences follow:

- the *gap*, task minus home, the same policies: what home promised and the task does not keep;
- the *cost*, in the task, minus the policies that were trained in the task: what decides where to train.

Intervals are 95% bootstrap intervals over training seeds and episodes, crossed.
"""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from discjump_training import intervals
from discjump_training.courses import HELD_OUT
from discjump_training.errors import TrainingError
from discjump_training.evaluate import Judged, judge
from discjump_training.files import write_atomically
from discjump_training.intervals import Estimate
from discjump_training.recipe import Recipe

STEPS = 4_000_000
"""Decisions of a training."""
SEEDS = 5
EPISODES = HELD_OUT.episodes
JUDGED = "transfer.json"
"""In the folder of a run: what it did at home and in the task."""


@dataclass(frozen=True)
class Home:
    """The physics of a training."""

    #: In tables and as a folder.
    name: str
    #: Fields of the recipe's section `environment` that differ from the recipe.
    changes: dict[str, Any]

    def recipe(self, steps: int, overrides: Iterable[str] = ()) -> Recipe:
        """The ski recipe in this physics."""
        changes = [f"environment.{key}={json.dumps(value)}" for key, value in self.changes.items()]
        return Recipe.load("ski", (f"ppo.steps={steps}", *changes, *overrides))


TASK = Home("authentic", {})
HOMES = (
    TASK,
    Home("reference", {"fidelity": "reference"}),
    Home("swept", {"fidelity": "swept"}),
    Home("fast", {"fidelity": "fast"}),
    Home("engine", {"fidelity": "engine"}),
    Home("authentic, bilinear", {"surface": "bilinear"}),
    Home("fast, bilinear", {"fidelity": "fast", "surface": "bilinear"}),
    Home("authentic, 16 ms x 8", {"tick_ms": 16, "frame_skip": 8}),
    Home("authentic, 64 ms x 2", {"tick_ms": 64, "frame_skip": 2}),
    Home("fast, 64 ms x 2", {"fidelity": "fast", "tick_ms": 64, "frame_skip": 2}),
    Home("authentic, frame_skip 2", {"frame_skip": 2}),
    Home("authentic, frame_skip 8", {"frame_skip": 8}),
)
"""Where policies are trained: every tier; then, from the default, one change at a time, and the cheapest.

Other ticks keep the 128 ms between two decisions. A policy decides as often in the task as at home.
"""


def folder(out: Path, home: Home, seed: int) -> Path:
    """Of a run."""
    return out / home.name.replace(",", "").replace(" ", "-") / f"seed-{seed}"


def train(out: Path, home: Home, seed: int, steps: int, overrides: Iterable[str] = ()) -> Path:
    """Train where it is not done yet, from the newest checkpoint if there is one; the folder of the run.

    Raises:
        TrainingError: the folder holds a run by another recipe.
        KeyboardInterrupt: Ctrl-C; everything up to the update under way is kept.
    """
    from discjump_training import runs
    from discjump_training.train import train as learn

    where = folder(out, home, seed)
    recipe = home.recipe(steps, overrides)
    begun = runs.checkpoints(where)
    if begun or (where / "final.zip").exists():
        found = Recipe.load(where / "recipe.toml")
        if found != recipe:
            raise TrainingError(f"{where} holds a run by another recipe: choose another --out")
    if not (where / "final.zip").exists():
        result = learn(recipe, seed, where, resume=bool(begun), quiet=True)
        if not result.finished:
            raise KeyboardInterrupt
    return where


def judged(run: Path, episodes: int, threads: int | None) -> dict[str, Any]:
    """What the last model of a run does at home and in the task; kept in the run's folder.

    The last model, not the best: the best was chosen by how it does at home.
    """
    kept = run / JUDGED
    if kept.exists():
        made: dict[str, Any] = json.loads(kept.read_text())
        if made["episodes"] == episodes:
            return made
    path = str(run / "final.zip")
    at_home, in_task = (
        judge(path, HELD_OUT, episodes, sampled=False, threads=threads, record=0, at_home=home)
        for home in (True, False)
    )
    seconds = json.loads((run / "run.json").read_text())["seconds"]
    made = {
        "course": HELD_OUT.name,
        "episodes": episodes,
        "frame_skip": in_task.frame_skip,
        "training_seconds": seconds,
        "home": _played(at_home),
        "task": _played(in_task),
    }
    write_atomically(kept, (json.dumps(made) + "\n").encode())
    return made


def _played(one: Judged) -> dict[str, list[Any]]:
    return {
        "seconds": [round(value, 3) for value in one.episodes.seconds.tolist()],
        "success": one.episodes.success.tolist(),
        "mean_speed": [round(value, 4) for value in one.episodes.mean_speed.tolist()],
    }


@dataclass(frozen=True)
class Row:
    """One home. Times are s, failures count as 60 s; shares are of 1."""

    home: str
    seeds: int
    episodes: int
    #: Mean time at home and in the task.
    home_seconds: Estimate
    task_seconds: Estimate
    #: Task minus home.
    gap_seconds: Estimate
    gap_success: Estimate
    #: In the task, minus the policies trained there.
    cost_seconds: Estimate
    cost_success: Estimate
    task_success: Estimate
    failures: int
    #: Mean time in the task of each training seed.
    by_seed: list[float]
    #: Median over the seeds, s, as the trainings ran.
    training_seconds: float
    environment_share: float


def row(home: Home, runs: Sequence[dict[str, Any]], task: Sequence[dict[str, Any]]) -> Row:
    """Summary of the runs of one home, beside those that were trained in the task."""

    def table(of: Sequence[dict[str, Any]], where: str, what: str) -> Any:
        return np.array([run[where][what] for run in of], dtype=np.float64)

    success = table(runs, "task", "success")
    cost_seconds = cost_success = Estimate(0.0, 0.0, 0.0)
    if home != TASK:
        seconds = table(runs, "task", "seconds")
        cost_seconds = intervals.over_seeds_difference(seconds, table(task, "task", "seconds"))
        cost_success = intervals.over_seeds_difference(success, table(task, "task", "success"))
    spent = [run["training_seconds"] for run in runs]
    training = [one["environment"] + one["policy"] + one["update"] for one in spent]
    return Row(
        home=home.name,
        seeds=len(runs),
        episodes=runs[0]["episodes"],
        home_seconds=intervals.over_seeds(table(runs, "home", "seconds")),
        task_seconds=intervals.over_seeds(table(runs, "task", "seconds")),
        gap_seconds=intervals.over_seeds(table(runs, "task", "seconds") - table(runs, "home", "seconds")),
        gap_success=intervals.over_seeds(success - table(runs, "home", "success")),
        cost_seconds=cost_seconds,
        cost_success=cost_success,
        task_success=intervals.proportion(success.ravel() > 0.5),
        failures=int((success < 0.5).sum()),
        by_seed=[float(one) for one in table(runs, "task", "seconds").mean(axis=1)],
        training_seconds=float(np.median(training)),
        environment_share=float(np.median([one["environment"] for one in spent]) / np.median(training)),
    )


def measure(
    out: Path,
    homes: Sequence[Home],
    seeds: int,
    steps: int,
    episodes: int,
    *,
    overrides: Iterable[str] = (),
    threads: int | None = None,
    done: Callable[[str], object] = lambda _: None,
) -> list[Row]:
    """Train and judge all homes, the task's own among them, seed by seed; what is done already is not redone.

    Args:
        out: folder of all the runs.
        homes: where to train; `TASK` is added if absent.
        seeds: trainings in each, seeds 0 and up.
        steps: decisions of a training.
        episodes: of the held-out course.
        overrides: further changes of the recipe, for all.
        threads: of the simulator when judging.
        done: is told what is done, after each training with its judgement.
    """
    homes = [TASK, *(home for home in homes if home != TASK)]
    made: dict[str, list[dict[str, Any]]] = {home.name: [] for home in homes}
    for seed in range(seeds):
        for home in homes:
            run = train(out, home, seed, steps, overrides)
            made[home.name].append(judged(run, episodes, threads))
            done(f"{home.name}, seed {seed}")
    return [row(home, made[home.name], made[TASK.name]) for home in homes]
