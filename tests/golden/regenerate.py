"""The golden digests: python tests/golden/regenerate.py rewrites them.

A digest names every bit of a rollout: observations, rewards, flags and the final state. One that changes
means that old scores no longer hold: the id needs a new version (`CHANGELOG.md`), or the change is a defect.
"""

import hashlib
import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import discjump
from discjump.envs import named
from discjump.envs.named import SkiVectorEnv
from discjump.envs.tasks import SKI, TASKS

FILE = Path(__file__).with_name("digests.json")
TERRAIN_SEEDS = (0, 1, 7, 10_000, 2**64 - 1)
TIERS = ("authentic", "reference", "swept", "fast", "engine")
NUM_ENVS, DECISIONS = 48, 500
SCENE_DECISIONS = 75
OTHERS = tuple(task for task in TASKS.values() if task is not SKI)
"""Tasks with a launcher."""
LAUNCHER_DECISIONS = 150


def actions(decision: int) -> NDArray[np.int64]:
    """(NUM_ENVS, 5) actions by plain arithmetic: no generator whose stream may change.

    Forward and jump are held half of the time, so that some players ski far and others walk.
    """
    index = np.arange(NUM_ENVS * 5, dtype=np.uint64).reshape(NUM_ENVS, 5)
    mixed = (index * np.uint64(2_654_435_761) + np.uint64(decision // 5) * np.uint64(40_503)) % np.uint64(
        65_521
    )
    drawn = (mixed % np.array([3, 3, 2, 2, 7], np.uint64)).astype(np.int64)
    held = np.where(np.arange(NUM_ENVS)[:, None] % 2 == 0, [2, 1, 1, 0, 3], drawn)
    held[:, 3:] = drawn[:, 3:]
    return held


def rollout(fidelity: str, surface: str = "triangles") -> str:
    """Digest of a rollout of `discjump/Ski-v0` on a tier; episodes end by arrival and by the clock."""
    envs = SkiVectorEnv(
        NUM_ENVS, fidelity=fidelity, surface=surface, threads=1, terrain_seeds=[0, 1, 2, 3], time_limit=20.0
    )
    digest = hashlib.sha256()
    observations, _ = envs.reset(seed=0)
    digest.update(observations.tobytes())
    for decision in range(DECISIONS):
        for array in envs.step(actions(decision))[:4]:
            digest.update(array.tobytes())
    digest.update(envs.state().tobytes())
    return digest.hexdigest()


def shooting(id: str, fidelity: str) -> str:
    """Digest of a rollout of a task with a launcher: as `rollout`, and now and then a disc at one's feet."""
    [task] = [task for task in OTHERS if task.id == id]
    envs = getattr(named, task.classes[1])(
        NUM_ENVS, fidelity=fidelity, threads=1, terrain_seeds=[0, 1, 2, 3], time_limit=12.0
    )
    digest = hashlib.sha256()
    observations, _ = envs.reset(seed=0)
    digest.update(observations.tobytes())
    index = np.arange(NUM_ENVS)
    ends = 0
    for decision in range(LAUNCHER_DECISIONS):
        fire = (decision + index) % 12 == 0
        keys = np.column_stack([actions(decision), fire, index % 5])
        step = envs.step(keys)
        ends += int((step[2] | step[3]).sum())
        for array in step[:4]:
            digest.update(array.tobytes())
    assert ends > 10, f"{id}, {fidelity}: {ends} episodes ended"
    digest.update(envs.state().tobytes())
    return digest.hexdigest()


def scene(name: str, fidelity: str, surface: str = "triangles") -> str:
    """Digest of 16 worlds of 3 players about the bridge and in a base, who ski, jet and fire."""
    terrain = discjump.Terrain.raindance(0, surface=surface)
    assert terrain.mission is not None
    sim = discjump.Simulator(
        terrain, NUM_ENVS, name, fidelity=fidelity, threads=1, players_per_world=3, weapon="disc"
    )
    index = np.arange(NUM_ENVS)
    state = sim.state()
    middle = np.where(
        (index // 3 % 2 == 0)[:, None], terrain.mission["bridge_centre"], terrain.mission["flag_stands"][0]
    )
    state["position"] = middle + np.column_stack([3.0 * (index % 3) - 3.0, 0.25 * (index // 6), 0.0 * index])
    state["position"][:, 2] += 0.25
    state["yaw"] = 0.5 * (index % 12) - 3.0
    sim.set_state(state)
    digest = hashlib.sha256()
    blasts = 0
    for decision in range(SCENE_DECISIONS):
        drawn = actions(decision)
        inputs = sim.inputs()
        inputs["forward"], inputs["strafe"] = drawn[:, 0] - 1, drawn[:, 1] - 1
        inputs["jump"], inputs["jet"] = drawn[:, 2], drawn[:, 3]
        inputs["fire"], inputs["turn"] = drawn[:, 4] > 2, 0.25 * (drawn[:, 4] - 3)
        inputs["pitch"] = 0.25 * (index % 5 - 3)
        for _ in range(4):
            sim.step(inputs)
            blasts += len(sim.blasts())
        if decision % 25 == 24 and "blast" in sim.scene.models:
            sim.explode(sim.state()["position"] + (1.0, 0.0, 0.0))
        digest.update(sim.state().tobytes())
    assert "discs" not in sim.scene.models or blasts > 20, f"{name}, {fidelity}: {blasts} discs burst"
    digest.update(sim.digest().encode())
    return digest.hexdigest()


def digests() -> dict[str, dict[str, str]]:
    """All golden digests, computed now."""
    return {
        "discjump/Ski-v0": {fidelity: rollout(fidelity) for fidelity in TIERS},
        **{task.id: {fidelity: shooting(task.id, fidelity) for fidelity in TIERS} for task in OTHERS},
        **{
            f"scene {name}": {fidelity: scene(name, fidelity) for fidelity in TIERS}
            for name in ("sandbox", "disc_jump", "mission")
        },
        "discjump/Ski-v0, bilinear": {fidelity: rollout(fidelity, "bilinear") for fidelity in TIERS},
        "scene mission, bilinear": {fidelity: scene("mission", fidelity, "bilinear") for fidelity in TIERS},
        "solids": {"0": discjump.Terrain.raindance(0).solids_digest()},
        "bilinear terrain": {"0": discjump.Terrain.raindance(0, surface="bilinear").digest()},
        "terrain": {str(seed): discjump.Terrain.raindance(seed).digest() for seed in TERRAIN_SEEDS},
        "repeating terrain": {
            str(seed): discjump.Terrain.raindance(seed, repeating=True).digest() for seed in TERRAIN_SEEDS[:2]
        },
    }


if __name__ == "__main__":
    FILE.write_text(json.dumps(digests(), indent=1) + "\n")
    print(FILE)
