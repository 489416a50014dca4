"""One environment through gymnasium's API."""

import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

import discjump  # noqa: F401  (registers the ids)
from discjump.envs.named import SkiEnv

from .play import SHORT, random_actions, same_bits

ID = "discjump/Ski-v0"


@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
def test_gymnasium_accepts_it_without_a_warning(actions):
    env = gymnasium.make(ID, actions=actions, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)


@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
def test_stable_baselines3_accepts_it_without_a_warning(actions):
    env_checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = gymnasium.make(ID, actions=actions, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env_checker.check_env(env.unwrapped)


def test_id_works_without_importing_the_package():
    code = (
        "import gymnasium; env = gymnasium.make('discjump:discjump/Ski-v0', terrain_seeds=[0]);"
        "env.reset(seed=0); print(env.unwrapped.spec.id)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert run.stdout.strip() == ID, run.stderr


def test_spec_has_no_time_limit_of_its_own():
    spec = gymnasium.spec(ID)
    assert spec.max_episode_steps is None
    env = gymnasium.make(ID, terrain_seeds=[0])
    while isinstance(env, gymnasium.Wrapper):
        assert not isinstance(env, gymnasium.wrappers.TimeLimit)
        env = env.env


def test_spec_makes_the_same_environment_again():
    env = gymnasium.make(ID, terrain_seeds=[5], frame_skip=2)
    assert env.spec is not None
    again = gymnasium.make(env.spec)
    same_bits(env.reset(seed=3)[0], again.reset(seed=3)[0])


def test_layout_covers_the_observation_once():
    env = SkiEnv(terrain_seeds=[0])
    stop = 0
    names = []
    for name, part, unit, scale in env.observation_layout:
        assert part.start == stop
        assert part.stop > part.start
        assert isinstance(unit, str)
        assert scale > 0
        stop = part.stop
        names.append(name)
    assert (stop,) == env.observation_space.shape
    assert len(set(names)) == len(names)


def test_without_fan_and_landing_the_observation_is_smaller():
    whole = SkiEnv(terrain_seeds=[0])
    no_fan = SkiEnv(terrain_seeds=[0], fan_bearings=[], fan_ranges=[])
    bare = SkiEnv(terrain_seeds=[0], fan_bearings=[], fan_ranges=[], landing=False)
    small = SkiEnv(terrain_seeds=[0], fan_bearings=[0, 30.0], fan_ranges=np.array([10.0, 20.0, 40.0]))
    size = [env.observation_layout[-1].slice.stop for env in (bare, no_fan, small, whole)]
    assert size[0] < size[1] < size[2] < size[3]
    assert size[2] - size[1] == 6


def test_a_seed_decides_the_episode_and_those_after_it():
    one, other = SkiEnv(terrain_seeds=[0, 1]), SkiEnv(terrain_seeds=[0, 1])
    first = [one.reset(seed=9)[0], one.reset()[0], one.reset()[0]]
    for observation, seed in zip(first, (9, None, None), strict=True):
        same_bits(observation, other.reset(seed=seed)[0])
    assert len({observation.tobytes() for observation in first}) == 3


def test_without_a_seed_the_operating_system_gives_one():
    one, other = SkiEnv(terrain_seeds=[0]), SkiEnv(terrain_seeds=[0])
    assert one.reset()[0].tobytes() != other.reset()[0].tobytes()


@pytest.mark.parametrize("seed", [0, 2**63, 2**64 - 1, np.int64(7)])
def test_every_seed_of_64_bits_is_welcome(seed):
    env = SkiEnv(terrain_seeds=[0])
    same_bits(env.reset(seed=seed)[0], SkiEnv(terrain_seeds=[0]).reset(seed=int(seed))[0])


def test_options_put_the_episode_where_one_wants_it():
    env = SkiEnv(terrain_seeds=[3, 4])
    for terrain_seed in (3, 4, 3):
        _, info = env.reset(
            seed=1, options={"start": (10.0, 20.0), "goal": (310, 420), "terrain_seed": terrain_seed}
        )
        assert info["distance"] == pytest.approx(500.0, abs=1e-3)
        assert env.terrain.seed == terrain_seed
    _, info = env.reset(options={"start": (10.0, 20.0)})
    assert 300 <= info["distance"] <= 800


def test_goal_far_away_is_outside_the_mission_area():
    env = SkiEnv(terrain_seeds=[3])
    assert env.reset(seed=1)[1]["outside_mission_area"] is False
    assert env.reset(seed=1, options={"start": (1000.0, 1000.0)})[1]["outside_mission_area"] is True


def test_an_episode_runs_to_its_end_and_says_how():
    env = SkiEnv(**SHORT)
    beacon = next(field.slice for field in env.observation_layout if field.name == "beacon_direction")
    kinds = set()
    for seed in range(10):
        # Every other episode is short, and walks to its beacon.
        near = {"start": (0.0, 0.0), "goal": (15.0, 15.0)} if seed % 2 else None
        observation, _ = env.reset(seed=seed, options=near)
        rewards = []
        for action in random_actions(seed, 100, 1)[:, 0]:
            if near:
                action[:4] = [*(np.sign(np.round(observation[beacon], 1)) + 1), 1, 0]
                action[4] = 3
            observation, reward, terminated, truncated, info = env.step(action)
            rewards.append(reward)
            assert observation in env.observation_space
            assert not (terminated and truncated)
            if terminated or truncated:
                break
            assert set(info) == {"distance", "speed", "time", "outside_mission_area"}
        assert info["is_success"] + info["death"] + info["timeout"] == 1
        assert info["timeout"] is truncated
        assert info["length"] == len(rewards)
        assert info["return"] == pytest.approx(sum(rewards), rel=1e-12)
        assert info["mean_speed"] <= info["top_speed"]
        kinds.add((info["is_success"], info["timeout"]))
        with pytest.raises(ResetNeeded):
            env.step(np.array([1, 1, 0, 0, 3]))
    assert (True, False) in kinds
    assert (False, True) in kinds


def test_time_limit_is_exact_even_inside_a_decision():
    env = SkiEnv(terrain_seeds=[0], time_limit=0.32, frame_skip=4)  # 10 ticks: two decisions and a half
    env.reset(seed=0)
    ends = [env.step(np.array([1, 1, 0, 0, 3]))[3:] for _ in range(3)]
    assert [truncated for truncated, _ in ends] == [False, False, True]
    assert [info["time"] for _, info in ends] == [0.128, 0.256, 0.32]


def test_step_before_reset_is_refused():
    with pytest.raises(ResetNeeded):
        SkiEnv(terrain_seeds=[0]).step(np.array([1, 1, 0, 0, 3]))


def test_lists_are_actions_too():
    env, other = SkiEnv(terrain_seeds=[0]), SkiEnv(terrain_seeds=[0])
    env.reset(seed=1)
    other.reset(seed=1)
    same_bits(env.step([2, 1, 1, 0, 5])[0], other.step(np.array([2, 1, 1, 0, 5], np.int8))[0])


def test_frame_rate_is_that_of_the_decisions():
    assert SkiEnv(terrain_seeds=[0], frame_skip=2).metadata["render_fps"] == pytest.approx(1 / 0.064)
    assert SkiEnv.metadata["render_fps"] == pytest.approx(1 / 0.128)
