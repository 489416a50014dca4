"""Statistics of scores, all by SciPy: interquartile means, bootstrap intervals, paired tests.

Scores are tables (runs, episodes): runs are training seeds of one algorithm, of which there may be one; every
run plays the same episodes. Resampling follows how the scores came about: episodes are drawn anew within each
terrain (stratified, as in Agarwal et al., Deep reinforcement learning at the edge of the statistical
precipice, 2021), and, where there are several runs, runs are drawn anew, too, and crossed with the episodes.
Intervals are percentile intervals of 95%.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from discjump_training import intervals
from discjump_training.intervals import CONFIDENCE, Estimate
from discjump_training.policy import Floats

RESAMPLES = 4_999
#: Scores that are picked at once: what a batch of resamples takes in memory.
PICKED = 1_000_000

Statistic = Callable[..., Any]
"""From tables (..., runs, episodes), one per policy, to numbers (...)."""


def mean(table: Floats) -> Any:
    """Over runs and episodes."""
    return table.mean(axis=(-2, -1))


def interquartile_mean(table: Floats) -> Any:
    """Mean of the middle half of all scores of all runs."""
    return stats.trim_mean(table.reshape(*table.shape[:-2], -1), 0.25, axis=-1)


def difference(a: Floats, b: Floats) -> Any:
    """Of the means."""
    return mean(a) - mean(b)


def ratio(a: Floats, b: Floats) -> Any:
    """Of the means."""
    return mean(a) / mean(b)


def improvement(a: Floats, b: Floats) -> Any:
    """Probability that a run of `a` scores less than a run of `b` in the same episode, half where equal; mean
    over episodes.
    """
    x, y = a[..., :, np.newaxis, :], b[..., np.newaxis, :, :]
    return ((x < y) + 0.5 * (x == y)).mean(axis=(-3, -2, -1))


def estimate(
    statistic: Statistic, tables: Sequence[NDArray[Any]], strata: NDArray[Any], resamples: int = RESAMPLES
) -> Estimate:
    """A statistic with its stratified bootstrap interval.

    Args:
        statistic: of as many tables as are given.
        tables: (runs, episodes) each; episodes are the same in all, so they are resampled together, and each
            one's runs on their own.
        strata: (episodes,), the terrain of each.
        resamples: how many.
    """
    given = [np.atleast_2d(np.asarray(table, np.float64)) for table in tables]
    value = float(statistic(*given))
    drawn = [np.arange(len(table)) for table in given if len(table) > 1]
    groups = _strata(strata)
    if not groups or all(np.ptp(table) == 0 for table in given):
        return Estimate(value, value, value)

    def of(*indices: NDArray[np.int64], axis: int = -1) -> Any:
        runs, picked = iter(indices[: len(drawn)]), np.concatenate(indices[len(drawn) :], axis=-1)
        columns = picked[..., np.newaxis, :]
        tables = [
            table[next(runs)[..., :, np.newaxis], columns] if len(table) > 1 else table[0][columns]
            for table in given
        ]
        return statistic(*tables)

    size = sum(table.size for table in given) * max(len(table) for table in given)
    interval = stats.bootstrap(
        (*drawn, *groups),
        of,
        vectorized=True,
        n_resamples=resamples,
        batch=max(1, PICKED // size),
        confidence_level=CONFIDENCE,
        method="percentile",
        rng=np.random.default_rng(0),
    ).confidence_interval
    return Estimate(value, float(interval.low), float(interval.high))


def _strata(labels: NDArray[Any]) -> list[NDArray[np.int64]]:
    """Indices of the episodes of each stratum; a lone episode cannot be resampled, so such strata are one."""
    groups = [np.flatnonzero(labels == label) for label in np.unique(labels)]
    kept = [group for group in groups if len(group) > 1]
    lone = [group for group in groups if len(group) == 1]
    if lone:
        rest = np.concatenate(lone)
        if len(rest) > 1 or not kept:
            kept.append(rest)
        else:
            kept[-1] = np.concatenate([kept[-1], rest])
    return [group for group in kept if len(group) > 1]


def share(table: NDArray[np.bool_], strata: NDArray[Any]) -> Estimate:
    """Share of true values: the exact (Clopper-Pearson) interval; with several runs the wider one of that
    over all of them and of the bootstrap over runs and episodes: what one run does, others may not.
    """
    exact = intervals.proportion(table.ravel())
    if len(table) == 1:
        return exact
    drawn = estimate(mean, [table], strata)
    return Estimate(exact.value, min(exact.low, drawn.low), max(exact.high, drawn.high))


@dataclass(frozen=True)
class Test:
    """A paired test of no difference, two-sided.

    Attributes:
        name: of the test.
        p: probability of a difference as large, if there is none.
    """

    #: Not one of pytest's.
    __test__ = False

    name: str
    p: float


def signed_rank(a: Floats, b: Floats) -> Test:
    """Wilcoxon's signed-rank test of scores (runs, episodes), each episode's mean over runs; episodes without
    a difference count as half for each side (Pratt).
    """
    apart = np.atleast_2d(a).mean(axis=0) - np.atleast_2d(b).mean(axis=0)
    if not apart.any():
        return Test("Wilcoxon signed-rank", 1.0)
    return Test("Wilcoxon signed-rank", float(stats.wilcoxon(apart, zero_method="pratt").pvalue))


def mcnemar(a: NDArray[np.bool_], b: NDArray[np.bool_]) -> Test:
    """McNemar's exact test of successes (episodes,): whether those that only one has are evenly split."""
    only_a, only_b = int((a & ~b).sum()), int((b & ~a).sum())
    if only_a + only_b == 0:
        return Test("McNemar", 1.0)
    return Test("McNemar", float(stats.binomtest(only_a, only_a + only_b).pvalue))
