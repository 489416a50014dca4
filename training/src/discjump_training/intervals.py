"""Bootstrap intervals of means, differences and ratios, over episodes or over training seeds and episodes,
and an exact one of proportions.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from discjump_training.policy import Floats

CONFIDENCE = 0.95
RESAMPLES = 9_999


@dataclass(frozen=True)
class Estimate:
    """A statistic with the ends of its 95% interval."""

    value: float
    low: float
    high: float

    def as_dict(self) -> dict[str, float]:
        """For JSON."""
        return asdict(self)


def mean(sample: NDArray[Any]) -> Estimate:
    """Mean of `sample` (n,) with its BCa bootstrap interval."""
    return _bootstrap((np.asarray(sample, dtype=np.float64),), np.mean)


def mean_difference(a: NDArray[Any], b: NDArray[Any]) -> Estimate:
    """Mean of `a - b`, both (n,), entry `i` of both from the same episode: pairs are resampled together."""
    return mean(np.asarray(a, dtype=np.float64) - np.asarray(b, dtype=np.float64))


def mean_ratio(a: NDArray[Any], b: NDArray[Any]) -> Estimate:
    """Ratio of the means of `a` and `b`, both (n,), pairs resampled together."""

    def ratio(x: Floats, y: Floats, axis: int = -1) -> Any:
        return np.mean(x, axis=axis) / np.mean(y, axis=axis)

    return _bootstrap((np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)), ratio)


def over_seeds(table: NDArray[Any]) -> Estimate:
    """Mean of `table` (training seeds, episodes), where both were drawn: seeds and episodes are resampled
    independently of each other and crossed (percentile interval; Owen, The pigeonhole bootstrap, 2007: never
    too narrow by more than sampling noise, wide where there are few seeds).
    """
    return _crossed(np.asarray(table, dtype=np.float64), None)


def over_seeds_difference(a: NDArray[Any], b: NDArray[Any]) -> Estimate:
    """Difference of the means of `a` and `b`, (seeds of a, episodes) and (seeds of b, episodes): each one's
    seeds are resampled on their own, the episodes of both together, since they played the same.
    """
    return _crossed(np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64))


def _crossed(a: Floats, b: Floats | None) -> Estimate:
    rng = np.random.default_rng(0)
    episodes = a.shape[1]
    value = a.mean() - (0.0 if b is None else b.mean())
    # How often each row and column is drawn is all that a mean asks of a resample.
    columns = rng.multinomial(episodes, np.full(episodes, 1 / episodes), RESAMPLES) / episodes

    def means(table: Floats) -> Floats:
        count = len(table)
        rows = rng.multinomial(count, np.full(count, 1 / count), RESAMPLES) / count
        resampled: Floats = np.einsum("ns,se,ne->n", rows, table, columns, optimize=True)
        return resampled

    resampled = means(a) - (0.0 if b is None else means(b))
    tail = (1.0 - CONFIDENCE) / 2.0
    low, high = np.quantile(resampled, [tail, 1.0 - tail])
    return Estimate(float(value), float(low), float(high))


def proportion(successes: NDArray[np.bool_]) -> Estimate:
    """Share of true values with the exact (Clopper-Pearson) interval.

    A bootstrap of 512 successes out of 512 has no width at all and would claim certainty; this one does not.
    """
    count = int(np.count_nonzero(successes))
    interval = stats.binomtest(count, successes.size).proportion_ci(CONFIDENCE, method="exact")
    return Estimate(count / successes.size, float(interval.low), float(interval.high))


def _bootstrap(data: tuple[Floats, ...], statistic: Callable[..., Any]) -> Estimate:
    value = float(statistic(*data, axis=-1))
    # BCa is undefined when leaving out an episode changes nothing; the interval is then the value itself.
    if data[0].size < 2 or all(np.ptp(sample) <= 1e-12 * np.abs(sample).max() for sample in data):
        return Estimate(value, value, value)
    result = stats.bootstrap(
        data,
        statistic,
        paired=True,
        vectorized=True,
        n_resamples=RESAMPLES,
        batch=500,
        confidence_level=CONFIDENCE,
        method="BCa",
        rng=np.random.default_rng(0),
    )
    interval = result.confidence_interval
    return Estimate(value, float(interval.low), float(interval.high))
