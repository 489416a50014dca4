import numpy as np
import pytest
from scipy import stats

from discjump_training import intervals


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def test_interval_of_a_mean_agrees_with_the_normal_one(rng):
    sample = rng.normal(20.0, 5.0, size=2_000)
    low, high = stats.norm.interval(0.95, loc=sample.mean(), scale=stats.sem(sample))
    found = intervals.mean(sample)
    assert found.value == pytest.approx(sample.mean(), abs=1e-12)
    # 9,999 resamples leave an error of about 2 % of the width in each end.
    assert found.low == pytest.approx(low, abs=0.05 * (high - low))
    assert found.high == pytest.approx(high, abs=0.05 * (high - low))


def test_coverage_is_near_95_percent(rng):
    covered = 0
    for _ in range(100):
        sample = rng.exponential(2.0, size=100)
        found = intervals.mean(sample)
        covered += found.low <= 2.0 <= found.high
    # 3.5 standard deviations of a binomial count around 95.
    assert covered >= 87


def test_pairing_removes_what_the_episodes_have_in_common(rng):
    difficulty = rng.normal(30.0, 8.0, size=500)
    a, b = difficulty - 1.0 + rng.normal(0, 0.5, 500), difficulty + rng.normal(0, 0.5, 500)
    difference = intervals.mean_difference(a, b)
    low, high = stats.norm.interval(0.95, loc=(a - b).mean(), scale=stats.sem(a - b))
    assert difference.high - difference.low == pytest.approx(high - low, rel=0.05)
    assert difference.high < 0
    ratio = intervals.mean_ratio(a, b)
    assert ratio.value == pytest.approx(a.mean() / b.mean())
    assert ratio.low < ratio.value < ratio.high < 1


def test_degenerate_samples():
    assert intervals.mean(np.full(10, 60.0)) == intervals.Estimate(60.0, 60.0, 60.0)
    assert intervals.mean(np.array([3.0])) == intervals.Estimate(3.0, 3.0, 3.0)


def test_a_full_success_rate_is_not_certainty():
    found = intervals.proportion(np.ones(512, np.bool_))
    # Clopper-Pearson for n of n: the lower end is (alpha / 2) ** (1 / n).
    assert (found.value, found.high) == (1.0, 1.0)
    assert found.low == pytest.approx(0.025 ** (1 / 512))


def test_over_seeds_without_differences_between_seeds_is_the_interval_over_episodes(rng):
    sample = rng.normal(20.0, 5.0, size=500)
    low, high = stats.norm.interval(0.95, loc=sample.mean(), scale=stats.sem(sample))
    found = intervals.over_seeds(np.tile(sample, (5, 1)))
    assert found.value == pytest.approx(sample.mean())
    assert found.high - found.low == pytest.approx(high - low, rel=0.05)


def test_over_seeds_counts_the_seeds_and_not_the_episodes_where_seeds_differ(rng):
    """However many episodes are played, five seeds are five."""
    found = intervals.over_seeds(np.tile([[17.0], [18.0], [19.0], [20.0], [21.0]], (1, 5_000)))
    scores = np.array([17.0, 18.0, 19.0, 20.0, 21.0])
    scipys = stats.bootstrap((scores,), np.mean, method="percentile", rng=rng).confidence_interval
    assert found.low == pytest.approx(scipys.low, abs=0.11)
    assert found.high == pytest.approx(scipys.high, abs=0.11)


def test_over_seeds_covers_a_difference(rng):
    covered = 0
    for _ in range(200):
        episodes = rng.normal(20.0, 3.0, 60)

        def played(mean, episodes=episodes):
            return mean + episodes + rng.normal(0, 0.5, (12, 1)) + rng.normal(0, 1.0, (12, 60))

        found = intervals.over_seeds_difference(played(1.0), played(0.0))
        covered += found.low <= 1.0 <= found.high
    # 95% nominally; resampling 12 seeds takes about 2% of it. 3.5 standard deviations below 93%.
    assert covered >= 173
