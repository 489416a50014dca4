"""The simulator against the closed forms of `discjump theory`, within what the forms and rounding allow."""

import numpy as np
import pytest

from discjump.theory import blasts, bumps, convergence, figures, forms, hops
from discjump.theory.convergence import CASES, TICKS_MS
from discjump.theory.lab import TIERS, Tier, twin

from .test_theory_forms import knockback_table

DOUBLES = [tier for tier in TIERS if tier.double]
FLOATS = [tier for tier in TIERS if not tier.double]
HALF_ULP = 2.0**-24
"""Of a float32, by the number's own size."""


def by_name(tier):
    return tier.name


def errors(name, tier, starts=16):
    return convergence.errors(CASES[name], tier, starts)


# Order of convergence.


@pytest.mark.parametrize("name", ["free flight", "jets up"])
def test_even_forces_are_half_a_tick_late_in_the_article_and_exact_in_the_engine(name):
    up = -20.0 if name == "free flight" else 236 / 9 - 20.0
    off = errors(name, Tier("reference"))
    late = 0.5 * abs(up) * CASES[name].seconds * np.array(TICKS_MS) / 1000.0
    np.testing.assert_allclose(off["place"], np.broadcast_to(late[:, None], off["place"].shape), atol=1e-9)
    np.testing.assert_allclose(convergence.orders(off["place"]), 1.0, atol=1e-6)
    off = errors(name, Tier("engine", "float64"))
    assert off["place"].max() < 1e-9
    assert np.isnan(convergence.orders(off["place"])).all()


@pytest.mark.parametrize("tier", DOUBLES, ids=by_name)
def test_fading_jets_are_of_order_1(tier):
    """The next term of the error is smaller by about T/v_f times the tick: 0.076 at 64 ms."""
    off = errors("jets ahead", tier)
    for of in ("place", "velocity"):
        np.testing.assert_allclose(convergence.orders(off[of]), 1.0, atol=0.076)


@pytest.mark.parametrize("tier", FLOATS, ids=by_name)
@pytest.mark.parametrize("name", ["free flight", "jets up", "jets ahead"])
def test_float32_adds_its_rounding_and_no_more(name, tier):
    """Half a unit in the last place per tick, of speeds up to 75 m/s and of places up to 330 m."""
    off, double = errors(name, tier), errors(name, twin(tier))
    for k, tick_ms in enumerate(TICKS_MS):
        ticks, dt = round(1000 * CASES[name].seconds) // tick_ms, tick_ms / 1000.0
        # Of three sums a tick (thrust, velocity, its product with the tick) and three axes.
        speed = 3.0 * np.sqrt(3.0) * ticks * HALF_ULP * 128.0
        place = ticks * dt * speed + 3.0 * np.sqrt(3.0) * ticks * HALF_ULP * 512.0
        assert np.abs(off["velocity"][k] - double["velocity"][k]).max() <= speed
        assert np.abs(off["place"][k] - double["place"][k]).max() <= place


@pytest.mark.parametrize("fidelity", ["reference", "authentic", "fast"])
def test_short_ticks_brake_less_for_the_outward_push(fidelity):
    """Each contact lifts by 0.001 m/s times the tick, which falls by g dt^2: once in g dt / 0.001 m/s a
    tick misses the ground, and the next one friction. At 0.05 ms nobody would touch the ground at all."""
    off = errors("braking", Tier(fidelity))["velocity"]
    for k, tick_ms in enumerate(TICKS_MS):
        dt = tick_ms / 1000.0
        missed = forms.GROUND_LIGHT * CASES["braking"].seconds * 0.001 / (20.0 * dt)
        # A whole number of ticks is missed, the velocity keeps the push, and float32 its digits.
        assert np.abs(off[k] - missed).max() <= 1.5 * forms.GROUND_LIGHT * dt + 0.0011


@pytest.mark.parametrize("tier", TIERS, ids=by_name)
def test_landings_are_bounded_by_a_fall_from_a_slice(tier):
    """Who lands goes on from up to a slice above the ground, min(1 m, v dt); in the air nothing brakes."""
    off = errors("landing", tier)["velocity"]
    cos = np.cos(np.radians(convergence.SLOPE))
    # Across the plane: at most 40 m/s forward, 35 m/s down, and what 3 m of fall add.
    across = np.hypot(40.0 * np.sin(np.radians(convergence.SLOPE)) + 35.0 * cos, np.sqrt(2.0 * 20.0 * 3.0))
    for k, tick_ms in enumerate(TICKS_MS):
        dt = tick_ms / 1000.0
        height, fell, falls = min(1.0, across * dt), 0.0, 0
        # Each fall ends in a landing from a slice of its own.
        while height > 0.001 * dt and falls < 50:
            seconds = np.sqrt(2.0 * height / (20.0 * cos))
            fell, height, falls = fell + seconds + 2.0 * dt, min(height, 20.0 * cos * seconds * dt), falls + 1
        assert off[k].max() <= 40.0 * min(fell, CASES["landing"].seconds) + 20.0 * dt


# Single figures.


@pytest.mark.parametrize("figure", figures.figures(), ids=lambda figure: figure.name)
def test_figures_are_their_closed_forms(figure):
    row = figure.row(TIERS)
    for tier in TIERS:
        wanted, got = row[tier.model], row["measured"][tier.name]
        if not figure.unit:
            assert got == wanted
        else:
            # At most 250 ticks of three sums at up to 256 m or m/s.
            bound = 1e-11 if tier.double else 3 * 250 * HALF_ULP * 256.0
            assert abs(got - wanted) <= bound, tier.name


