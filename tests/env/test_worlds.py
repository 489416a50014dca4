"""Worlds of several players, their launchers and explosions, and scenes, through Python."""

import dataclasses

import numpy as np
import pytest

import discjump
from discjump import SCENES, Physics, Simulator
from discjump.simulator import FIDELITIES, SIMULATOR_FIDELITIES

from .worlds import FLAT, everything, pair, put

FEATURES = {"jump", "jet", "energy", "landing_damage", "discs", "blast", "solids", "flags", "bump_limits"}
NONE = [np.nan] * 3


# Scenes.


def test_scenes_list_every_feature_once() -> None:
    assert set(SCENES) == {"ski", "sandbox", "disc_jump", "mission"}
    for name, scene in SCENES.items():
        assert scene.name == name
        assert set(scene.models) | set(scene.leaves_out) == FEATURES
        assert len(scene.models) + len(scene.leaves_out) == len(FEATURES)
        assert Simulator(FLAT, scene=name).scene is scene
        with pytest.raises(dataclasses.FrozenInstanceError):
            scene.name = "other"  # type: ignore[misc]


def test_what_a_scene_leaves_out_is_not_stored() -> None:
    sims = {name: Simulator(FLAT, scene=name) for name in SCENES}
    for name, sim in sims.items():
        models = SCENES[name].models
        fields = set(sim.state_dtype.names or ())
        for feature, field in [
            ("energy", "energy"),
            ("jet", "jetting"),
            ("landing_damage", "damage"),
            ("discs", "ammo"),
            ("discs", "cooldown"),
            ("bump_limits", "bump_limits"),
        ]:
            assert (field in fields) == (feature in models), f"{name}: {field}"
        assert sim.state().dtype == sim.state_dtype
    assert sims["ski"].player_bytes < sims["sandbox"].player_bytes < sims["disc_jump"].player_bytes
    assert sims["mission"].player_bytes == sims["disc_jump"].player_bytes
    # The trigger does nothing where there is none.
    trigger = sims["ski"].inputs()
    trigger["fire"] = True
    for name in ("ski", "sandbox"):
        sims[name].step(trigger, 60)
        assert len(sims[name].projectiles()) == len(sims[name].blasts()) == 0


@pytest.mark.parametrize("scene", [name for name, scene in SCENES.items() if "blast" in scene.leaves_out])
def test_a_scene_without_explosions_refuses_them(scene: str) -> None:
    sim = Simulator(FLAT, scene=scene)
    before = everything(sim)
    with pytest.raises(ValueError, match=f'explode: .*"{scene}"'):
        sim.explode([[0.0, 0.0, 0.0]])
    assert everything(sim) == before


# Several players.


@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_players_of_a_world_stand_in_each_others_way(fidelity: str) -> None:
    for per_world, apart in ((2, True), (1, False)):
        sim = pair(fidelity, players_per_world=per_world)
        put(sim, 0, position=(0.0, 0.0, 50.0), velocity=(40.0, 0.0, 0.0))
        put(sim, 1, position=(10.0, 0.0, 50.0), velocity=(-40.0, 0.0, 0.0))
        sim.step(sim.inputs(), 15)
        x = sim.state()["position"][:, 0]
        assert (x[1] - x[0] > 2.29) == apart
        assert (x[1] < x[0]) != apart


def test_fresh_players_of_a_world_are_out_of_each_others_way() -> None:
    sim = Simulator(FLAT, 512, players_per_world=256, threads=2)
    position = sim.state()["position"]
    assert (position[:256] == position[256:]).all()
    gaps = np.linalg.norm(position[:256, None] - position[None, :256], axis=-1)
    assert gaps[~np.eye(256, dtype=bool)].min() >= 4.0
    sim.step(sim.inputs(), 5)
    # 256 m are half a kilometre of a row: beyond the rim of this map it is the next tile's ground.
    assert np.isfinite(sim.state()["position"]).all()


@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_explosions_act_on_their_own_world(fidelity: str) -> None:
    sim = pair(fidelity, 6, players_per_world=3, scene="sandbox")
    for player in range(6):
        put(sim, player, position=(3.0 * (player % 3), 0.0, 0.0))
    sim.explode([NONE, [3.0, 0.0, 0.0], NONE, NONE, NONE, [np.nan, 0.0, 0.0]])
    state = sim.state()
    velocity = state["velocity"].astype(float)
    # d0 = 1.15 at the feet; beside it sqrt(9 + 1.15^2), by the tribes form for a light.
    powers = discjump.knockback([np.hypot(3.0, 1.15), 1.15, np.hypot(3.0, 1.15)])
    np.testing.assert_allclose(np.linalg.norm(velocity[:3], axis=1), 150.0 / 9.0 * powers, atol=1e-3)
    assert velocity[0, 0] < 0.0 < velocity[2, 0]
    assert (state["damage"][:3] > 0.3).all()
    assert (velocity[3:] == 0.0).all()
    assert (state["damage"][3:] == 0.0).all()
    assert len(sim.blasts()) == 0


