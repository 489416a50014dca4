"""Explosions and discs of `reference` against the plain Python ones: whole runs, all fields, 1e-6."""

import numpy as np
import pytest

import discjump

from .article import ARMORS
from .blast import explode
from .disc import Launcher
from .ground import Ground
from .pair import Pair, player_of
from .scripts import HELD, above, random_keys, rolling, rows


def blown_up(armor: str, launcher: Launcher, seed: int, nearest: float = 0.0) -> Pair:
    """Blasts all around the players, in and out of reach, below the ground too."""
    rng = np.random.default_rng(seed)
    many = 40
    terrain = rolling(33, 33)
    pair = Pair(
        terrain,
        many,
        armor=armor,
        scene="disc_jump",
        launcher=launcher,
        position=above(terrain, rng.uniform(0.0, 200.0, (many, 2)), rng.uniform(0.0, 3.0, many)),
    )
    keys = random_keys(rng, many)
    for _ in range(40):
        away = rng.normal(0.0, 1.0, (many, 3))
        away *= rng.uniform(nearest, 10.0, (many, 1)) / np.linalg.norm(away, axis=1, keepdims=True)
        points = pair.own("position") + away
        points[:, 2] += 0.5 * ARMORS[armor].height
        points[rng.random(many) < 0.2] = np.nan
        pair.explode(points)
        pair.step(next(keys))
    return pair


@pytest.mark.parametrize("armor", ["light", "medium", "heavy"])
@pytest.mark.parametrize("cutoff", ["engine", "radius"])
def test_explosions(armor: str, cutoff: str) -> None:
    pair = blown_up(armor, Launcher(cutoff=cutoff), 1)
    assert (pair.own("damage") > 0.0).mean() > 0.5


@pytest.mark.parametrize("formula", ["basic", "linear_boosted"])
def test_formulas(formula: str) -> None:
    """Not next to the centre, where their speed does not fall to 0 and the direction magnifies rounding."""
    blown_up("light", Launcher(formula=formula), 2, nearest=1.0)


@pytest.mark.parametrize(
    "launcher",
    [
        Launcher(),
        Launcher(accel="none"),
        Launcher(accel="mass"),
        Launcher(disc="engine"),
        Launcher(formula="basic", cutoff="radius"),
        Launcher("grenade_launcher"),
        Launcher("mortar"),
    ],
    ids=str,
)
def test_disc_runs(launcher: Launcher) -> None:
    """Some 10 s of everybody firing at the ground before and under him, all keys at random."""
    rng = np.random.default_rng(3)
    many = 24
    terrain = rolling(33, 33)
    pair = Pair(
        terrain,
        many,
        scene="disc_jump",
        launcher=launcher,
        position=above(terrain, rng.uniform(0.0, 200.0, (many, 2)), 2.0),
        velocity=rng.normal(0.0, 15.0, (many, 3)),
        yaw=rng.uniform(-np.pi, np.pi, many),
    )
    keys = random_keys(rng, many)
    pitch = rng.uniform(-1.7, 0.4, many)
    for _ in range(300):
        inputs = next(keys)
        pitch = np.where(rng.random(many) < 0.05, rng.uniform(-1.7, 0.4, many), pitch)
        inputs["pitch"], inputs["fire"] = pitch, rng.random(many) < 0.3
        pair.step(inputs)
    assert pair.bursts > 30
    if launcher.weapon == "disc":
        assert (pair.own("damage") > 0.4).sum() > 5


