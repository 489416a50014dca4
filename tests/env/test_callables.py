"""Observation and reward replaced in Python.

Contract: what a front end returns is the functions' results for what the plain environments give, bit for
bit, in every autoreset mode; one call each per step, whatever the number of environments; everything else is
as without them.
"""

import copy
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import discjump  # noqa: F401
from discjump.envs import named
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.envs.tasks import TASKS

from .play import SHORT, random_actions, same_bits

ID = "discjump/Ski-v0"
MODES = list(AutoresetMode)


def glance(observations):
    """Three numbers of each row."""
    return np.column_stack([observations["velocity"][:, 0], observations["speed"], observations["height"]])


def hurry(transition):
    """Speed gained, and the task's own reward; a bonus for whoever jets at an episode's end."""
    gained = transition.after["speed"] - transition.before["speed"]
    over = transition.terminated | transition.truncated
    return transition.rewards + 0.1 * gained + np.where(over, transition.actions[:, 3], 0)


def own(observations):
    """The task's own observation."""
    return observations.array


def make(num_envs=5, mode=AutoresetMode.NEXT_STEP, **more):
    options = SHORT | {"observation_fn": glance, "reward_fn": hurry} | more
    return SkiVectorEnv(num_envs, autoreset_mode=mode, **options)


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.value)
def test_same_bits_as_gymnasiums_own_vector_over_single_ones(mode):
    ours = make(mode=mode)
    one = {**SHORT, "observation_fn": glance, "reward_fn": hurry}
    theirs = SyncVectorEnv([lambda: SkiEnv(**one) for _ in range(5)], autoreset_mode=mode)
    same_bits(ours.reset(seed=11), theirs.reset(seed=11), "reset")
    ends = 0
    for t, action in enumerate(random_actions(1, 100, 5)):
        mine, yours = ours.step(action), theirs.step(action)
        same_bits(mine, yours, f"step {t}")
        over = mine[2] | mine[3]
        ends += over.sum()
        if mode is AutoresetMode.DISABLED and over.any():
            mask = {"reset_mask": over}
            same_bits(ours.reset(options=mask), theirs.reset(options=copy.deepcopy(mask)), f"reset {t}")
    assert ends > 8


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP], ids=lambda m: m.value)
def test_what_the_functions_make_of_the_plain_environments(name, mode):
    task, num = TASKS[name], 6
    calls = {"observed": 0, "rewarded": 0}

    def observed(observations):
        calls["observed"] += 1
        return observations.array[:, :4] * 2

    def rewarded(transition):
        calls["rewarded"] += 1
        # A potential of the speed: what is seen before and after is that of one episode.
        return transition.after["speed"] - transition.before["speed"] + transition.rewards

    options = {"terrain_seeds": [0], "time_limit": 1.5, "autoreset_mode": mode}
    plain = gymnasium.make_vec(task.id, num_envs=num, **options)
    envs: Any = gymnasium.make_vec(
        task.id, num_envs=num, observation_fn=observed, reward_fn=rewarded, **options
    )
    assert envs.single_observation_space.shape == (4,)
    field = next(one for one in envs.unwrapped.observation_layout if one.name == "speed")
    speed = lambda rows: rows[:, field.slice.start] * np.float32(field.scale)  # noqa: E731
    seen, info = plain.reset(seed=3)
    same_bits(envs.reset(seed=3), (seen[:, :4] * 2, info))
    sums, over, ends, finals = np.zeros(num), np.zeros(num, bool), 0, 0
    envs.action_space.seed(0)
    calls.update(observed=0, rewarded=0)
    for t in range(60):
        actions = envs.action_space.sample()
        got, expected = envs.step(actions), plain.step(actions)
        after = expected[0].copy()
        ended = expected[2] | expected[3]
        if mode is AutoresetMode.SAME_STEP:
            finals += ended.any()
            for env in np.flatnonzero(ended):
                after[env] = expected[4]["final_obs"][env]
                same_bits(got[4]["final_obs"][env], after[env, :4] * 2)
        rewards = np.where(over, 0.0, speed(after) - speed(seen) + expected[1])
        same_bits(got[0], expected[0][:, :4] * 2, f"observations {t}")
        same_bits(got[1], rewards, f"rewards {t}")
        same_bits(got[2:4], expected[2:4], f"flags {t}")
        sums = np.where(over, 0.0, sums) + rewards
        if ended.any():
            same_step = mode is AutoresetMode.SAME_STEP
            mine, yours = (step[4]["final_info"] if same_step else step[4] for step in (got, expected))
            same_bits(mine["return"], np.where(ended, sums, 0))
            same_bits(mine["native_return"], yours["return"])
            changed = ("return", "native_return", "_native_return")
            rest = [{k: v for k, v in one.items() if k not in changed} for one in (mine, yours)]
            same_bits(rest[0], rest[1])
        if mode is AutoresetMode.SAME_STEP:
            sums[ended] = 0
        else:
            over = ended
        seen, ends = expected[0], ends + ended.sum()
    assert ends >= 2 * num
    assert calls["rewarded"] == 60
    # At a step once, and once more for the last observations of those that ended.
    assert calls["observed"] == 60 + finals


