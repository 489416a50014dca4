"""What there is to learn: the tasks by name, and how each is scored."""

from dataclasses import dataclass
from typing import Literal

from discjump.envs.options import (
    DiscJumpOptions,
    FlagRunOptions,
    RouteOptions,
    SkiOptions,
    TaskOptions,
)


@dataclass(frozen=True)
class Task:
    """One task.

    Attributes:
        name: short name, as in recipes and courses.
        id: gymnasium's id.
        options: its keyword arguments, as a dataclass; `from_keywords` checks them.
        classes: names of its classes in `discjump.envs.named`, for one environment and for many.
        goal: what an episode that succeeds has reached.
        score: `seconds`: the time until success, an episode that fails counting as the time limit, less is
            better; `share`: the share of episodes that succeed, more is better.
    """

    name: str
    id: str
    options: type[TaskOptions]
    classes: tuple[str, str]
    goal: str
    score: Literal["seconds", "share"]


SKI = Task("ski", "discjump/Ski-v0", SkiOptions, ("SkiEnv", "SkiVectorEnv"), "beacon", "seconds")
DISC_JUMP = Task(
    "disc-jump",
    "discjump/DiscJump-v0",
    DiscJumpOptions,
    ("DiscJumpEnv", "DiscJumpVectorEnv"),
    "marker",
    "share",
)
ROUTE = Task(
    "route", "discjump/Route-v0", RouteOptions, ("RouteEnv", "RouteVectorEnv"), "enemy flag", "seconds"
)
FLAG_RUN = Task(
    "flag-run",
    "discjump/FlagRun-v0",
    FlagRunOptions,
    ("FlagRunEnv", "FlagRunVectorEnv"),
    "capture",
    "seconds",
)

TASKS = {task.name: task for task in (SKI, DISC_JUMP, ROUTE, FLAG_RUN)}
"""By name."""
BY_ID = {task.id: task for task in TASKS.values()}
"""By gymnasium's id."""
