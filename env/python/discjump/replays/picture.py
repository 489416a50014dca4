"""The command map of a replay's episode."""

from pathlib import Path

import numpy as np
from PIL import Image

from discjump.envs.command_map import CommandMap
from discjump.replays.episode import EpisodeReplay
from discjump.replays.errors import ReplayError
from discjump.replays.replay import Replay

SIZE = 800


def draw(replay: Replay, path: Path) -> None:
    """Play the episode and draw its path.

    Raises:
        ReplayError: `path` is no .png; the replay is of a simulator, which has no beacon; it cannot be
            played here.
    """
    if path.suffix.lower() != ".png":
        raise ReplayError(f"render: expected a file that ends in .png, got {path}")
    if not isinstance(replay, EpisodeReplay):
        raise ReplayError("render: expected the replay of an environment, got one of a simulator")
    points, yaw, goal, ground = [], 0.0, np.zeros(3), None
    for seat, _ in replay.decisions():
        state = seat.state()[0]
        points.append([*state["position"][:2], np.linalg.norm(state["velocity"].astype(np.float64))])
        yaw, goal, ground = float(state["yaw"]), seat.goal(), ground or seat.terrain()
    assert ground is not None
    image = CommandMap(ground, SIZE).draw(
        path=np.array(points), yaw=yaw, beacon=goal[:2], arrival_radius=replay.options["arrival_radius"]
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(path)
