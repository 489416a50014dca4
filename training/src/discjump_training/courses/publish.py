"""Makes the first public course of a task: `python -m discjump_training.courses.publish TASK`."""

import json
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from discjump import Terrain
from discjump.envs.tasks import TASKS
from discjump_training.courses.course import Course, Place
from discjump_training.courses.public import SCHEMA, point
from discjump_training.courses.table import Row, row
from discjump_training.errors import TrainingError

EPISODES = 128


def make(task: Row, version: int = 1) -> dict[str, Any]:
    """The content of a new file: starts and goals as the task itself draws them, to a decimetre."""
    pool, base = task.pool("public"), task.base_seed("public")
    # Every terrain has as many episodes: a terrain's mean weighs no more than another's.
    seeds = [pool[i % len(pool)] for i in range(EPISODES)]
    env: Any = gymnasium.make_vec(TASKS[task.task].id, num_envs=EPISODES, terrain_seeds=list(pool), threads=1)
    inner: Any = env.unwrapped
    env.reset(seed=[base + i for i in range(EPISODES)], options={"terrain_seed": seeds})
    starts, goals = (
        np.round(points[:, :2], 1).tolist() for points in (inner.state()["position"], inner.goals())
    )
    episodes = [
        {"terrain_seed": seed, **({"start": start, "goal": goal} if task.placed else {})}
        for seed, start, goal in zip(seeds, starts, goals, strict=True)
    ]
    made = Course(
        f"{task.task}-public-v{version}",
        pool,
        base,
        EPISODES,
        task.task,
        tuple(Place(e["terrain_seed"], point(e.get("start")), point(e.get("goal"))) for e in episodes),
    )
    return {
        "schema_version": SCHEMA,
        "name": made.name,
        "task": task.task,
        "digest": made.digest(),
        "first_environment_seed": base,
        "terrains": {str(seed): Terrain.raindance(seed).digest() for seed in pool},
        "episodes": episodes,
    }


def write(task: str) -> Path:
    """Write a task's first public course beside this module.

    Raises:
        TrainingError: it is there already.
    """
    made = make(row(task))
    path = Path(__file__).with_name(f"{made['name']}.json")
    if path.exists():
        raise TrainingError(f"{path} is there already: a published course is never changed")
    lines = ",\n  ".join(json.dumps(one) for one in made.pop("episodes"))
    path.write_text(json.dumps(made, indent=1)[:-2] + f',\n "episodes": [\n  {lines}\n ]\n}}\n')
    return path


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m discjump_training.courses.publish TASK")
    print(write(sys.argv[1]))
