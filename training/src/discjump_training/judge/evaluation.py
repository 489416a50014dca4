"""An evaluation: what was played, and all that follows from it."""

from dataclasses import dataclass

import numpy as np

from discjump_training.bounds.reachable import Reachable
from discjump_training.courses import row
from discjump_training.intervals import Estimate
from discjump_training.judge import compare as comparing
from discjump_training.judge import planner as planning
from discjump_training.judge import reachable as reaching
from discjump_training.judge import statistics
from discjump_training.judge.compare import Comparison
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.failures import Failure, failures
from discjump_training.judge.judged import Figure, Judged, columns, figures
from discjump_training.judge.planner import Planner

#: Fewer episodes than this are too few to publish.
ENOUGH_EPISODES = 200


@dataclass(frozen=True)
class InBand:
    """How a policy does in episodes of one difficulty.

    Attributes:
        policy: its name.
        low, high: ends of the band.
        episodes: how many.
        success: share.
        seconds: mean, failures count as the time limit.
    """

    policy: str
    low: float
    high: float
    episodes: int
    success: Estimate
    seconds: Estimate


@dataclass(frozen=True)
class Evaluation:
    """What was played, and all that follows from it.

    Attributes:
        conditions: of all.
        judged: policies.
        partial: something was not played.
        figures: of each policy, in their order.
        failures: of each policy, in their order.
        comparisons: pair by pair.
        bands: by difficulty, where the task has one.
        percent: of the planner's score, of each policy; empty without a planner.
        search: what an exhaustive search reaches on the course; None where nobody searched.
        reachable: share of what it reaches, and of how many, of each policy; empty where nobody searched.
    """

    conditions: Conditions
    judged: list[Judged]
    partial: bool
    figures: list[dict[str, Estimate]]
    failures: list[list[Failure]]
    comparisons: list[Comparison]
    bands: list[InBand]
    percent: list[tuple[Estimate, int] | None]
    search: Reachable | None
    reachable: list[tuple[Estimate, int] | None]

    @property
    def columns(self) -> tuple[Figure, ...]:
        """Of the table of policies."""
        return columns(self.conditions.task.goal)


def evaluation(
    conditions: Conditions, judged: list[Judged], planner: Planner | None = None, *, partial: bool = False
) -> Evaluation:
    """All that follows from what was played.

    Raises:
        TrainingError: two policies did not play the same episodes.
    """
    score = conditions.task.score
    search = reaching.known(conditions)
    return Evaluation(
        conditions,
        judged,
        partial,
        figures=[figures(one) for one in judged],
        failures=[failures(one, conditions) for one in judged],
        comparisons=[comparing.compare(a, b, score) for a, b in comparing.pairs(judged)],
        bands=[band for one in judged for band in bands(one, conditions.task.name)],
        percent=[] if planner is None else [planning.percent(one, planner, score) for one in judged],
        search=search,
        reachable=[] if search is None else [reaching.share(one, search) for one in judged],
    )


def bands(one: Judged, task: str) -> list[InBand]:
    """A policy's results by difficulty; none where the task's infos do not have it."""
    band = row(task).band
    first = one.episodes
    if band is None or not (hasattr(first, band.key) or band.key in first.extra):
        return []
    value = getattr(first, band.key) if hasattr(first, band.key) else first.extra[band.key]
    which = band.which(value)
    found = []
    for index, (low, high) in enumerate(zip(band.edges[:-1], band.edges[1:], strict=True)):
        own = which == index
        if own.any():
            strata = np.zeros(int(own.sum()))
            found.append(
                InBand(
                    one.name,
                    low,
                    high,
                    int(own.sum()),
                    statistics.share(one.success[:, own], strata),
                    statistics.estimate(statistics.mean, [one.table("seconds")[:, own]], strata),
                )
            )
    return found