def test_stable_baselines3_sees_the_same():
    sb3 = pytest.importorskip("discjump.sb3")
    envs = sb3.make_vec_env(ID, n_envs=5, seed=11, observation_fn=glance, reward_fn=hurry, **SHORT)
    other = make(mode=AutoresetMode.SAME_STEP)
    same_bits(envs.reset(), other.reset(seed=11)[0])
    ends = 0
    for action in random_actions(1, 60, 5):
        observations, rewards, dones, infos = envs.step(action)
        step = other.step(action)
        same_bits(observations, step[0])
        same_bits(rewards, step[1].astype(np.float32))
        same_bits(dones, step[2] | step[3])
        for env in np.flatnonzero(dones):
            same_bits(infos[env]["terminal_observation"], step[4]["final_obs"][env])
            last = step[4]["final_info"]
            assert infos[env]["episode"]["r"] == infos[env]["return"] == last["return"][env]
            assert infos[env]["native_return"] == last["native_return"][env]
        ends += dones.sum()
    assert ends > 3


def test_identity_changes_nothing():
    envs, plain = make(observation_fn=own, reward_fn=None), SkiVectorEnv(5, **SHORT)
    same_bits(envs.reset(seed=4), plain.reset(seed=4))
    for action in random_actions(2, 60, 5):
        step = envs.step(action)
        same_bits(step, plain.step(action))
        step[0][:] = 0.0


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.value)
def test_copies_and_snapshots_go_on_with_the_same_bits(mode):
    envs = make(4, mode)
    envs.reset(seed=2)
    actions = random_actions(3, 120, 4)

    def played(env, rows):
        seen = []
        for action in rows:
            step = env.step(action)
            seen += [step]
            if mode is AutoresetMode.DISABLED and (step[2] | step[3]).any():
                seen.append(env.reset(options={"reset_mask": step[2] | step[3]}))
        return tuple(seen)

    played(envs, actions[:20])
    snapshot, single = envs.snapshot(), envs.snapshot(2)
    copies = [copy.deepcopy(envs), pickle.loads(pickle.dumps(envs))]
    expected = played(envs, actions[20:90])
    for other in copies:
        same_bits(played(other, actions[20:90]), expected)
    other = make(4, mode)
    other.restore(snapshot)
    same_bits(played(other, actions[20:90]), expected)
    # One of them moves to another index, sum of rewards and all.
    if mode is AutoresetMode.NEXT_STEP:
        alone = make(1, mode)
        alone.restore(single, 0)
        for got, want in zip(played(alone, actions[20:90, 2:3]), expected, strict=True):
            same_bits(got[0][0], want[0][2])
            same_bits(got[1][0], want[1][2])
            if "return" in got[4]:
                assert got[4]["return"][0] == want[4]["return"][2]


