"""Columns of `info`: what every step says, and what the end of an episode adds.

| key | unit | meaning |
|---|---|---|
| distance | m | horizontal distance to the beacon |
| speed | m/s | speed |
| time | s | since the episode's start |
| outside_mission_area | | whether the player is outside the mission area |

and when an episode ends

| key | unit | meaning |
|---|---|---|
| is_success, death, timeout | | how it ended: exactly one of them is true |
| return | | sum of rewards |
| length | decisions | |
| top_speed, mean_speed | m/s | |
| path | m | length of the path |
| damage | damage | at the end; light armor dies at 0.66, medium at 1.0, heavy at 1.32 |
| start_distance | m | horizontal distance to the beacon at the start |
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

STEP = {"distance": "distance", "speed": "speed", "time": "time", "outside_mission_area": "outside"}
"""Key of info -> field of status and of outcomes."""

END = {
    "is_success": "success",
    "death": "death",
    "timeout": "timeout",
    "return": "total_reward",
    "length": "length",
    "top_speed": "top_speed",
    "mean_speed": "mean_speed",
    "path": "path",
    "damage": "damage",
    "start_distance": "start_distance",
}
"""Key of info -> field of outcomes."""

Columns = dict[str, NDArray[Any]]


def now(status: NDArray[np.void]) -> Columns:
    """Columns of every step, (num_envs,) float64 or bool, copies."""
    return {key: _wide(status[field]) for key, field in STEP.items()}


def at_end(outcomes: NDArray[np.void]) -> Columns:
    """All columns of the k episodes that ended, (k,) float64, int64 or bool, copies."""
    return {key: _wide(outcomes[field]) for key, field in (STEP | END).items()}


def spread(columns: Columns, rows: NDArray[np.int64], num_envs: int) -> Columns:
    """(k,) columns placed at `rows` of (num_envs,) columns of zeros."""
    wide = {}
    for key, column in columns.items():
        wide[key] = np.zeros(num_envs, column.dtype)
        wide[key][rows] = column
    return wide


def masked(columns: Columns, mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Columns with gymnasium's `_key` masks; rows outside `mask` are zero."""
    info: dict[str, Any] = {}
    partial = not mask.all()
    for key, column in columns.items():
        info[key] = np.where(mask, column, np.zeros((), column.dtype)) if partial else column
        info[f"_{key}"] = mask.copy()
    return info


def row(columns: Columns, index: int = 0) -> dict[str, Any]:
    """One row as Python numbers.

    >>> row({"speed": np.array([1.5, 2.5])}, 1)
    {'speed': 2.5}
    """
    return {key: column[index].item() for key, column in columns.items()}


def _wide(column: NDArray[Any]) -> NDArray[Any]:
    # Whatever the field's width, users get Python's own numbers.
    return column.astype({"f": np.float64, "i": np.int64, "b": np.bool_}[column.dtype.kind])
