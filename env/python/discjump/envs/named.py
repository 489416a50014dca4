"""The environments by name: each task for one environment and for many."""

from discjump.envs.options import DiscJumpOptions, FlagRunOptions, RouteOptions, SkiOptions
from discjump.envs.single import TaskEnv
from discjump.envs.vector import TaskVectorEnv


class SkiEnv(TaskEnv):
    """Ski to the beacon, as fast as you can.

    An episode starts in the mission area of a terrain from the pool, at rest or at a small speed, with the
    beacon 300-800 m away. It terminates on arrival or on death by landing damage, and is truncated after 60
    s. An action holds for `frame_skip` ticks. Options: `discjump.envs.options.SkiOptions`.

    >>> import gymnasium, discjump, numpy as np
    >>> env = gymnasium.make("discjump/Ski-v0", terrain_seeds=[0])
    >>> observation, info = env.reset(seed=1, options={"start": (0.0, 0.0), "goal": (0.0, 400.0)})
    >>> round(info["distance"])
    400
    >>> observation, reward, terminated, truncated, info = env.step(np.array([2, 1, 1, 0, 3]))
    >>> sorted(info)
    ['distance', 'outside_mission_area', 'speed', 'time']
    """

    OPTIONS = SkiOptions


class SkiVectorEnv(TaskVectorEnv):
    """Many `SkiEnv`.

    >>> import gymnasium, discjump, numpy as np
    >>> envs = gymnasium.make_vec("discjump/Ski-v0", num_envs=3, terrain_seeds=[0])
    >>> observations, info = envs.reset(seed=7)
    >>> observations.dtype, info["distance"].shape
    (dtype('float32'), (3,))
    >>> actions = np.tile([2, 1, 1, 0, 3], (3, 1))
    >>> observations, rewards, terminations, truncations, info = envs.step(actions)
    >>> rewards.dtype, terminations.shape
    (dtype('float64'), (3,))
    """

    OPTIONS = SkiOptions


class DiscJumpEnv(TaskEnv):
    """Reach a marker in the air above, higher than jump and jets alone lead: with a disc under your feet.

    An episode starts on the ground or somewhat above it, with a few discs. It terminates when the path of the
    feet passes within 8 m of the marker, or on death by an explosion or a landing, and is truncated after
    16 s. Options: `discjump.envs.options.DiscJumpOptions`.

    >>> import gymnasium, discjump, numpy as np
    >>> env = gymnasium.make("discjump/DiscJump-v0", terrain_seeds=[0], start_height=0)
    >>> observation, info = env.reset(seed=1)
    >>> env.action_space
    MultiDiscrete([3 3 2 2 7 2 5])
    >>> shoot_down = np.array([1, 1, 0, 0, 3, 1, 0])
    >>> observation, reward, terminated, truncated, info = env.step(shoot_down)
    >>> observation, reward, terminated, truncated, info = env.step(shoot_down)
    >>> info["speed"] > 10
    True
    """

    OPTIONS = DiscJumpOptions


class DiscJumpVectorEnv(TaskVectorEnv):
    """Many `DiscJumpEnv`."""

    OPTIONS = DiscJumpOptions


class RouteEnv(TaskEnv):
    """Run from your own flag stand to the enemy's, past gorge, bridge and bases.

    An episode is a run of either team on a generated mission. It terminates when the path of the feet passes
    within 2.5 m of the enemy flag's foot, or on death, and is truncated after 60 s. Options:
    `discjump.envs.options.RouteOptions`.

    >>> import gymnasium, discjump
    >>> env = gymnasium.make("discjump/Route-v0", terrain_seeds=[7])
    >>> observation, info = env.reset(seed=0)
    >>> 400 < info["distance"] < 900
    True
    """

    OPTIONS = RouteOptions


class RouteVectorEnv(TaskVectorEnv):
    """Many `RouteEnv`."""

    OPTIONS = RouteOptions


class FlagRunEnv(TaskEnv):
    """Take the enemy flag and bring it home: a whole capture.

    As `RouteEnv`; touching the enemy flag takes it, and the episode ends with success when the own stand is
    touched with it. Who leaves the mission area with the flag for 4.5 s loses it: it is back on its stand.
    Truncated after 120 s. Options: `discjump.envs.options.FlagRunOptions`.
    """

    OPTIONS = FlagRunOptions


class FlagRunVectorEnv(TaskVectorEnv):
    """Many `FlagRunEnv`."""

    OPTIONS = FlagRunOptions