def test_snapshots_go_both_ways_and_damage_is_seen():
    envs, plain = make(2), SkiVectorEnv(2, **SHORT)
    envs.reset(seed=0)
    envs.step(random_actions(0, 1, 2)[0])
    snapshot = envs.snapshot()
    plain.restore(snapshot)
    assert plain._task.batch.digest() == envs._task.batch.digest()
    envs.restore(plain.snapshot())
    assert (envs._task._replaced.returns == 0).all()
    bad = bytearray(snapshot)
    bad[-20] ^= 1
    before = envs.snapshot()
    with pytest.raises(ValueError, match=r"^snapshot: expected what snapshot\(\) returned, got damaged"):
        envs.restore(bytes(bad))
    with pytest.raises(ValueError, match="snapshot"):
        make(3).restore(snapshot)
    assert envs.snapshot() == before


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"observation_fn": 3}, TypeError, "observation_fn: expected a callable, got 3 of type int"),
        ({"reward_fn": "speed"}, TypeError, "reward_fn: expected a callable, got 'speed' of type str"),
        (
            {"observation_fn": lambda o: None},
            TypeError,
            "observation_fn: expected an array of float32, got None of type NoneType",
        ),
        ({"observation_fn": lambda o: o}, TypeError, "observation_fn: expected an array of float32, got"),
        (
            {"observation_fn": lambda o: o.array[0]},
            ValueError,
            r"observation_fn: .*shape \(2, k\).*, got shape",
        ),
        ({"observation_fn": lambda o: o["speed"]}, ValueError, r"observation_fn: .*got shape \(2,\)"),
        (
            {"observation_fn": lambda o: [[1.0], [1.0, 2.0]]},
            ValueError,
            "observation_fn: .*got something ragged",
        ),
        (
            {"observation_fn": lambda o: o.array * 1j},
            TypeError,
            "observation_fn: .*got complex64",
        ),
        ({"observation_fn": lambda o: o["sped"]}, KeyError, "got 'sped'; did you mean 'speed'"),
        (
            {"reward_fn": lambda t: t.rewards[:, None]},
            ValueError,
            r"reward_fn: expected shape \(2,\), got shape \(2, 1\)",
        ),
        ({"reward_fn": lambda t: 1.0}, ValueError, r"reward_fn: expected shape \(2,\), got shape \(\)"),
        (
            {"reward_fn": lambda t: ["a", "b"]},
            TypeError,
            "reward_fn: expected an array of float64, got .* of type list",
        ),
        (
            {"observation_space": spaces.Box(-1, 1, (3,))},
            TypeError,
            "observation_space: expected an observation_fn",
        ),
        (
            {"observation_fn": own, "observation_space": spaces.Discrete(3)},
            TypeError,
            "observation_space: expected a gymnasium.spaces.Box of one environment, got Discrete",
        ),
        (
            {"observation_fn": own, "observation_space": spaces.Box(-1, 1, (3,))},
            ValueError,
            r"observation_fn: expected an array of shape \(2, 3\), got shape \(2, ",
        ),
        (
            {"observation_fn": own, "observation_space": spaces.Box(0, 255, (3,), np.uint8)},
            TypeError,
            "observation_fn: expected an array of uint8, got float32",
        ),
    ],
)
def test_what_does_not_fit_is_refused_when_made(given, error, words):
    with pytest.raises(error, match=words):
        gymnasium.make_vec(ID, num_envs=2, terrain_seeds=[0], **given)


class Failing:
    """A function that fails in one call, and returns something else in another."""

    def __init__(self, wrong):
        self.wrong, self.now = wrong, False

    def __call__(self, seen):
        good = seen.rewards if hasattr(seen, "rewards") else seen.array
        return self.wrong(good) if self.now else good


