"""Statistics against SciPy's closed forms and against rliable's figures."""

import numpy as np
import pytest
from scipy import stats

from discjump_training import intervals
from discjump_training.judge import statistics

#: By rliable 1.2.0 with 50,000 resamples: get_interval_estimates of aggregate_mean and aggregate_iqm of the
#: scores below, 24 runs of 6 tasks, which is its word for what terrains are here; probability_of_improvement.
RLIABLE = {
    "mean": (25.67961384, 24.32140838, 27.08332749),
    "iqm": (25.05184375, 23.62280774, 26.56280018),
}
IMPROVEMENT = 0.5729166666666666


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def test_means_interquartile_means_and_their_stratified_intervals_are_rliables(rng):
    scores = rng.gamma(4.0, 5.0, size=(24, 6)) + np.arange(6) * 3.0
    a = np.round(rng.gamma(4.0, 5.0, size=(5, 12)))
    b = np.round(a[:4] * 1.1 + rng.normal(0, 3, (4, 12)))
    strata = np.tile(np.arange(6), 24)
    for name, statistic in (("mean", statistics.mean), ("iqm", statistics.interquartile_mean)):
        value, low, high = RLIABLE[name]
        found = statistics.estimate(statistic, [scores.reshape(1, -1)], strata)
        assert found.value == pytest.approx(value, rel=1e-8)
        # 4,999 resamples leave an error of about 3% of the width in each end.
        assert found.low == pytest.approx(low, abs=0.04 * (high - low))
        assert found.high == pytest.approx(high, abs=0.04 * (high - low))
    assert statistics.improvement(a, b) == pytest.approx(IMPROVEMENT, rel=1e-12)
    assert statistics.improvement(b, a) == pytest.approx(1 - IMPROVEMENT, rel=1e-12)


def test_improvement_is_the_mann_whitney_statistic_of_each_episode(rng):
    a, b = rng.integers(0, 5, (6, 9)), rng.integers(1, 6, (4, 9))
    expected = [stats.mannwhitneyu(b[:, i], a[:, i]).statistic / (6 * 4) for i in range(9)]
    assert statistics.improvement(a, b) == pytest.approx(np.mean(expected))


def test_strata_take_what_lies_between_terrains_out_of_the_interval(rng):
    terrain = np.repeat(np.arange(16), 32)
    scores = 10.0 * terrain + rng.normal(0.0, 2.0, terrain.size)
    within = np.mean([scores[terrain == t].var(ddof=1) for t in range(16)])
    sem = np.sqrt(within / scores.size)
    found = statistics.estimate(statistics.mean, [scores], terrain)
    low, high = stats.norm.interval(0.95, loc=scores.mean(), scale=sem)
    assert found.high - found.low == pytest.approx(high - low, rel=0.06)
    unstratified = statistics.estimate(statistics.mean, [scores], np.zeros(scores.size))
    assert unstratified.high - unstratified.low > 10 * (found.high - found.low)


def test_several_runs_are_resampled_as_the_crossed_bootstrap_does(rng):
    table = 20.0 + rng.normal(0, 1.0, (5, 1)) + rng.normal(0, 3.0, 80) + rng.normal(0, 1.0, (5, 80))
    found = statistics.estimate(statistics.mean, [table], np.zeros(80))
    other = intervals.over_seeds(table)
    assert found.value == pytest.approx(other.value)
    assert found.low == pytest.approx(other.low, abs=0.05 * (other.high - other.low))
    assert found.high == pytest.approx(other.high, abs=0.05 * (other.high - other.low))


def test_pairing_removes_what_the_episodes_have_in_common(rng):
    terrain = np.repeat(np.arange(8), 50)
    difficulty = rng.normal(30.0, 8.0, terrain.size)
    a = difficulty - 1.0 + rng.normal(0, 0.5, terrain.size)
    b = difficulty + rng.normal(0, 0.5, terrain.size)
    found = statistics.estimate(statistics.difference, [a, b], terrain)
    low, high = stats.norm.interval(0.95, loc=(a - b).mean(), scale=stats.sem(a - b))
    assert found.high - found.low == pytest.approx(high - low, rel=0.08)
    ratio = statistics.estimate(statistics.ratio, [a, b], terrain)
    assert ratio.value == pytest.approx(a.mean() / b.mean())
    assert ratio.low < ratio.value < ratio.high < 1.0
    # A shift of both shifts nothing, and who is compared with himself does not differ.
    shifted = statistics.estimate(statistics.difference, [a + 5, b + 5], terrain)
    assert shifted.low == pytest.approx(found.low)
    itself = statistics.estimate(statistics.difference, [a, a], terrain)
    assert (itself.value, itself.low, itself.high) == (0.0, 0.0, 0.0)
    turned = statistics.estimate(statistics.difference, [b, a], terrain)
    assert (turned.low, turned.high) == pytest.approx((-found.high, -found.low))


def test_few_episodes():
    one = statistics.estimate(statistics.mean, [np.array([3.0])], np.array([0]))
    assert (one.value, one.low, one.high) == (3.0, 3.0, 3.0)
    lone = statistics.estimate(statistics.mean, [np.array([1.0, 2.0, 3.0])], np.array([0, 1, 2]))
    assert lone.low < 2.0 < lone.high
    rest = statistics.estimate(statistics.mean, [np.array([1.0, 2.0, 3.0])], np.array([0, 0, 1]))
    assert rest.low < 2.0 < rest.high


def test_a_share_is_exact_and_of_runs_never_narrower():
    success = np.ones((1, 512), np.bool_)
    terrain = np.repeat(np.arange(16), 32)
    exact = statistics.share(success, terrain)
    assert (exact.low, exact.high) == pytest.approx((0.025 ** (1 / 512), 1.0))
    runs = np.zeros((4, 512), np.bool_)
    runs[:2] = True
    pooled = stats.binomtest(1024, 2048).proportion_ci(0.95, method="exact")
    found = statistics.share(runs, terrain)
    assert found.value == 0.5
    assert (found.low, found.high) == (0.0, 1.0)
    assert found.low < pooled.low < pooled.high < found.high


def test_paired_tests_are_scipys(rng):
    x = rng.normal(20, 3, 60)
    y = x + rng.normal(0.5, 1, 60)
    assert statistics.signed_rank(x, y).p == stats.wilcoxon(x - y, zero_method="pratt").pvalue
    assert statistics.signed_rank(x, y).p == statistics.signed_rank(y, x).p
    assert statistics.signed_rank(x, x).p == 1.0
    a, b = rng.random(200) < 0.7, rng.random(200) < 0.5
    only_a, only_b = int((a & ~b).sum()), int((b & ~a).sum())
    both = 2 * stats.binom.cdf(min(only_a, only_b), only_a + only_b, 0.5)
    assert statistics.mcnemar(a, b).p == pytest.approx(min(1.0, both))
    assert statistics.mcnemar(a, a).p == 1.0
