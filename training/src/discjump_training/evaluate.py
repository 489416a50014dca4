"""A model in the environments that it is judged in: its observations, the task's physics.

The judging itself is in `judge`.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stable_baselines3 import PPO

from discjump.envs.options import SIGHT, SkiOptions
from discjump.envs.tasks import TASKS, Task
from discjump.terrains import SURFACES
from discjump_training import baselines, model
from discjump_training.courses import Course, course_of
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.recipe import Watch

FIDELITY = SkiOptions.fidelity
#: Ticks per decision of the task; a model that was trained with another time between its decisions is judged
#: with its own, and says so.
FRAME_SKIP = SkiOptions.frame_skip
#: Options that make up the physics of the task, whatever a model was trained in.
PHYSICS: dict[str, Any] = {"fidelity": FIDELITY, "tick_ms": SkiOptions.tick_ms, "surface": SURFACES[0]}

#: Options that a model keeps where it is judged: what it sees, and what its actions mean.
OBSERVED = (*SIGHT, "actions", "turn_rate")


def model_path(name: str) -> Path:
    """The model that `name` means: a model file, or the folder of a run, whose best model is taken."""
    path = Path(name)
    return path / model.BEST if path.is_dir() else path


def physics(task: str) -> dict[str, Any]:
    """Options that make up the physics of a task, whatever a policy was trained in."""
    of = TASKS[task].options
    return {"fidelity": of.fidelity, "tick_ms": of.tick_ms, "surface": SURFACES[0]}


def in_task(trained: Mapping[str, Any], task: str = "ski") -> dict[str, Any]:
    """Options of the task for a model that was trained with `trained`: what it observes stays its own, the
    physics is the task's, and the time between its decisions stays as near to its own as whole ticks allow.

    >>> in_task({"fidelity": "fast", "tick_ms": 64, "surface": "bilinear", "frame_skip": 2, "landing": False})
    {'landing': False, 'fidelity': 'authentic', 'tick_ms': 32, 'surface': 'triangles', 'frame_skip': 4}
    """
    of = TASKS[task].options
    own = physics(task)
    period = trained.get("tick_ms", of.tick_ms) * trained.get("frame_skip", of.frame_skip)
    seen = {name: value for name, value in trained.items() if name in OBSERVED}
    return {**seen, **own, "frame_skip": max(1, round(period / own["tick_ms"]))}


def on_stage(
    path: Path, course: Course, episodes: int, *, threads: int | None, at_home: bool = False
) -> tuple[Stage, PPO]:
    """A model and the environments that it is judged in.

    Args:
        path: of the model file.
        course: which episodes.
        episodes: how many of them.
        threads: of the simulator.
        at_home: in the physics that it was trained in, not in the task's.

    Raises:
        TrainingError: if the model cannot be had or does not fit the environment.
    """
    if not path.exists():
        raise ModelError(f"{path} is neither a model file nor the folder of a run")
    ppo = model.load(path)
    trained = model.about(path).get("environment", {})
    stage = Stage(course, episodes, trained if at_home else in_task(trained, course.task), threads)
    model.check_spaces(ppo, path, stage.env)
    return stage, ppo


def level(name: str, threads: int | None, task: Task) -> float:
    """Score of a baseline on the episodes that a task's learning curves are measured on: mean time, s, or
    share of successes, %.
    """
    of = task.name
    stage = Stage(course_of(of, "validation"), Watch().evaluate_episodes, baselines.options(of), threads)
    played = stage.play(baselines.make(name, stage))
    return float(played.seconds.mean() if task.score == "seconds" else 100.0 * played.success.mean())
