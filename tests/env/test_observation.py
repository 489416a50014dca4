"""Every number of an observation, recomputed with numpy from the state and from queries of the terrain."""

import numpy as np
import pytest

import discjump
from discjump.envs.named import SkiVectorEnv

TOLERANCE = 2e-4  # float32 positions of hundreds of metres, and heights under them


@pytest.fixture(scope="module")
def seen():
    """A batch in mid-flight: observations by name in units, states, beacons, and the terrain."""
    terrain = discjump.Terrain.raindance(3)
    envs = SkiVectorEnv(
        64, terrains=[terrain], fan_bearings=[0.0, 40.0, -90.0], fan_ranges=[5.0, 60.0], threads=1
    )
    envs.reset(seed=0)
    for actions in np.random.default_rng(0).integers(0, [3, 3, 2, 2, 7], (40, 64, 5)):
        observations, *_ = envs.step(actions)
    names = {f.name: observations[:, f.slice] * f.scale for f in envs.observation_layout}
    return names, envs.state(), envs.goals(), terrain


def yaw_frame(state, x, y):
    """(forward, right) parts of horizontal vectors: forward is (-sin yaw, cos yaw)."""
    sin, cos = np.sin(state["yaw"].astype(float)), np.cos(state["yaw"].astype(float))
    return np.stack([y * cos - x * sin, x * cos + y * sin], axis=1)


def close(a, b):
    np.testing.assert_allclose(a, b, atol=TOLERANCE, rtol=1e-4)


def test_motion(seen):
    names, state, _, _ = seen
    v = state["velocity"].astype(float)
    close(names["velocity"][:, :2], yaw_frame(state, v[:, 0], v[:, 1]))
    close(names["velocity"][:, 2], v[:, 2])
    close(names["speed"][:, 0], np.hypot(v[:, 0], v[:, 1]))


def test_beacon(seen):
    names, state, goals, _ = seen
    way = goals - state["position"]
    distance = np.hypot(way[:, 0], way[:, 1])
    close(names["beacon_distance"][:, 0], distance)
    close(names["beacon_nearness"][:, 0], 30.0 / (30.0 + distance))
    close(names["beacon_height"][:, 0], way[:, 2])
    unit = way[:, :2] / distance[:, None]
    close(names["beacon_direction"], yaw_frame(state, unit[:, 0], unit[:, 1]))
    v = state["velocity"].astype(float)
    close(names["closing_speed"][:, 0], (v[:, :2] * unit).sum(axis=1))
    # Positive to the right of the line to the beacon.
    close(names["lateral_speed"][:, 0], v[:, 0] * unit[:, 1] - v[:, 1] * unit[:, 0])


def test_ground(seen):
    names, state, _, terrain = seen
    position = state["position"]
    normal = terrain.normal(position[:, :2])
    height = position[:, 2] - terrain.height(position[:, :2])
    close(names["height"][:, 0], np.maximum(height, 0.0))
    close(names["height_bend"][:, 0], np.maximum(height, 0.0) / (np.maximum(height, 0.0) + 3.0))
    # A player at rest on an edge may read the neighbouring triangle.
    expected = yaw_frame(state, normal[:, 0], normal[:, 1])
    assert (np.abs(names["ground_normal"] - expected).max(axis=1) < TOLERANCE).mean() > 0.95


def test_body(seen):
    names, state, _, _ = seen
    close(names["energy"][:, 0], state["energy"])
    close(names["damage"][:, 0], state["damage"])
    assert (names["jetting"][:, 0] == state["jetting"]).all()
    close(names["jump_grace"][:, 0], np.maximum(256 - state["jump_age"], 0))


def test_fan(seen):
    names, state, _, terrain = seen
    position, yaw = state["position"], state["yaw"].astype(float)
    below = terrain.height(position[:, :2])
    column = 0
    for bearing in (0.0, 40.0, -90.0):
        angle = yaw + np.radians(bearing)
        for distance in (5.0, 60.0):
            there = position[:, :2] + distance * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
            close(names["fan"][:, column], (terrain.height(there) - below) / distance)
            column += 1
    assert column == names["fan"].shape[1]


def test_landing(seen):
    """The ballistic landing against a march along the parabola in steps of a millisecond."""
    names, state, _, terrain = seen
    position, velocity = state["position"], state["velocity"].astype(float)
    time = np.arange(0.0, 3.0, 0.001)
    agree = []
    for k in range(len(state)):
        path = position[k] + velocity[k] * time[:, None] + np.array([0.0, 0.0, -10.0]) * time[:, None] ** 2
        under = np.flatnonzero(path[1:, 2] < terrain.height(path[1:, :2]))
        first = time[under[0] + 1] if len(under) else 3.0
        agree.append(abs(names["landing_time"][k, 0] - first) < 0.05)
    # Looks 0.15 s apart may step over a crest, and a player on the ground lands at once.
    assert np.mean(agree) > 0.85