@pytest.mark.parametrize("tier", TIERS, ids=by_name)
def test_blasts_are_the_table_of_section_6(tier):
    rows = np.array(knockback_table())
    columns = [("light", "basic", 4), ("light", "linear_boosted", 5), ("light", "tribes", 6)]
    for armor, formula, column in [*columns, ("medium", "tribes", 7), ("heavy", "tribes", 8)]:
        got = blasts.pushes(tier, armor, formula, rows[:, 0])
        wanted = np.where(rows[:, 0] == 0.0, 0.0, rows[:, column])
        assert np.abs(got - wanted).max() <= 0.005 + 2e-5


@pytest.mark.parametrize("tier", TIERS, ids=by_name)
def test_blasts_follow_the_formulas_between(tier):
    """The steepest of the curves gains 29 m/s in a metre; float32 knows places of 10 m to 5e-7."""
    for armor in forms.ARMORS:
        for formula in blasts.FORMULAS:
            row = blasts.measure(tier, armor, formula, 34 * 20 + 1)
            assert row["largest"] <= (1e-12 if tier.double else 29.0 * 5e-7 + 8 * HALF_ULP * row["peak"])


# Skiing.


@pytest.mark.parametrize("tier", TIERS, ids=by_name)
@pytest.mark.parametrize("keys", hops.KEYS)
@pytest.mark.parametrize("slope", [5.0, 20.0, 35.0, 45.0])
def test_skiing_is_its_law(slope, keys, tier):
    row = hops.measure(tier, slope, keys)
    # What a hop gains is what gravity gives and what jump and friction take: exactly, for any period.
    # A hop has 34 ticks at most, at up to 256 m/s.
    assert row["hop_error"] <= (1e-11 if tier.double else 3 * 34 * HALF_ULP * 256.0)
    # The period is the law's, but hops have whole ticks and begin where a slice does.
    assert abs(row["period"] - row["law"]["period"]) < 0.032
    lost = forms.hop(slope, keys == "forward", 0.032).lost
    off = lost / (row["law"]["period"] - 0.032) - lost / row["law"]["period"]
    assert abs(row["acceleration"] - row["law"]["acceleration"]) <= off


def test_skiing_costs_nothing_as_the_tick_shrinks():
    down = 20.0 * np.sin(np.radians(20.0))
    for keys, share in (("forward", 1.0), ("none", 0.5)):
        cost = {
            ms: share * down - hops.measure(TIERS[0], 20.0, keys, ms)["acceleration"] for ms in (2, 8, 32)
        }
        # In proportion to the tick: by the law itself 0.5 % less at 8 ms, 6 % more at 32 ms.
        assert cost[8] / cost[2] == pytest.approx(4.0, rel=0.03)
        assert cost[32] / cost[8] == pytest.approx(4.0, rel=0.10)


# Ghost bumps.


@pytest.mark.parametrize("ground", bumps.GROUNDS)
@pytest.mark.parametrize("tier", TIERS, ids=by_name)
def test_a_plane_has_no_bumps_at_any_angle(tier, ground):
    """Its triangles are one plane: what is left is the tick's own, the same for every cut."""
    plane = bumps.SURFACES["plane"]
    slides = np.array(
        [
            bumps.slide(tier, plane, square, bearing, ground).lost
            for square in (8.0, 1.0)
            for bearing in bumps.BEARINGS
        ]
    )
    if tier.fidelity == "swept":
        # A start on the ground pushes out, by how many slices is a tie: a share of 0.64 m, once.
        assert np.abs(slides).max() < 20.0 * 0.64 / 10.0 / 90.0 / 10.0
        return
    spread = np.ptp(slides, axis=0).max()
    # About 150 ticks at places of up to 64 m, whose height counts 20 J/kg a metre, over 80 m at 15 m/s.
    assert spread < (1e-9 if tier.double else 20.0 * 150 * HALF_ULP * 64.0 / (80.0 * 15.0))


@pytest.mark.parametrize(
    "tier", [Tier(name) for name in ("reference", "authentic", "swept", "fast")], ids=by_name
)
@pytest.mark.parametrize("ground", bumps.GROUNDS)
@pytest.mark.parametrize("square", [8.0, 4.0])
def test_bumps_are_bounded_by_the_turning_of_the_ground(square, ground, tier):
    """A surface of curvature k turns by k h at an edge, and by k v dt in a tick, as at an edge of v dt
    metres. Who hovers from a slice made again may pass one edge in the air, and the next takes both turns at
    once: twice as much as one by one."""
    for name in ("valley", "crest"):
        surface = bumps.SURFACES[name]
        for bearing in (0.0, 13.0, 31.0, 45.0):
            made = bumps.slide(tier, surface, square, bearing, ground)
            tick = made.theory / square * (30.0 * 0.032)
            assert made.hung == 0
            assert made.lost.max() <= 2.0 * (made.theory + tick)


def test_edges_straight_across_cost_what_theory_says():
    """`fast` has one contact a tick and no slices made again: the edges alone, to a twentieth."""
    made = [bumps.slide(Tier("fast"), bumps.SURFACES["valley"], square, 0.0) for square in (8.0, 4.0)]
    for slide in made:
        assert slide.lost.mean() == pytest.approx(slide.theory, rel=0.06)
    assert made[0].lost.mean() / made[1].lost.mean() == pytest.approx(2.0, rel=0.06)


def test_float32_has_the_bumps_of_float64():
    """Four more digits than any of the figures that are told: paths part only at ties."""
    for name in ("valley", "crest", "cone"):
        slides = [bumps.slide(Tier(f), bumps.SURFACES[name], 8.0, 19.0) for f in ("reference", "authentic")]
        off = np.abs(slides[0].lost - slides[1].lost)
        assert np.median(off) < 1e-5