@pytest.mark.parametrize("tick_ms", [16, 64])
@pytest.mark.parametrize("disc", ["surface", "engine"])
def test_disc_tick_lengths(tick_ms: int, disc: str) -> None:
    """Cycle, life and clock; the trigger is held, one player shoots into the sky."""
    terrain = rolling(33, 33)
    many = len(HELD)
    pair = Pair(
        terrain,
        many,
        tick_ms=tick_ms,
        scene="disc_jump",
        launcher=Launcher(tick_ms=tick_ms, disc=disc),
        position=above(terrain, np.full((many, 2), 40.0), 1.0),
    )
    pitch = np.linspace(-1.6, 0.2, many)
    pair.step(rows(HELD, fire=True, pitch=pitch), 5000 // tick_ms)
    assert pair.bursts >= many - 1


@pytest.mark.parametrize("fidelity", ["authentic", "swept", "engine"])
def test_explosions_in_float32(fidelity: str) -> None:
    """From the simulator's own state before every explosion, so that nothing adds up."""
    rng = np.random.default_rng(4)
    many = 200
    terrain = rolling(33, 33)
    ground = Ground(terrain)
    simulator = discjump.Simulator(terrain, many, scene="sandbox", fidelity=fidelity, threads=1)
    state = simulator.state()
    state["position"] = above(terrain, rng.uniform(0.0, 200.0, (many, 2)), rng.uniform(0.0, 3.0, many))
    state["velocity"] = rng.normal(0.0, 20.0, (many, 3))
    simulator.set_state(state)
    for _ in range(5):
        before = simulator.state()
        away = rng.normal(0.0, 1.0, (many, 3))
        away *= rng.uniform(0.0, 10.0, (many, 1)) / np.linalg.norm(away, axis=1, keepdims=True)
        points = before["position"] + away
        simulator.explode(points)
        players = [player_of(row) for row in before]
        for player, (x, y, z) in zip(players, points.tolist(), strict=True):
            explode(player, ARMORS["light"], (x, y, z), ground)
        after = simulator.state()
        # A point at the cover's edge may fall on either side.
        for name, within in (("velocity", 2e-4), ("damage", 2e-6)):
            own = np.array([getattr(player, name) for player in players])
            wrong = np.abs(after[name] - own).reshape(many, -1).max(axis=1) > within
            assert wrong.sum() <= 1
        assert (after["damage"] > before["damage"]).sum() > 20


def test_disc_jump_table() -> None:
    """Section 10's apexes, by the simulator alone: an explosion below, n ticks after the jump."""
    delays = [None, 1, 2, 3, 4, 5, 6, 7, 8, 0]
    flat = discjump.Terrain.from_heights(np.zeros((9, 9)))
    pair = Pair(flat, len(delays), scene="disc_jump", jump_age=0)
    apex = np.zeros(len(delays))
    for k in range(120):
        points = pair.own("position") * [1.0, 1.0, 0.0]
        points[[k != (delay or 0) for delay in delays]] = np.nan
        pair.explode(points)
        inputs = pair.inputs()
        inputs["jump"] = [k == 0 and delay is not None for delay in delays]
        pair.step(inputs)
        apex = np.maximum(apex, pair.simulator.state()["position"][:, 2])
    assert apex == pytest.approx([6.6, 19.2, 23.2, 27.1, 30.0, 24.8, 21.2, 18.6, 16.6, 15.2], abs=0.051)


def test_projectiles_and_blasts() -> None:
    """What is in flight, and what burst in the last tick; discs shot upwards vanish in their 204th."""
    terrain = rolling(33, 33)
    many = 12
    pair = Pair(terrain, many, scene="disc_jump", position=above(terrain, np.full((many, 2), 40.0), 1.0))
    pitch = np.linspace(-1.2, 1.0, many)
    for _ in range(230):
        pair.step(rows([HELD[0]] * many, fire=True, pitch=pitch))
        own = [disc for world in pair.worlds for disc in world.shooter.discs]  # the oldest first
        flying = pair.simulator.projectiles()
        assert len(flying) == len(own)
        flying = flying[np.lexsort((-flying["age"], flying["player"]))]
        for name in ("position", "velocity"):
            expected = np.array([getattr(disc, name) for disc in own]).reshape(-1, 3)
            np.testing.assert_allclose(flying[name], expected, rtol=0.0, atol=1e-6)
        blasts = pair.simulator.blasts()
        expected = np.array([point for burst in pair.last_bursts for point in burst]).reshape(-1, 3)
        np.testing.assert_allclose(blasts["position"], expected, rtol=0.0, atol=1e-6)
