"""Episodes of a scripted skier in any configuration, compared with the same episodes in another.

He looks where he goes, so that he makes up for errors; what remains is what a user feels.
"""

from typing import Any

import numpy as np

from discjump_training import baselines, intervals
from discjump_training.courses import HELD_OUT
from discjump_training.episodes import Stage
from discjump_training.errors import TrainingError
from discjump_training.tradeoff.grid import Config

FIGURES = {"seconds": "time to beacon, s", "top_speed": "top speed, m/s", "damage": "damage"}
"""What is compared, by key."""
ALIKE_M = 0.01
"""How far apart the same start or beacon may be in two arithmetics, m."""


def play(skier: str, config: Config, frame_skip: int, count: int) -> dict[str, Any]:
    """What happened, episode by episode."""
    physics = {"fidelity": config.tier, "tick_ms": config.tick_ms, "surface": config.surface}
    options = {**baselines.OPTIONS, **physics, "frame_skip": frame_skip}
    stage = Stage(HELD_OUT, count, options)
    played = stage.play(baselines.make(skier, stage))
    stage.close()
    return {
        **{key: getattr(played, key).tolist() for key in FIGURES},
        "success": played.success.tolist(),
        "death": played.death.tolist(),
        "terrain": played.terrain.tolist(),
        "start_distance": played.start_distance.tolist(),
        "goals": played.goals[:, :2].tolist(),
    }


def compared(own: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Means, and differences from the truth pair by pair.

    Raises:
        TrainingError: they are not the same episodes.
    """
    for key in ("terrain", "start_distance", "goals"):
        apart = np.abs(np.array(own[key], np.float64) - np.array(truth[key], np.float64)).max()
        if apart > ALIKE_M:
            raise TrainingError(f"expected the same episodes, but their {key} differs by {apart:g}")
    row: dict[str, Any] = {}
    for key in FIGURES:
        a, b = (np.array(of[key], np.float64) for of in (own, truth))
        row[key] = {
            "mean": float(a.mean()),
            "difference": intervals.mean_difference(a, b).as_dict(),
            "typical": float(np.median(np.abs(a - b))),
        }
    success = np.array(own["success"], np.bool_)
    return {**row, "success": intervals.proportion(success).as_dict(), "deaths": int(np.sum(own["death"]))}
