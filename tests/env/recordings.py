"""Replays that the tests of replays and of bisect share, and actions to make more."""

from typing import Any

import gymnasium
import numpy as np

import discjump
from discjump.replays import EpisodeReplay, TickReplay, record

TIERS = ("reference", "authentic", "swept", "fast", "engine")

SHORT: dict[str, Any] = {"terrain_seeds": [3], "time_limit": 4.0}


def drawn(actions: str, rng: np.random.Generator) -> np.ndarray:
    """An action, mostly forward and jumping."""
    if actions == "box":
        return rng.uniform((-0.2, -1, -0.2, -1, -1), 1).astype(np.float32)
    action = rng.integers(0, [3, 3, 2, 2, 7])
    action[:3] = np.where(rng.random(3) < 0.8, (2, 1, 1), action[:3])
    return action


def episode(seed: int = 5, every: int = 8, reset: Any = None, **options: Any) -> EpisodeReplay:
    """The replay of a first episode with drawn actions."""
    env = record(gymnasium.make("discjump/Ski-v0", **{**SHORT, **options}), every=every)
    env.reset(seed=seed, options=reset)
    rng = np.random.default_rng(seed)
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(drawn(options.get("actions", "multi_discrete"), rng))
        over = terminated or truncated
    made: EpisodeReplay = env.replays[0]
    return made


def bowl(cells: int = 20) -> discjump.Terrain:
    """A ground of one's own: a round bowl of 20 m depth."""
    axis = np.linspace(-1, 1, cells + 1)
    heights = 20 * np.add.outer(axis**2, axis**2)
    return discjump.Terrain.from_heights(heights, 8.0, (-80.0, -40.0), edge="clamp")


def ticks(fidelity: str = "authentic", scene: str = "disc_jump", length: int = 90, **more: Any) -> TickReplay:
    """Three players who run, jump, jet and shoot, with an explosion at the feet of one."""
    rng = np.random.default_rng(7)
    inputs = np.zeros((length, 3), discjump.INPUT)
    inputs["forward"] = 1
    inputs["jump"] = rng.random((length, 3)) < 0.5
    inputs["jet"] = rng.random((length, 3)) < 0.3
    inputs["fire"] = rng.random((length, 3)) < 0.1
    inputs["turn"] = rng.uniform(-2, 2, (length, 3))
    inputs["pitch"] = -1.2
    points = np.full((3, 3), np.nan)
    points[1] = (0.5, 40.0, 0.5)
    arguments = {"scene": scene, "fidelity": fidelity, "players_per_world": 3, **more}
    return TickReplay.record(bowl(), inputs, explosions={6: points}, every=16, **arguments)
