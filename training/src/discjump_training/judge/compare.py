"""Two policies on the same episodes."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from discjump_training.errors import TrainingError
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.judged import SHARED, Judged
from discjump_training.judge.statistics import Test


@dataclass(frozen=True)
class Comparison:
    """How `policy` does beside `against` in the same episodes.

    Attributes:
        policy, against: their names.
        episodes: number of episodes.
        difference: mean seconds of policy - against; negative is faster.
        ratio: mean seconds of policy / against; below 1 is faster.
        success: difference of the shares of success; positive is better.
        improvement: probability that the policy does better in an episode than the other, half where equal.
        tests: of no difference.
        faster_share: share of the episodes in which the policy is faster.
        faster_terrains: number of terrains on which its mean time is lower.
        terrains: number of terrains.
        by_terrain: mean seconds of policy - against by index of the terrain.
    """

    policy: str
    against: str
    episodes: int
    difference: Estimate
    ratio: Estimate
    success: Estimate
    improvement: Estimate
    tests: tuple[Test, ...]
    faster_share: float
    faster_terrains: int
    terrains: int
    by_terrain: dict[int, float]


def pairs(judged: list[Judged]) -> list[tuple[Judged, Judged]]:
    """Every model against every baseline and the models after it; without models, every baseline against the
    ones after it.
    """
    models = [one for one in judged if one.is_model]
    if not models:
        return [(a, b) for i, a in enumerate(judged) for b in judged[i + 1 :]]
    found = [(a, b) for a in models for b in judged if not b.is_model]
    return found + [(a, b) for i, a in enumerate(models) for b in models[i + 1 :]]


def compare(a: Judged, b: Judged, score: Literal["seconds", "share"] = "seconds") -> Comparison:
    """Pair by pair; where one played fewer episodes, only those that both played.

    Args:
        a: the policy.
        b: what it is held against.
        score: what counts as better in an episode: less time, or success.

    Raises:
        TrainingError: they did not play the same episodes: `SHARED` must be equal bit for bit.
    """
    count = min(len(a.episodes), len(b.episodes))
    a, b = a.first(count), b.first(count)
    for key in SHARED:
        if getattr(a.episodes, key).tobytes() != getattr(b.episodes, key).tobytes():
            raise TrainingError(
                f"{a.name} and {b.name} cannot be compared: expected the same episodes, "
                f"but their {key} differs"
            )
    x, y, terrain = a.table("seconds"), b.table("seconds"), a.terrain
    won, lost = a.success.astype(np.float64), b.success.astype(np.float64)
    by_terrain = {
        int(index): float((x.mean(axis=0) - y.mean(axis=0))[terrain == index].mean())
        for index in np.unique(terrain)
    }
    tests = [statistics.signed_rank(x, y)]
    if len(won) == len(lost) == 1:
        tests.append(statistics.mcnemar(a.success[0], b.success[0]))
    # A success is better, so a share's sides are turned round: `improvement` asks for less.
    better = (x, y) if score == "seconds" else (-won, -lost)
    return Comparison(
        policy=a.name,
        against=b.name,
        episodes=count,
        difference=statistics.estimate(statistics.difference, [x, y], terrain),
        ratio=statistics.estimate(statistics.ratio, [x, y], terrain),
        success=statistics.estimate(statistics.difference, [won, lost], terrain),
        improvement=statistics.estimate(statistics.improvement, better, terrain),
        tests=tuple(tests),
        faster_share=float((x[:, np.newaxis] < y[np.newaxis]).mean()),
        faster_terrains=sum(apart < 0 for apart in by_terrain.values()),
        terrains=len(by_terrain),
        by_terrain=by_terrain,
    )
