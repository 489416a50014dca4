"""The closed forms of `discjump theory` against SciPy's integration of the text, and against plain loops."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discjump.theory import forms
from discjump.theory.forms import ARMORS, GRAVITY

PHYSICS = Path(__file__).parents[2] / "core" / "docs" / "physics.md"


def integrated(rate, start, seconds, **more):
    solution = solve_ivp(rate, (0.0, seconds), start, method="DOP853", rtol=1e-12, atol=1e-12, **more)
    assert solution.success
    return solution


@pytest.mark.parametrize("armor", ARMORS)
@pytest.mark.parametrize("share", [-0.5, 0.0, 0.15, 0.2, 0.6, 0.95])
def test_fading_jets_are_scipys(armor, share):
    """Section 4.2 as it stands, with its `max` and `min`; the kink is met by small steps."""
    kind = ARMORS[armor]

    def rate(_, state):
        _, speed, _, climb = state
        s = 0.0 if speed > kind.fade else 1.0 if speed < 0.0 else 1.0 - speed / kind.fade
        s = min(s, 0.8)
        return [speed, s * kind.jet, climb, (1.0 - s) * kind.jet - GRAVITY]

    speed, climb, seconds = share * kind.fade, 3.0, 2.0
    way, last, height, up = integrated(rate, [0.0, speed, 0.0, climb], seconds, max_step=1e-3).y[:, -1]
    flown = forms.fading(kind, speed, climb, seconds)
    got = (flown.way, flown.speed, flown.climb, flown.climb_speed)
    np.testing.assert_allclose(got, (way, last, height, up), rtol=0.0, atol=1e-8)


class Meets:
    """SciPy ends an integration where this falls to zero."""

    terminal = True
    direction = -1.0

    def __init__(self, normal):
        self.normal = normal

    def __call__(self, _, state):
        return self.normal @ state[:2]


@pytest.mark.parametrize("height", [0.5, 3.0])
@pytest.mark.parametrize(("forward", "down"), [(30.0, 20.0), (40.0, 30.0), (0.0, 2.0)])
def test_landing_and_sliding_is_scipys(height, forward, down):
    degrees, seconds = 30.0, 0.768
    sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    normal, along = np.array([sin, cos]), np.array([cos, -sin])

    fall = integrated(
        lambda _, s: [s[2], s[3], 0.0, -GRAVITY],
        [0.0, height, forward, -down],
        seconds,
        events=Meets(normal),
        max_step=0.01,
    )
    landed = fall.y[:, -1]
    # The contact takes what is across the plane; friction is level, and its part across is taken as well.
    slide = integrated(
        lambda _, s: [s[1], GRAVITY * sin - 40.0 * cos], [0.0, along @ landed[2:]], seconds - fall.t[-1]
    )
    speed, way = forms.slide_and_land(degrees, height, forward, down, seconds)
    wanted = along @ landed[:2] - along @ [0.0, height] + slide.y[0, -1]
    assert speed == pytest.approx(slide.y[1, -1], abs=1e-8)
    assert way == pytest.approx(wanted, abs=1e-8)


@pytest.mark.parametrize("model", ["article", "engine"])
@pytest.mark.parametrize("dt", [0.001, 0.016, 0.032, 0.064, 0.25])
def test_ways_and_apexes_are_those_of_loops(model, dt):
    speed, height, highest, v = 25 / 3, 0.0, 0.0, 25 / 3
    for n in range(1, 2 + math.ceil(speed / (GRAVITY * dt))):
        old, v = v, v - GRAVITY * dt
        height += dt * (v if model == "article" else 0.5 * (old + v))
        highest = max(highest, height)
        assert forms.way(model, speed, -GRAVITY, dt, n) == pytest.approx(height, abs=1e-12)
    assert forms.apex(model, speed, dt) == pytest.approx(highest, abs=1e-12)
    # Section 11, item 18, for the article: v^2/2g - v dt/2, and at most g dt^2/8 more.
    smooth = speed**2 / (2.0 * GRAVITY) - (0.5 * speed * dt if model == "article" else 0.0)
    most = GRAVITY * dt**2 / 8.0 if model == "article" else 0.0
    assert smooth + most - GRAVITY * dt**2 / 8.0 - 1e-12 <= highest <= smooth + most + 1e-12


@pytest.mark.parametrize("armor", ARMORS)
@pytest.mark.parametrize("pack", [False, True])
@pytest.mark.parametrize("dt", [0.008, 0.032, 0.1])
def test_burns_are_those_of_loops(armor, pack, dt):
    kind = ARMORS[armor]
    energy, ticks = kind.energy, 0
    while energy > 1.0:
        energy = min(energy + (8.0 + 3.0 * pack) * dt - kind.drain * dt, kind.energy)
        ticks += 1
    assert forms.burn_ticks(kind, pack, dt) == ticks


@pytest.mark.parametrize("model", ["article", "engine"])
@pytest.mark.parametrize("share", [0.2, 0.5, 0.99])
def test_fading_by_ticks_is_a_loop(model, share):
    kind, dt = ARMORS["light"], 0.032
    v = first = share * kind.fade
    way = 0.0
    for _ in range(64):
        old, v = v, v + dt * kind.jet * (1.0 - v / kind.fade)
        way += dt * (v if model == "article" else 0.5 * (old + v))
    np.testing.assert_allclose(forms.fading_ticks(model, kind, first, dt, 64), (v, way), rtol=1e-12)


def test_stopping_is_section_4s():
    """40 m/s -> 0 in 20.6 m, 33 ticks."""
    ticks, way = forms.stop(ARMORS["light"], 40.0, 0.032)
    assert (ticks, round(way, 1)) == (33, 20.6)


def test_the_law_of_a_hop_shrinks_to_its_limits():
    """As the tick shrinks: all of g sin with the key, half of it without."""
    for degrees in (5.0, 20.0, 45.0):
        down = GRAVITY * math.sin(math.radians(degrees))
        for forward, share in ((True, 1.0), (False, 0.5)):
            assert forms.hop(degrees, forward, 1e-9).acceleration == pytest.approx(share * down, rel=1e-6)


def knockback_table():
    """Section 6's, row by row, as printed."""
    text = PHYSICS.read_text().partition("Disc: R 7.5, K 150, D 0.5.")[2].partition("(boosted and basic")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")][2:]
    found = [[float(cell) for cell in line.strip("| ").split("|")] for line in lines]
    assert len(found) == 35
    return found


def test_pushes_are_the_table_of_section_6():
    for d0, *row in knockback_table():
        for k, formula in enumerate(("basic", "linear_boosted", "tribes")):
            power = forms.power(formula, d0, 1.0)
            assert power == pytest.approx(row[k], abs=0.50001e-4)
            assert 150.0 / 9.0 * power == pytest.approx(row[3 + k], abs=0.50001e-2)
        for k, armor in enumerate(("medium", "heavy")):
            kind = ARMORS[armor]
            push = 150.0 / kind.mass * forms.power("tribes", d0, kind.min_box)
            assert push == pytest.approx(row[6 + k], abs=0.50001e-2)
