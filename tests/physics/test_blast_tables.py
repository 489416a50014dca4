"""The plain Python explosions against the figures of core/docs/physics.md: 6, and the disc jumps of 10."""

import math

import pytest

from .article import ARMORS, Keys, norm
from .blast import COVER_DEPTH, DISC, GRENADE, MORTAR, Charge, explode, harm, min_box, power
from .ground import Incline, Vec, along
from .models import play, rules_of, standing

LEVEL = Incline(0.0)

#: d0, basic, boosted, Tribes (m = 1), dv basic, dv boosted, dv Tribes, dv medium, dv heavy, damage
# fmt: off
KNOCKBACK = [
    (0.00, 1.0000, 2.3636, 0.0000, 16.67, 39.39, 0.00, 0.00, 0.00, 0.4333),
    (0.25, 0.9667, 2.2848, 0.2167, 16.11, 38.08, 3.61, 2.50, 1.81, 0.4333),
    (0.50, 0.9333, 2.2061, 0.4333, 15.56, 36.77, 7.22, 5.00, 3.61, 0.4333),
    (0.75, 0.9000, 2.1273, 0.6500, 15.00, 35.45, 10.83, 7.50, 5.42, 0.4333),
    (1.00, 0.8667, 2.0485, 0.8667, 14.44, 34.14, 14.44, 10.00, 7.22, 0.4333),
    (1.25, 0.8333, 1.9697, 1.0833, 13.89, 32.83, 18.06, 12.50, 9.03, 0.4333),
    (1.50, 0.8000, 1.8909, 1.3000, 13.33, 31.52, 21.67, 15.00, 10.83, 0.4333),
    (1.75, 0.7667, 1.8121, 1.5167, 12.78, 30.20, 25.28, 17.50, 12.64, 0.4333),
    (2.00, 0.7333, 1.7333, 1.7333, 12.22, 28.89, 28.89, 20.00, 14.44, 0.4333),
    (2.25, 0.7000, 1.6545, 1.5000, 11.67, 27.58, 25.00, 22.50, 16.25, 0.4167),
    (2.50, 0.6667, 1.5758, 1.3333, 11.11, 26.26, 22.22, 22.38, 18.06, 0.4000),
    (2.75, 0.6333, 1.4970, 1.2048, 10.56, 24.95, 20.08, 19.27, 16.87, 0.3833),
    (3.00, 0.6000, 1.4182, 1.1000, 10.00, 23.64, 18.33, 17.02, 14.52, 0.3667),
    (3.25, 0.5667, 1.3394, 1.0111, 9.44, 22.32, 16.85, 15.27, 12.80, 0.3500),
    (3.50, 0.5333, 1.2606, 0.9333, 8.89, 21.01, 15.56, 13.85, 11.46, 0.3333),
    (3.75, 0.5000, 1.1818, 0.8636, 8.33, 19.70, 14.39, 12.64, 10.37, 0.3167),
    (4.00, 0.4667, 1.1030, 0.8000, 7.78, 18.38, 13.33, 11.60, 9.44, 0.3000),
    (4.25, 0.4333, 1.0242, 0.7410, 7.22, 17.07, 12.35, 10.67, 8.64, 0.2833),
    (4.50, 0.4000, 0.9455, 0.6857, 6.67, 15.76, 11.43, 9.83, 7.93, 0.2667),
    (4.75, 0.3667, 0.8667, 0.6333, 6.11, 14.44, 10.56, 9.05, 7.29, 0.2500),
    (5.00, 0.3333, 0.7879, 0.5833, 5.56, 13.13, 9.72, 8.33, 6.70, 0.2333),
    (5.25, 0.3000, 0.7091, 0.5353, 5.00, 11.82, 8.92, 7.66, 6.15, 0.2167),
    (5.50, 0.2667, 0.6303, 0.4889, 4.44, 10.51, 8.15, 7.02, 5.64, 0.2000),
    (5.75, 0.2333, 0.5515, 0.4439, 3.89, 9.19, 7.40, 6.41, 5.16, 0.1833),
    (6.00, 0.2000, 0.4727, 0.4000, 3.33, 7.88, 6.67, 5.82, 4.70, 0.1667),
    (6.25, 0.1667, 0.3939, 0.3571, 2.78, 6.57, 5.95, 5.25, 4.26, 0.1500),
    (6.50, 0.1333, 0.3152, 0.3152, 2.22, 5.25, 5.25, 4.71, 3.83, 0.1333),
    (6.75, 0.1000, 0.2364, 0.2739, 1.67, 3.94, 4.57, 4.17, 3.42, 0.1167),
    (7.00, 0.0667, 0.1576, 0.2333, 1.11, 2.63, 3.89, 3.65, 3.02, 0.1000),
    (7.25, 0.0333, 0.0788, 0.1933, 0.56, 1.31, 3.22, 3.15, 2.64, 0.0833),
    (7.50, 0.0000, 0.0000, 0.1538, 0.00, 0.00, 2.56, 2.65, 2.26, 0.0667),
    (7.75, 0.0000, 0.0000, 0.1148, 0.00, 0.00, 1.91, 2.16, 1.89, 0.0500),
    (8.00, 0.0000, 0.0000, 0.0762, 0.00, 0.00, 1.27, 1.68, 1.53, 0.0333),
    (8.25, 0.0000, 0.0000, 0.0379, 0.00, 0.00, 0.63, 1.20, 1.17, 0.0167),
    (8.50, 0.0000, 0.0000, 0.0000, 0.00, 0.00, 0.00, 0.74, 0.82, 0.0000),
]
# fmt: on