#: Jets of a light: thrust, m/s^2; its largest sideways share; energy used in a second less what comes back.
THRUST, SIDEWAYS, DRAIN = 236.0 / 9.0, 0.8, 25.0 - 8.0


@pytest.mark.parametrize("way", ["burst", "burn", "left", "right"])
def test_landings_under_jets(way):
    """Where jets lead, against a march in steps of a millisecond under section 4.2's thrust."""
    terrain = discjump.Terrain.raindance(3)
    envs = SkiVectorEnv(256, terrains=[terrain], jet_landings=True, fan_bearings=[], threads=1)
    envs.reset(seed=0)
    rng = np.random.default_rng(0)
    for _ in range(12):
        actions = rng.integers(0, [3, 3, 2, 2, 7], (256, 5))
        actions[:, 2:4] = 1
        observations, *_ = envs.step(actions)
    names = {f.name: observations[:, f.slice] * f.scale for f in envs.observation_layout}
    state = envs.state()
    agree = []
    for k in range(len(state)):
        place, velocity = state["position"][k], state["velocity"][k].astype(float)
        speed = np.hypot(*velocity[:2])
        left = np.array([-velocity[1], velocity[0]]) / max(speed, 1.0)
        seconds = min(0.5, state["energy"][k] / DRAIN) if way != "burn" else state["energy"][k] / DRAIN
        if way in ("left", "right"):
            side = left if way == "left" else -left
            thrust = THRUST * np.array([*(SIDEWAYS * side), 1.0 - SIDEWAYS])
        else:
            thrust = np.array([0.0, 0.0, THRUST])
        time = np.arange(0.0, 3.0, 0.001)
        pull = (time < seconds)[:, None] * thrust - np.array([0.0, 0.0, 20.0])
        moves = velocity + np.cumsum(pull, axis=0) * 0.001
        path = place + np.cumsum(moves, axis=0) * 0.001
        under = np.flatnonzero(path[:, 2] < terrain.height(path[:, :2]))
        at = under[0] if len(under) else -1
        normal = terrain.normal(path[[at], :2])[0]
        expected = {
            "time": time[at] if len(under) else 3.0,
            "impact": max(-moves[at] @ normal, 0.0) if len(under) else 0.0,
            "rise": terrain.height(path[[at], :2])[0] - place[2],
            "slope": -(normal[:2] @ moves[at, :2]) / normal[2] / max(np.hypot(*moves[at, :2]), 1.0),
        }
        off = {name: abs(names[f"{way}_{name}"][k, 0] - value) for name, value in expected.items()}
        agree.append([off["time"] < 0.05, off["impact"] < 1.5, off["rise"] < 1.5, off["slope"] < 0.1])
    # Looks 0.15 s apart may step over a crest, and between two of them the ground is not straight.
    assert (np.mean(agree, axis=0) > 0.85).all(), np.mean(agree, axis=0)


def test_over_nothing_an_agent_sees_the_lowest_height():
    """Beyond a void map's rim an agent sees level ground at the map's lowest height.

    The rim's own square used to be seen there: 86 m outside, the landing was 89 m up a slope that does not
    exist, and a fall past it could divide by zero.
    """
    heights = np.linspace(20.0, 100.0, 65 * 65).reshape(65, 65)
    terrain = discjump.Terrain.from_heights(heights, edge="void")
    envs = SkiVectorEnv(1, terrains=[terrain], arrival_radius=1.0, goal_distance=(50.0, 100.0))
    outside = {"start": np.array([600.0, 300.0, 130.0]), "goal": np.array([100.0, 100.0])}
    observation, _ = envs.reset(seed=0, options=outside)
    for _ in range(80):
        names = {f.name: observation[0, f.slice] * f.scale for f in envs.observation_layout}
        assert np.isfinite(observation).all()
        z = envs.state()["position"][0, 2]
        close(names["height"][0], min(max(z - 20.0, 0.0), 240.0))
        assert (names["ground_normal"] == 0.0).all()
        assert names["landing_slope"] == 0.0
        close(names["landing_rise"][0], np.clip(20.0 - z, -160.0, 160.0))
        observation, *_, truncated, _ = envs.step(np.array([[1, 1, 0, 0, 3]]))
        if truncated[0]:
            break


def test_nobody_is_put_where_a_tick_of_falling_is_lost_to_rounding():
    """At 1e8 m an f32 player hung in the air for ever, while his speed grew."""
    envs = SkiVectorEnv(1, terrain_seeds=[0])
    with pytest.raises(ValueError, match="100000 m of height 0"):
        envs.reset(seed=0, options={"start": np.array([0.0, 0.0, 1e8])})
