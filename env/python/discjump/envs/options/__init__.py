"""Options of the tasks, in typed places.

base        what every task has
ski         Ski-v0
disc_jump   DiscJump-v0
flags       Route-v0 and FlagRun-v0
"""

from discjump.envs.options.base import (
    DIFFICULTIES,
    FAN_BEARINGS,
    FAN_RANGES,
    REWARD,
    SIGHT,
    Level,
    TaskOptions,
)
from discjump.envs.options.disc_jump import DiscJumpOptions
from discjump.envs.options.flags import FlagRunOptions, RouteOptions
from discjump.envs.options.ski import SkiOptions

__all__ = [
    "DIFFICULTIES",
    "FAN_BEARINGS",
    "FAN_RANGES",
    "REWARD",
    "SIGHT",
    "DiscJumpOptions",
    "FlagRunOptions",
    "Level",
    "RouteOptions",
    "SkiOptions",
    "TaskOptions",
]