@pytest.mark.parametrize("row", KNOCKBACK, ids=lambda row: f"{row[0]} m")
def test_knockback(row: tuple[float, ...]) -> None:
    d0 = row[0]
    light, medium, heavy = (ARMORS[name] for name in ("light", "medium", "heavy"))
    powers = [power(d0, name, 7.5, 1.0) for name in ("basic", "linear_boosted", "tribes")]
    assert powers == pytest.approx(row[1:4], abs=5.1e-5)
    speeds = [150.0 / light.mass * p for p in powers]
    speeds += [150.0 / a.mass * power(d0, "tribes", 7.5, min_box(a)) for a in (medium, heavy)]
    assert speeds == pytest.approx(row[4:9], abs=5.1e-3)
    assert harm(d0, DISC, 1.0) == pytest.approx(row[9], abs=5.1e-5)


def blown(
    armor: str, away: Vec, formula: str = "tribes", cutoff: str = "engine", charge: Charge = DISC
) -> tuple[Vec, float]:
    """Velocity and damage of a player at rest, the blast `away` from his box's centre."""
    body = ARMORS[armor]
    player = standing("sliced", (3.0, -2.0, 7.0), armor=armor)
    centre = along(player.position, (0.0, 0.0, 0.5), body.height)
    explode(player, body, along(centre, away, 1.0), None, charge, formula, cutoff)
    return player.velocity, player.damage


@pytest.mark.parametrize(
    ("armor", "column", "reach"), [("light", 6, 8.5), ("medium", 7, 8.9), ("heavy", 8, 9.1)]
)
def test_direction_and_reach(armor: str, column: int, reach: float) -> None:
    """The table's speeds, away from the blast. Along an axis the cube of half side R is left before R + m,
    but for a light's height; between the axes all of R + m counts."""
    body = ARMORS[armor]
    for axis, half in enumerate((body.half_width, body.half_width, 0.5 * body.height)):
        for row in KNOCKBACK:
            velocity, _ = blown(armor, (row[0] * (axis == 0), row[0] * (axis == 1), row[0] * (axis == 2)))
            expected = row[column] if row[0] <= 7.5 + half else 0.0
            assert velocity[axis] == pytest.approx(-expected, abs=5.1e-3)
    for distance, felt in ((reach - 0.01, True), (reach + 0.01, False)):
        part = distance / math.sqrt(3.0)
        velocity, damage = blown(armor, (part, part, part))
        assert (norm(velocity) > 0.0) == felt
        assert (damage > 0.0) == felt


def test_cutoffs() -> None:
    """At 7.5 m the power is still 0.154; "radius" ends there."""
    at, beyond = (0.0, 0.0, -7.5), (0.0, 0.0, -7.501)
    assert blown("light", at, cutoff="radius") == blown("light", at)
    assert norm(blown("light", at)[0]) == pytest.approx(150 / 9 * 0.1538, abs=1e-3)
    assert norm(blown("light", beyond)[0]) > 2.5
    assert blown("light", beyond, cutoff="radius") == ((0.0, 0.0, 0.0), 0.0)
    for formula in ("basic", "linear_boosted"):
        assert norm(blown("light", beyond, formula)[0]) == 0.0


def test_peak() -> None:
    """1.733 at 1 + m = 2 m, where linear_boosted meets it: 28.9 m/s against 16.6 at the feet."""
    assert power(2.0, "tribes", 7.5, 1.0) == pytest.approx(1.7333, abs=5e-5)
    assert power(2.0, "linear_boosted", 7.5, 1.0) == pytest.approx(1.7333, abs=5e-5)
    assert power(0.25, "linear_boosted", 7.5, 1.0) / power(0.25, "tribes", 7.5, 1.0) > 10.0
    for nearby in (1.99, 2.01):
        assert power(nearby, "tribes", 7.5, 1.0) < power(2.0, "tribes", 7.5, 1.0)


