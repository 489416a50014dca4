"""What there is to learn: the tasks by name, and how each is scored."""

from dataclasses import dataclass
from typing import Literal

from discjump.envs.options import SkiOptions


@dataclass(frozen=True)
class Task:
    """One task.

    Attributes:
        name: short name, as in recipes and courses.
        id: gymnasium's id.
        options: its keyword arguments, as a dataclass; `from_keywords` checks them.
        goal: what an episode that succeeds has reached.
        score: `seconds`: the time until success, an episode that fails counting as the time limit, less is better;
            `share`: the share of episodes that succeed, more is better.
    """

    name: str
    id: str
    options: type[SkiOptions]
    goal: str
    score: Literal["seconds", "share"]


SKI = Task("ski", "discjump/Ski-v0", SkiOptions, "beacon", "seconds")

TASKS = {task.name: task for task in (SKI,)}
"""By name."""
