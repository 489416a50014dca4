"""The movement of Tribes 1 (skiing, jetting, disc jumping), batched for reinforcement learning.

    _native     the simulator, compiled from Rust: Terrain, Simulator, TaskBatch
    simulator   bodies without a task: Simulator, Physics, Scene, INPUT, STATE
    solids      what stands on a terrain: Solid
    explosions  how a blast's push falls off: knockback
    terrains    generated terrains, cached
    envs        gymnasium environments; importing discjump registers their ids
    sb3         stable-baselines3 adapter (import discjump.sb3)
    accuracy    how far the fidelity tiers stray from `reference`
    features    what leaving a feature of a scene out changes
    theory      the simulator against closed forms
    stress      whether the simulator stands its extremes
    replays     episodes and ticks in files, played again bit for bit
    bisect      where two runs part
    testing     conformance of any vector environment, for other people's CI
    verify      whether a rollout's bits depend on anything but seeds and actions
    cli         the command `discjump`

Arrows point down only: cli -> accuracy, features, theory, stress, verify, bisect, sb3 -> replays -> envs ->
terrains, simulator, explosions -> _native.
"""

from importlib.metadata import version

import gymnasium

from discjump import terrains as terrains  # says how terrains are copied and pickled
from discjump._native import Terrain
from discjump.envs.tasks import TASKS
from discjump.explosions import knockback
from discjump.simulator import INPUT, SCENES, STATE, Physics, Scene, Simulator
from discjump.solids import Solid

__version__ = version("discjump")

__all__ = [
    "INPUT",
    "SCENES",
    "STATE",
    "Physics",
    "Scene",
    "Simulator",
    "Solid",
    "Terrain",
    "__version__",
    "knockback",
]

# No max_episode_steps: the core ends episodes on exact ticks, and gymnasium's TimeLimit would count twice.
for _task in TASKS.values():
    gymnasium.register(
        id=_task.id,
        entry_point=f"discjump.envs.named:{_task.classes[0]}",
        vector_entry_point=f"discjump.envs.named:{_task.classes[1]}",
    )