def test_extremes() -> None:
    """Section 11, item 16."""
    velocity, damage = blown("light", (0.0, 0.0, 0.0))
    assert velocity == (0.0, 0.0, 0.0)
    assert damage == pytest.approx(0.4333, abs=5e-5)
    assert blown("light", (0.0, 0.5, 0.0), charge=Charge(0.5, 1.0, 150.0)) == ((0.0, 0.0, 0.0), 0.0)
    for d0 in (0.5, 3.0, 9.0):
        assert power(d0, "tribes", 7.5, 20.0) == pytest.approx(d0 * (1.0 - 1.0 / 7.5))


def test_armor_factors() -> None:
    """Flat out at 2 m; explosion, shrapnel and mortar in section 2."""
    for armor, factors in (("light", (1.0, 1.2, 1.3)), ("medium", (1, 1, 1)), ("heavy", (0.6, 0.8, 0.7))):
        damages = [blown(armor, (0.0, 0.0, -2.0), charge=c)[1] for c in (DISC, GRENADE, MORTAR)]
        full = (0.5 * (1 - 1 / 7.5), 0.4 * (1 - 1 / 15), 1.0 * (1 - 1 / 20))
        assert damages == pytest.approx([f * d for f, d in zip(factors, full, strict=True)])


def test_cover() -> None:
    """Only a blast more than 5 cm below the surface spares anyone."""
    for depth, felt in [(0.0, True), (COVER_DEPTH - 1e-6, True), (COVER_DEPTH + 1e-6, False), (3.0, False)]:
        player = standing("sliced")
        explode(player, ARMORS["light"], (0.0, 0.0, -depth), LEVEL)
        assert (player.damage > 0.0) == felt


def test_one_disc_jump_not_two() -> None:
    _, damage = blown("light", (0.0, 0.0, -2.0))
    assert damage < 0.66 < 2 * damage
    assert 2 * damage == pytest.approx(0.867, abs=5e-4)


def jump_and_disc(armor: str, delay: int | None) -> tuple[float, float]:
    """Speed that the blast gives, and the apex. The blast, on the ground below, acts before the tick that
    comes `delay` ticks after the jump's; None is a blast without a jump."""
    rules = rules_of("sliced", armor)
    player = standing("sliced", jump_age=0, armor=armor)
    gain, apex = 0.0, 0.0
    for k in range(300):
        if k == (delay or 0):
            before = player.velocity
            explode(player, rules.armor, (*player.position[:2], 0.0), LEVEL)
            gain = norm(along(player.velocity, before, -1.0))
        next(play("sliced", player, Keys(jump=delay is not None and k == 0), LEVEL, rules))
        apex = max(apex, player.position[2])
    return gain, apex


def test_disc_jump_by_delay() -> None:
    """Light: the blast alone, then 1 to 8 ticks after the jump; and before the very tick of the jump."""
    apexes = [jump_and_disc("light", delay)[1] for delay in (None, 1, 2, 3, 4, 5, 6, 7, 8)]
    assert apexes == pytest.approx([6.6, 19.2, 23.2, 27.1, 30.0, 24.8, 21.2, 18.6, 16.6], abs=0.051)
    assert jump_and_disc("light", 0)[1] == pytest.approx(15.2, abs=0.051)


@pytest.mark.parametrize(
    ("armor", "standing_row", "best_row"),
    [
        ("light", (16.6, 6.6), (4, 28.7, 30)),
        ("medium", (12.0, 3.4), (6, 23.9, 21)),
        ("heavy", (9.4, 2.1), (7, 18.7, 14)),
    ],
)
def test_disc_at_the_feet_and_best(
    armor: str, standing_row: tuple[float, float], best_row: tuple[int, float, float]
) -> None:
    assert jump_and_disc(armor, None) == pytest.approx(standing_row, abs=0.051)
    runs = [jump_and_disc(armor, delay) for delay in range(12)]
    best = max(range(12), key=lambda delay: runs[delay][1])
    assert best == best_row[0]
    assert runs[best][0] == pytest.approx(best_row[1], abs=0.055)
    assert runs[best][1] == pytest.approx(best_row[2], abs=0.5)


def test_feet_blast() -> None:
    """d0 = 1.15, half the height of a light."""
    player = standing("sliced")
    explode(player, ARMORS["light"], (0.0, 0.0, 0.0), LEVEL)
    assert player.velocity[2] == pytest.approx(150 / 9 * (1.15 - 1.15 / 7.5))
    assert math.isclose(player.damage, 0.5 * (1 - 1 / 7.5))
