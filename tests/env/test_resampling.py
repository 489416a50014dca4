"""A play in ticks of another length, or on another surface, is the same play."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from discjump import Terrain
from discjump.accuracy import grounds
from discjump.accuracy.plays import Play
from discjump.accuracy.scripts import TICK_MS, held, resampled
from discjump.simulator import INPUT

PLAYERS, TICKS = 3, 12
LEVELS = ("forward", "strafe", "jump", "jet", "pitch")


@st.composite
def scripts(draw):
    inputs = np.zeros((TICKS, PLAYERS), INPUT)
    shape = (TICKS, PLAYERS)
    for key in ("forward", "strafe"):
        inputs[key] = draw(arrays.arrays(np.int8, shape, elements=st.integers(-1, 1)))
    for key in ("jump", "jet", "fire"):
        inputs[key] = draw(arrays.arrays(np.bool_, shape))
    # Rates as the situations draw them, in 1/64 rad/s.
    inputs["turn"] = draw(arrays.arrays(np.int64, shape, elements=st.integers(-200, 200))) / 64.0
    inputs["pitch"] = draw(arrays.arrays(np.int64, shape, elements=st.integers(-90, 90))) / 64.0
    return inputs


def at(inputs, tick_ms, ms):
    """What is pressed at a time."""
    return inputs[ms // tick_ms]


def yaw(inputs, tick_ms, ms):
    """Turned until a time, rad: exact, since rates are multiples of 1/64 and few."""
    whole, rest = divmod(ms, tick_ms)
    turned = inputs["turn"][:whole].sum(axis=0) * tick_ms
    if rest:
        turned = turned + inputs["turn"][whole] * rest
    return turned / 1000.0


@settings(max_examples=50, deadline=None)
@given(scripts(), st.sampled_from([1, 2, 4, 8, 16, 32]))
def test_shorter_ticks_press_the_same_at_every_moment(inputs, tick_ms):
    shorter = resampled(inputs, tick_ms)
    assert len(shorter) * tick_ms == TICKS * TICK_MS
    for ms in range(TICKS * TICK_MS):
        assert (at(shorter, tick_ms, ms) == at(inputs, TICK_MS, ms)).all()


@settings(max_examples=50, deadline=None)
@given(scripts(), st.sampled_from([64, 96, 128]))
def test_longer_ticks_press_what_their_beginning_has(inputs, tick_ms):
    longer = resampled(inputs, tick_ms)
    for tick in range(len(longer)):
        for key in LEVELS:
            assert (longer[key][tick] == at(inputs, TICK_MS, tick * tick_ms)[key]).all()
        end = (tick + 1) * tick_ms
        np.testing.assert_allclose(yaw(longer, tick_ms, end), yaw(inputs, TICK_MS, end), atol=1e-14)


@settings(max_examples=50, deadline=None)
@given(scripts(), st.sampled_from([64, 96, 128]))
def test_a_shot_counts_in_the_first_tick_that_does_not_begin_before_it(inputs, tick_ms):
    wanted = np.zeros((TICKS * TICK_MS // tick_ms, PLAYERS), bool)
    for tick, player in np.argwhere(inputs["fire"]):
        later = -(-tick * TICK_MS // tick_ms)
        if later < len(wanted):
            wanted[later, player] = True
    assert (resampled(inputs, tick_ms)["fire"] == wanted).all()


@pytest.mark.parametrize("tick_ms", [0, -32, 12, 24, 48, 256])
def test_other_tick_lengths_are_refused(tick_ms):
    with pytest.raises(ValueError, match=f"tick_ms: expected .* got {tick_ms}"):
        resampled(held(TICKS, 1), tick_ms)


def play(blasts):
    start = np.zeros((2, 3))
    return Play("", grounds.creased(0.0), "sandbox", start, start, np.zeros(2), held(TICKS, 2), blasts)


def test_explosions_keep_their_time_or_wait_for_the_end_of_the_tick():
    one, other = np.full((2, 3), np.nan), np.full((2, 3), np.nan)
    one[0], other[1] = 1.0, 2.0
    made = play({3: one, 4: other})
    assert {tick_ms: sorted(made.at(tick_ms).blasts) for tick_ms in (8, 16, 32, 64)} == {
        8: [12, 16],
        16: [6, 8],
        32: [3, 4],
        64: [2],
    }
    np.testing.assert_array_equal(made.at(64).blasts[2], [[1.0] * 3, [2.0] * 3])
    with pytest.raises(ValueError, match="tick_ms: expected explosions of a player in different ticks"):
        play({3: one, 4: one}).at(64)


def test_on_other_ground_nobody_starts_in_it():
    rng = np.random.default_rng(0)
    heights = rng.uniform(0.0, 20.0, (17, 17))
    own, other = (Terrain.from_heights(one, 8.0, (-64.0, -64.0), "clamp") for one in (heights, heights[::-1]))
    xy = rng.uniform(-60.0, 60.0, (200, 2)).astype(np.float32).astype(np.float64)
    above = np.where(np.arange(200) % 2, 0.25, 6.0)
    position = np.column_stack([xy, own.height(xy) + above])
    points = np.column_stack([xy, own.height(xy)])
    points[::3] = np.nan
    script = held(TICKS, 200)
    made = Play("", own, "sandbox", position, np.zeros((200, 3)), np.zeros(200), script, {3: points}).on(
        other
    )

    clearance = made.position[:, 2] - other.height(xy)
    assert clearance.min() > 0.25 - 1e-5
    np.testing.assert_array_equal(made.position[:, :2], xy)
    lifted = made.position[:, 2] - position.astype(np.float32)[:, 2]
    assert lifted.min() == 0.0
    # No higher than needed, and not at all where there is room.
    np.testing.assert_allclose(clearance[lifted > 0.0], 0.25, atol=1e-5)
    assert (lifted[own.height(xy) > other.height(xy)] == 0.0).all()
    np.testing.assert_array_equal(np.isnan(made.blasts[3]), np.isnan(points))
    np.testing.assert_allclose(made.blasts[3][1::3, 2], other.height(xy[1::3].copy()), atol=1e-9)
    same = made.on(other)
    np.testing.assert_array_equal(same.position, made.position)