def raising(_):
    raise ZeroDivisionError("mine")


@pytest.mark.parametrize("which", ["observation_fn", "reward_fn"])
@pytest.mark.parametrize(
    ("wrong", "error", "words"),
    [
        (raising, ZeroDivisionError, "mine"),
        (
            lambda a: a * np.nan,
            ValueError,
            r"expected finite numbers, got others in 2 rows \(the first is 0\)",
        ),
        (lambda a: a[:1], ValueError, "expected .*shape"),
    ],
    ids=["raises", "nan", "shape"],
)
def test_what_fails_later_stops_the_environments_until_a_reset(which, wrong, error, words):
    function = Failing(wrong)
    given: dict[str, Any] = {which: function}
    envs = SkiVectorEnv(2, **SHORT, **given)
    envs.reset(seed=0)
    action = random_actions(0, 1, 2)[0]
    before = envs.snapshot()
    envs.step(action)
    function.now = True
    with pytest.raises(error, match=words):
        envs.step(action)
    function.now = False
    for call in (lambda: envs.step(action), envs.snapshot):
        with pytest.raises(ResetNeeded, match="observation_fn or reward_fn failed"):
            call()
    envs.restore(before)
    first = envs.step(action)
    function.now = True
    with pytest.raises(error, match=words):
        envs.step(action)
    function.now = False
    envs.reset(seed=0)
    assert envs.snapshot() == before
    same_bits(envs.step(action), first)


def test_a_mask_of_all_is_a_reset_of_all():
    function = Failing(raising)
    envs = make(2, AutoresetMode.DISABLED, observation_fn=function)
    envs.reset(seed=0)
    function.now = True
    with pytest.raises(ZeroDivisionError):
        envs.step(random_actions(0, 1, 2)[0])
    function.now = False
    envs.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(ResetNeeded):
        envs.step(random_actions(0, 1, 2)[0])
    envs.reset(options={"reset_mask": np.array([True, True])})
    envs.step(random_actions(0, 1, 2)[0])


def test_functions_cannot_write_into_what_they_see():
    def meddling(transition):
        transition.after.array[:] = 0
        return transition.rewards

    with pytest.raises(ValueError, match="read-only"):
        make(2, reward_fn=meddling)


def test_a_declared_space_is_the_environments():
    space = spaces.Box(-500, 500, (3,), np.float64)
    env = SkiEnv(observation_fn=glance, observation_space=space, **SHORT)
    assert env.observation_space == space
    observation, _ = env.reset(seed=0)
    assert observation in space


@pytest.mark.parametrize("vector", [False, True])
def test_replays_hold_the_tasks_own(vector):
    from discjump.replays import record

    given = {"observation_fn": glance, "reward_fn": hurry}

    def replays(**more):
        make: Any = gymnasium.make_vec if vector else gymnasium.make
        env = record(make(ID, **SHORT, **more, **({"num_envs": 2} if vector else {})))
        env.reset(seed=5)
        for action in random_actions(1, 70, 2):
            _, _, terminated, truncated, _ = env.step(action if vector else action[0])
            if not vector and (terminated or truncated):
                break
        return env.replays

    made, plain = replays(**given), replays()
    assert len(made) == len(plain) > 0
    for one, other in zip(made, plain, strict=True):
        same_bits(dict(one.arrays), dict(other.arrays))
        assert one.outcome == other.outcome
        assert one.verify() is None


@pytest.mark.parametrize("name", TASKS)
def test_every_front_end_of_every_task_takes_them(name):
    task = TASKS[name]
    one = getattr(named, task.classes[0])(terrain_seeds=[0], observation_fn=glance, reward_fn=hurry)
    assert one.reset(seed=0)[0].shape == (3,)
    observation, reward, *_ = one.step(one.action_space.sample())
    assert observation in one.observation_space
    assert type(reward) is float
