"""Scores beside a planner's on the same episodes."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from discjump_training.errors import TrainingError
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.judged import Judged
from discjump_training.policy import Floats


@dataclass(frozen=True)
class Planner:
    """What a planner did in some episodes of a course.

    Attributes:
        rows: episodes, (k,).
        seconds: to the goal, failures count as the time limit, (k,).
        success: (k,), as 0 or 1.
    """

    rows: NDArray[np.int64]
    seconds: Floats
    success: Floats


def load(path: Path, conditions: Conditions) -> Planner:
    """The results of `discjump plan`.

    Args:
        path: its JSON, or the folder with it.
        conditions: of the evaluation that it is set beside.

    Raises:
        TrainingError: it cannot be read, or is about another course.
    """
    file = path / "plan.json" if path.is_dir() else path
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        course, episodes = data["course"], data["episodes"]
        rows = np.array([one["episode"] for one in episodes], np.int64)
        seconds = np.array([one["seconds"] for one in episodes], np.float64)
        success = np.array([one["success"] for one in episodes], np.float64)
    except OSError as error:
        raise TrainingError(f"--planner: cannot read {file}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError) as error:
        raise TrainingError(
            f"--planner: {file} is no result of discjump plan: {type(error).__name__}: {error}"
        ) from None
    if course != conditions.course.name:
        raise TrainingError(f"--planner: {file} is about the course {course}, not {conditions.course.name}")
    if not len(rows) or len(np.unique(rows)) < len(rows) or not (np.isfinite(seconds) & (seconds > 0)).all():
        raise TrainingError(f"--planner: {file} has no episodes, one twice, or times that are none")
    order = np.argsort(rows)
    return Planner(rows[order], seconds[order], success[order])


def percent(one: Judged, planner: Planner, score: str) -> tuple[Estimate, int] | None:
    """A policy's score as percent of the planner's on the episodes that both played, and how many those are:
    of the planner's mean time over the policy's, or of the shares of success; more is better. None where
    there is no such episode, or the planner never succeeds.
    """
    both = planner.rows < len(one.episodes)
    rows = planner.rows[both]
    if not len(rows):
        return None
    if score == "seconds":
        tables = [planner.seconds[both][np.newaxis], one.table("seconds")[:, rows]]
    else:
        tables = [one.success[:, rows].astype(np.float64), planner.success[both][np.newaxis]]
        if not tables[1].any():
            return None
    found = statistics.estimate(_percent, tables, one.terrain[rows])
    return found, len(rows)


def _percent(above: Floats, below: Floats) -> NDArray[np.float64]:
    # A resample in which the planner never succeeds says nothing.
    with np.errstate(divide="ignore", invalid="ignore"):
        found: NDArray[np.float64] = np.nan_to_num(
            100.0 * statistics.ratio(above, below), nan=100.0, posinf=100.0
        )
    return found
