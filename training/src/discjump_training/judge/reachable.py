"""Scores among the goals that an exhaustive search can reach on the same course."""

import numpy as np

from discjump_training.bounds import reachable
from discjump_training.bounds.reachable import Reachable
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.judged import Judged


def known(conditions: Conditions) -> Reachable | None:
    """What the search reached on the course under these conditions; None where nobody searched."""
    if conditions.task.name != "disc-jump" or conditions.terrain is not None:
        return None
    found = reachable.load(conditions.course)
    if found is None or not found.fits(conditions.course, conditions.changes):
        return None
    return found if found.reached[: conditions.episodes].any() else None


def share(one: Judged, search: Reachable) -> tuple[Estimate, int] | None:
    """Share of the goals that the search reaches which the policy reaches too, and how many those are among
    the episodes that it played; None where there are none.
    """
    rows = np.flatnonzero(search.reached[: len(one.episodes)])
    if not len(rows):
        return None
    return statistics.share(one.success[:, rows], one.terrain[rows]), len(rows)