def test_points_of_any_real_array() -> None:
    points = np.array([[0.0, 0.0, 0.0], [4.0, 1.0, 0.0]])
    wide = np.zeros((2, 6))
    wide[:, ::2] = points
    digests = set()
    for given in (points, points.tolist(), points.astype(np.float32), points.astype(int), wide[:, ::2],
                  np.asfortranarray(points)):  # fmt: skip
        sim = pair(players=2)
        sim.explode(given)
        digests.add(sim.digest())
    assert len(digests) == 1
    sim = pair(players=2)
    before = everything(sim)
    sim.explode([NONE, NONE])
    assert everything(sim) == before


# Launchers.


def test_ammo_and_the_cycle() -> None:
    sim = pair(ammo=3)
    put(sim, 0, position=(0.0, 0.0, 500.0))
    inputs = sim.inputs()
    inputs["fire"][0], inputs["pitch"] = True, 0.5
    shots = []
    for tick in range(56 * 4):
        before = sim.state()["ammo"][0]
        sim.step(inputs)
        after = sim.state()
        if after["ammo"][0] < before:
            shots.append(tick)
            assert after["cooldown"][0] == 56
            assert (sim.projectiles()["age"] == 1).sum() == 1
    assert shots == [0, 56, 112]
    assert sim.state()["ammo"].tolist() == [0, 3]
    put(sim, 0, ammo=1, cooldown=0)
    sim.step(inputs)
    assert sim.state()["ammo"][0] == 0
    none = pair(ammo=0)
    none.step(inputs, 60)
    assert len(none.projectiles()) == 0
    assert pair().state()["ammo"].tolist() == [15, 15]


@pytest.mark.parametrize(("weapon", "speed", "falls"), [("disc", 65.16, False), ("grenade", 54.8, True),
                                                        ("mortar", 74.2, True)])  # fmt: skip
def test_weapons(weapon: str, speed: float, falls: bool) -> None:
    sim = pair(weapon=weapon)
    put(sim, 0, position=(0.0, 0.0, 500.0))
    inputs = sim.inputs()
    inputs["fire"][0] = True
    sim.step(inputs)
    (shot,) = sim.projectiles()
    assert shot["player"] == 0
    assert shot["velocity"][1] == pytest.approx(speed, abs=0.05)
    assert (shot["velocity"][2] < 0.0) == falls
    assert shot["aim"].tolist() == [0.0, 1.0, 0.0]
    assert sim.projectiles().dtype.names == ("player", "position", "velocity", "aim", "age")
    assert sim.blasts().dtype.names == ("player", "position", "velocity", "normal", "age")
    assert sim.blasts().shape == (0,)


@pytest.mark.parametrize("fidelity", SIMULATOR_FIDELITIES)
def test_a_disc_bursts_on_another_player(fidelity: str) -> None:
    sim = pair(fidelity)
    put(sim, 0, position=(0.0, 0.0, 0.0))
    put(sim, 1, position=(0.2, 20.0, 0.0))
    inputs = sim.inputs()
    inputs["fire"][0] = True
    for _ in range(20):
        sim.step(inputs)
        if len(sim.blasts()):
            break
    (blast,) = sim.blasts()
    assert blast["player"] == 0
    assert blast["position"] == pytest.approx([0.2, 19.5, 1.5], abs=1e-3)
    assert blast["normal"].tolist() == [0.0, -1.0, 0.0]
    state = sim.state()
    assert state["damage"][1] == pytest.approx(0.5 * (1.0 - 1.0 / 7.5), abs=1e-6)
    assert state["velocity"][1, 1] > 5.0
    assert state["damage"][0] == 0.0
    # Told for the last tick only.
    sim.step(sim.inputs())
    assert len(sim.blasts()) == 0


def test_what_is_returned_is_a_copy() -> None:
    sim = pair()
    put(sim, 0, position=(0.0, 0.0, 90.0))
    inputs = sim.inputs()
    inputs["fire"] = True
    sim.step(inputs)
    before = everything(sim)
    for array in (sim.state(), sim.projectiles()):
        for name in array.dtype.names or ():
            array[name] = 1
    assert everything(sim) == before


def test_switches_are_frozen_and_take_effect() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        Physics().ski_bug = True  # type: ignore[misc]
    pushes = {}
    for form in ("tribes", "basic", "linear_boosted"):
        sim = Simulator(FLAT, physics=Physics(knockback=form), fidelity="reference")
        sim.explode(sim.state()["position"])
        pushes[form] = sim.state()["velocity"][0, 2]
        expected = 150.0 / 9.0 * discjump.knockback([1.15], form)[0]
        assert pushes[form] == pytest.approx(expected, rel=1e-12)
    assert len(set(pushes.values())) == 3
