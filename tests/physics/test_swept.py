"""The two literal forms of section 5 beside the sliced one: what core/docs/physics.md says of them.

Plain Python only. `swept` must be the sliced form but for rounding; where it is not, a hit took no time or a
tick had two (sections 5.2 and 11, item 7)."""

import copy

import numpy as np
import pytest

from .article import Keys, Player, Rules, norm
from .ground import Ground, Incline, Surface, Vec, along
from .models import last, play, standing, tick
from .scripts import HELD, creased, rolling

RULES = Rules()


def starts(ground: Surface, seed: int, many: int, spread: float, slow: float) -> list[tuple[Player, Keys]]:
    """In the air, on ballistic ways down, each with one of the scripts."""
    rng = np.random.default_rng(seed)
    found = []
    for i in range(many):
        x, y = rng.uniform(-spread, spread, 2)
        z = ground.plane_at(x, y).height(x, y) + rng.uniform(0.5, 8.0)
        velocity = rng.normal(0.0, slow, 3)
        yaw = rng.uniform(-np.pi, np.pi)
        player = standing("sliced", (x, y, z), (velocity[0], velocity[1], velocity[2]), yaw=yaw)
        found.append((player, Keys(*HELD[i % len(HELD)])))
    return found


def together(player: Player, keys: Keys, ground: Surface, ticks: int) -> tuple[float, int, bool]:
    """Runs both forms until they part by more than 1e-9 m: the largest distance before, the ticks until then,
    and whether the tick that parted them had more than one contact."""
    other = copy.deepcopy(player)
    worst = 0.0
    for k in range(ticks):
        tick("sliced", player, keys, ground, RULES)
        tick("swept", other, keys, ground, RULES)
        apart = norm(along(player.position, other.position, -1.0))
        if apart > 1e-9 or len(player.contacts) != len(other.contacts):
            return worst, k, max(len(player.contacts), len(other.contacts)) > 1
        worst = max(worst, apart, norm(along(player.velocity, other.velocity, -1.0)))
    return worst, ticks, False


@pytest.mark.parametrize(("degrees", "bearing"), [(0, 0.0), (20, 1.0), (45, -2.2), (60, 0.3)])
def test_swept_is_sliced_on_planes(degrees: float, bearing: float) -> None:
    """All 10 s of all runs."""
    for player, keys in starts(Incline(degrees, bearing), 1, 18, 30.0, 25.0):
        worst, until, _ = together(player, keys, Incline(degrees, bearing), 312)
        assert until == 312
        assert worst < 1e-9


def test_swept_is_sliced_on_rolling_terrain() -> None:
    """Of 27 runs of 20 s some keep together to the end, and none parts but in a tick with two contacts."""
    ground = Ground(rolling(129, 129, height=8.0))
    runs = [together(player, keys, ground, 625) for player, keys in starts(ground, 2, 27, 200.0, 25.0)]
    assert max(worst for worst, _, _ in runs) < 1e-9
    assert all(until == 625 or in_a_crease for _, until, in_a_crease in runs)
    assert sum(until == 625 for _, until, _ in runs) >= 9


def test_hit_that_takes_no_time() -> None:
    """Section 5.1's literal corner: p + n (I + 0.001) h; with the fix-up clamped the player stays at p."""
    for clamp, height in ((False, 30.64 * 0.032 + 0.001 * 0.032 - 2.0), (True, -2.0)):
        player = standing("swept", (0.0, 0.0, -2.0), (0.0, 0.0, -30.0))
        rules = Rules(clamp_fixup=clamp)
        tick("swept", player, Keys(), Incline(0.0), rules)
        # The rest of the tick is swept again with the outward push as its speed.
        assert player.position[2] == pytest.approx(height + 0.001 * 0.032, abs=1e-12)
        assert player.contacts == [(0.0, 0.0, 1.0)]


def lowest(
    model: str, kind: str, degrees: float, keys: list[Keys], rules: Rules = RULES
) -> tuple[float, float]:
    """Height above the ground at the lowest moment of 9.6 s of all runs, and at the lowest end."""
    ground = Ground(creased(kind, degrees))
    rng = np.random.default_rng(3)
    low, end = 0.0, 0.0
    for i in range(12):
        x, y = rng.uniform(-30.0, 30.0, 2)
        velocity: Vec = tuple(rng.normal(0.0, 20.0, 3))
        start = (x, y, ground.plane_at(x, y).height(x, y) + rng.uniform(0.0, 10.0))
        player = standing(model, start, velocity, yaw=rng.uniform(-np.pi, np.pi))
        heights = [
            p.position[2] - ground.plane_at(p.position[0], p.position[1]).height(p.position[0], p.position[1])
            for p in play(model, player, keys[i % len(keys)], ground, rules, ticks=300)
        ]
        low, end = min(low, *heights), min(end, heights[-1])
    return low, end


STILL = [Keys(), Keys(jump=True), Keys(jet=True), Keys(forward=1, jump=True)]
WALKING = [Keys(forward=1), Keys(forward=-1, strafe=1)]


@pytest.mark.parametrize("kind", ["valley", "diagonal"])
@pytest.mark.parametrize("degrees", [45, 60, 75])
def test_creases(kind: str, degrees: int) -> None:
    """The sliced form stays above. "Anyway" falls through. The swept one dips by up to some 0.9 m at 75
    degrees and comes back up."""
    assert lowest("sliced", kind, degrees, STILL + WALKING)[0] > -1e-9
    through = {45: -0.1, 60: -4.0, 75: -20.0}[degrees]
    assert lowest("anyway", kind, degrees, STILL)[1] < through
    low, end = lowest("swept", kind, degrees, STILL)
    assert low > -1.1
    assert end > -0.15
    if degrees == 75:
        assert low < -0.2


def test_walkers_in_a_steep_valley() -> None:
    """Who walks at 75 degrees without jumping does not come back up: he sinks until the push-out of a hit
    that takes no time holds him, 3 to 6 m under the faces. A sweep of the fix-up keeps him near them."""
    low, end = lowest("swept", "valley", 75, WALKING)
    assert -6.0 < low <= end < -3.0
    low, end = lowest("swept", "valley", 75, WALKING, Rules(fixup_swept=True))
    assert low > -0.2
    assert end > -1e-3


def test_switches_do_nothing_on_a_plane() -> None:
    """Where every hit takes time and nothing is in the fix-up's way."""
    for rules in (Rules(clamp_fixup=True), Rules(fixup_swept=True)):
        for degrees in (0.0, 30.0):
            ends = []
            for chosen in (RULES, rules):
                player = standing("swept", (0.0, 0.0, 3.0), (0.0, 20.0, -5.0))
                ends.append(
                    last(play("swept", player, Keys(forward=1, jump=True), Incline(degrees), chosen, 300))
                )
            assert norm(along(ends[0].position, ends[1].position, -1.0)) < 1e-9
