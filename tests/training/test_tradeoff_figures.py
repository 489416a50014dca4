"""What the trade-off makes of its measurements, against numpy, SciPy and brute force."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import stats

from discjump.accuracy.measure import Path
from discjump.terrains import SURFACES
from discjump_training.errors import TrainingError
from discjump_training.tradeoff import apex, paths, skiers
from discjump_training.tradeoff.grid import TICK_MS, TRUTH, Config, Plan
from discjump_training.tradeoff.pareto import undominated

SMALL = Plan(starts=4, seconds=5.0)


def better(a, b):
    """Whether one dominates another: (speed, error)."""
    return a[0] >= b[0] and a[1] <= b[1] and a != b


@given(arrays.arrays(np.int64, st.tuples(st.integers(0, 12), st.just(2)), elements=st.integers(0, 6)))
def test_undominated_is_what_nothing_beats(pairs):
    listed = [tuple(pair) for pair in pairs.tolist()]
    wanted = [not any(better(other, one) for other in listed) for one in listed]
    assert undominated(pairs[:, 0], pairs[:, 1]).tolist() == wanted


times = st.lists(st.one_of(st.integers(1, 12), st.none()), min_size=1, max_size=30)


@settings(deadline=None)
@given(times)
def test_median_time_is_that_of_kaplan_and_meier(happened):
    """Nobody is watched for longer than 20: what has not happened by then is censored."""
    passed = np.array([np.inf if time is None else float(time) for time in happened])
    made = paths.until(passed, 20.0)
    survival = stats.ecdf(stats.CensoredData.right_censored(np.minimum(passed, 20.0), np.isinf(passed))).sf
    half = survival.quantiles[survival.probabilities <= 0.5 + 1e-12]
    assert made["median"] == (half[0] if half.size and np.isfinite(passed).mean() >= 0.5 else None)
    assert made["share"] == sum(time is not None for time in happened) / len(happened)
    assert made["restricted_mean"] == pytest.approx(sum(time or 20.0 for time in happened) / len(happened))


def test_first_passage_is_the_first_sample_beyond_the_limit():
    rng = np.random.default_rng(0)
    errors = rng.lognormal(-2.0, 1.5, (40, 50))
    passed = paths.first_passage(errors, 1.0)
    for start, time in enumerate(passed):
        over = [k for k, error in enumerate(errors[:, start]) if error > 1.0]
        assert time == pytest.approx(over[0] * 0.064 if over else np.inf)
    assert np.isinf(passed).any()
    assert np.isfinite(passed).any()


def test_figures_are_numpys():
    rng = np.random.default_rng(1)
    one, other = (Path(rng.normal(0, 1, (79, 21, 3)), rng.normal(20, 1, (79, 21))) for _ in range(2))
    made = paths.figures(one, other)
    apart = np.sqrt(((one.position - other.position) ** 2).sum(axis=-1))
    assert [at["seconds"] for at in made["at"]] == [1.0, 5.0]
    for at, sample in zip(made["at"], (16, 78), strict=True):
        ordered = np.sort(apart[sample])
        assert at["position"]["median"] == pytest.approx(ordered[10], rel=1e-12)
        assert at["position"]["p95"] == pytest.approx(ordered[19], rel=1e-12)
        assert at["speed"]["largest"] == np.abs(one.speed - other.speed)[sample].max()
        assert at["over"]["1"] == sum(ordered > 1.0) / 21


@pytest.mark.parametrize("situation", ["ski", "blast", "bridge"])
def test_the_reference_has_no_error_to_itself(situation):
    made = paths.Paths(SMALL)
    for tick_ms, surface in itertools.product(TICK_MS, SURFACES):
        config = Config(TRUTH.tier, tick_ms, surface)
        rows = {row["error"]: row for row in paths.compared(made, situation, config)}
        for at in rows["own"]["at"]:
            assert set(at["position"].values()) == {0.0}
        assert {of["share"] for of in rows["own"]["until"].values()} == {0.0}
        # Another tick or surface is another game.
        assert (rows["truth"]["at"][-1]["position"]["largest"] > 0.01) == (config != TRUTH)


def test_movement_and_digits_share_out_the_error():
    made = paths.Paths(SMALL)
    rows = {
        (tier, row["error"]): row["at"][-1]["position"]
        for tier in ("authentic", "fast", "engine")
        for row in paths.compared(made, "crease", Config(tier))
    }
    # The movement of `authentic` is that of the reference; `fast` moves otherwise where two contacts meet.
    assert set(rows["authentic", "movement"].values()) == {0.0}
    assert rows["authentic", "digits"] == rows["authentic", "own"] == rows["authentic", "truth"]
    assert 0.0 < rows["authentic", "digits"]["median"] < 0.01 < rows["fast", "movement"]["largest"]
    assert rows["engine", "movement"]["median"] > 100.0 * rows["engine", "digits"]["median"] > 0.0


def test_paths_are_sampled_at_the_same_times():
    """All begin at one place; in the air they agree on the time they have been falling."""
    made = paths.Paths(SMALL)
    falls = [made.of("landing", Config(TRUTH.tier, tick_ms)).position for tick_ms in TICK_MS]
    for fall in falls:
        assert fall.shape == (79, 4, 3)
        np.testing.assert_array_equal(fall[0], falls[0][0])
    # Before anyone is down (3 m at 25 m/s and more), semi-implicit Euler lags by g t dt / 2.
    for tick_ms, fall in zip(TICK_MS, falls, strict=True):
        drop = fall[0, :, 2] - fall[1, :, 2]
        exact = drop - 0.5 * 20.0 * 0.064 * tick_ms / 1000
        np.testing.assert_allclose(exact, falls[0][0, :, 2] - falls[0][1, :, 2] - 0.00512, atol=1e-9)


def test_nobody_starts_in_the_other_surface():
    made = paths.Paths(replace(SMALL, starts=64))
    truth = made.of("steep", TRUTH).position[0]
    bilinear = made.of("steep", replace(TRUTH, surface="bilinear")).position[0]
    lifted = bilinear[:, 2] - truth[:, 2]
    assert 0.0 == lifted.min() < lifted.max() < 10.0
    np.testing.assert_array_equal(bilinear[:, :2], truth[:, :2])


@pytest.mark.parametrize("tick_ms", TICK_MS)
def test_a_jump_reaches_what_theory_says(tick_ms):
    """Semi-implicit Euler: v^2 / 2g - v dt / 2, to the tick; the trapezoid of `engine`: v^2 / 2g."""
    v, g, dt = 75.0 / 9.0, 20.0, tick_ms / 1000
    for tier in ("reference", "authentic", "swept", "fast"):
        ticks = np.arange(1, 200)
        exact = (v * dt * ticks - g * dt**2 * ticks * (ticks + 1) / 2).max()
        assert apex.apexes(tier, tick_ms, [])[0] == pytest.approx(exact, abs=1e-4)
        assert exact == pytest.approx(v**2 / (2 * g) - v * dt / 2, abs=g * dt**2 / 4)
    assert apex.apexes("engine", tick_ms, [])[0] == pytest.approx(v**2 / (2 * g), abs=g * dt**2 / 4)


def test_apexes_are_those_of_the_specification():
    """core/docs/physics.md, section 10: 1 to 8 ticks after the jump; before its very tick 15.2 m."""
    wanted = [15.2, 19.2, 23.2, 27.1, 30.0, 24.8, 21.2, 18.6, 16.6]
    for tier in ("reference", "authentic", "swept", "fast"):
        assert apex.row(tier, 32)["apex"] == pytest.approx(wanted, abs=0.051)
    assert [height is None for height in apex.row("fast", 64)["apex"]] == [False, True] * 4 + [False]


def episodes(**changes):
    made = {
        "seconds": [10.0, 12.0, 14.0],
        "top_speed": [30.0, 31.0, 35.0],
        "damage": [0.0, 0.1, 0.0],
        "success": [True, True, False],
        "death": [False, False, True],
        "terrain": [0, 1, 2],
        "start_distance": [300.0, 400.0, 500.0],
        "goals": [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]],
    }
    return made | changes


def test_differences_are_pair_by_pair():
    row = skiers.compared(episodes(seconds=[11.0, 12.0, 18.0]), episodes())
    assert row["seconds"]["mean"] == pytest.approx(41.0 / 3.0)
    assert row["seconds"]["difference"]["value"] == pytest.approx(5.0 / 3.0)
    assert row["seconds"]["typical"] == 1.0
    assert row["damage"]["difference"] == {"value": 0.0, "low": 0.0, "high": 0.0}
    assert (row["deaths"], row["success"]["value"]) == (1, pytest.approx(2.0 / 3.0))


@pytest.mark.parametrize(
    "other",
    [{"terrain": [0, 1, 1]}, {"start_distance": [300.0, 400.1, 500.0]}, {"goals": [[0, 1], [2, 3], [4, 9]]}],
)
def test_other_episodes_are_not_compared(other):
    with pytest.raises(TrainingError, match=f"their {next(iter(other))} differs"):
        skiers.compared(episodes(**other), episodes())


def test_decisions_keep_their_time():
    for tick_ms in TICK_MS:
        assert 128 in {tick_ms * skip for skip in Plan().decisions(tick_ms)}
        assert {tick_ms * skip for skip in Plan().decisions(tick_ms)} <= {32, 64, 128, 256}
