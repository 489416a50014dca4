"""Bad input is refused with an exception that names the argument, and changes nothing."""

from typing import Any

import gymnasium
import numpy as np
import pytest

import discjump
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.envs.options import SkiOptions

from .play import SHORT, random_actions, same_bits

HERE = discjump.Terrain.raindance(0)

OPTIONS = [
    ({"fidelity": "exact"}, ValueError, "fidelity"),
    ({"fidelity": 3}, TypeError, "fidelity"),
    ({"armor": "feather"}, ValueError, "armor"),
    ({"armor": 3}, TypeError, "armor"),
    ({"energy_pack": 1}, TypeError, "energy_pack"),
    ({"physics": {"ski_bug": True}}, TypeError, "physics"),
    ({"physics": None}, TypeError, "physics"),
    ({"tick_ms": 0}, ValueError, "tick_ms"),
    ({"tick_ms": 32.0}, TypeError, "tick_ms"),
    ({"frame_skip": 0}, ValueError, "frame_skip"),
    ({"frame_skip": True}, TypeError, "frame_skip"),
    ({"actions": "discrete"}, ValueError, "actions"),
    ({"turn_rate": 0}, ValueError, "turn_rate"),
    ({"turn_rate": float("inf")}, ValueError, "turn_rate"),
    ({"time_limit": 0.0}, ValueError, "time_limit"),
    ({"time_limit": float("nan")}, ValueError, "time_limit"),
    ({"time_limit": "60"}, TypeError, "time_limit"),
    ({"arrival_radius": -8.0}, ValueError, "arrival_radius"),
    ({"goal_distance": (800.0, 300.0)}, ValueError, "goal_distance"),
    ({"goal_distance": (300.0,)}, ValueError, "goal_distance"),
    ({"goal_distance": 300.0}, TypeError, "goal_distance"),
    ({"goal_distance": (300.0, 1.1e6)}, ValueError, r"goal_distance\[1\]"),
    ({"start_speed": -1.0}, ValueError, "start_speed"),
    ({"reward": {"progres": 1.0}}, ValueError, "did you mean 'progress'"),
    ({"reward": {"time": float("nan")}}, ValueError, "time"),
    ({"reward": [1.0]}, TypeError, "reward"),
    ({"fan_bearings": [0.0, 200.0]}, ValueError, r"fan_bearings\[1\]"),
    ({"fan_bearings": [float("nan")]}, ValueError, r"fan_bearings\[0\]"),
    ({"fan_ranges": [-5.0]}, ValueError, r"fan_ranges\[0\]"),
    ({"fan_ranges": 5.0}, TypeError, "fan_ranges"),
    ({"fan_ranges": np.zeros((2, 2))}, ValueError, "fan_ranges"),
    ({"landing": "yes"}, TypeError, "landing"),
    ({"terrain_seeds": []}, ValueError, "terrain_seeds"),
    ({"terrain_seeds": 3}, TypeError, "terrain_seeds"),
    ({"terrain_seeds": [0, -1]}, ValueError, r"terrain_seeds\[1\]"),
    ({"terrain_seeds": [0, 1.5]}, TypeError, r"terrain_seeds\[1\]"),
    ({"terrain_seeds": [2, 2]}, ValueError, "2 more than once"),
    ({"terrain_seeds": [2**64]}, ValueError, "terrain_seeds"),
    ({"repeating": None}, TypeError, "repeating"),
    ({"surface": "cubic"}, ValueError, "surface: expected one of 'triangles', 'bilinear', got 'cubic'"),
    ({"surface": True}, TypeError, "surface"),
    ({"terrains": []}, ValueError, "terrains"),
    ({"terrains": HERE}, TypeError, "terrains"),
    ({"terrains": [HERE, "raindance"]}, TypeError, r"terrains\[1\]"),
    ({"frameskip": 4}, TypeError, "did you mean 'frame_skip'"),
    ({"render_mode": "ansi"}, ValueError, "render_mode"),
]


@pytest.mark.parametrize(("options", "kind", "message"), OPTIONS, ids=[str(case[0])[:50] for case in OPTIONS])
@pytest.mark.parametrize("make", [SkiEnv, SkiVectorEnv])
def test_options(make, options, kind, message):
    with pytest.raises(kind, match=message):
        make(**options)


@pytest.mark.parametrize(
    ("options", "kind", "message"),
    [
        ({"num_envs": 0}, ValueError, "num_envs"),
        ({"num_envs": -1}, ValueError, "num_envs"),
        ({"num_envs": 2.0}, TypeError, "num_envs"),
        ({"threads": 0}, ValueError, "threads"),
        ({"threads": 257}, ValueError, "threads: expected an integer from 1 to 256"),
        ({"threads": "two"}, TypeError, "threads"),
        ({"autoreset_mode": "Never"}, ValueError, "autoreset_mode"),
    ],
)
def test_options_of_the_vector(options, kind, message):
    with pytest.raises(kind, match=message):
        gymnasium.make_vec("discjump/Ski-v0", **({"num_envs": 2} | options))


@pytest.mark.parametrize("name", ["scene", "armor", "fidelity", "energy_pack"])
def test_choices_of_the_simulator(name):
    """Caught: armor=3 said "'int' object is not an instance of 'str'", of which argument only in a note."""
    wrong: dict[str, Any] = {name: 3}
    with pytest.raises(TypeError, match=name):
        discjump.Simulator(HERE, **wrong)


def test_unknown_option_through_gymnasium():
    with pytest.raises(TypeError, match="frameskip"):
        gymnasium.make("discjump/Ski-v0", frameskip=2)


GOOD = np.tile([2, 1, 0, 0, 3], (3, 1))

ACTIONS = [
    (GOOD[:2], ValueError),
    (GOOD[:, :4], ValueError),
    (GOOD[0], ValueError),
    (GOOD[np.newaxis], ValueError),
    (GOOD.astype(np.float64), (TypeError, ValueError)),
    (GOOD.astype(np.float32), (TypeError, ValueError)),
    (GOOD.astype(str), TypeError),
    (GOOD > 0, TypeError),
    (GOOD - 3, ValueError),
    (GOOD + np.array([0, 0, 0, 0, 4]), ValueError),
    (GOOD + np.array([0, 0, 2, 0, 0]), ValueError),
    (np.full((3, 5), np.nan), (TypeError, ValueError)),
    (np.full((3, 5), 2**40), ValueError),
]


@pytest.mark.parametrize(("actions", "kind"), ACTIONS)
def test_actions(actions, kind):
    envs = SkiVectorEnv(3, **SHORT)
    envs.reset(seed=0)
    before = envs._task.batch.digest()
    with pytest.raises(kind, match="action"):
        envs.step(actions)
    assert envs._task.batch.digest() == before
    calm = SkiVectorEnv(3, **SHORT)
    calm.reset(seed=0)
    same_bits(envs.step(GOOD), calm.step(GOOD))


@pytest.mark.parametrize(
    "value", [np.nan, np.inf, -np.inf, 1.0000001, -2.0], ids=["nan", "inf", "-inf", "above 1", "below -1"]
)
def test_box_actions(value):
    envs = SkiVectorEnv(3, actions="box", **SHORT)
    envs.reset(seed=0)
    before = envs._task.batch.digest()
    actions = np.zeros((3, 5), np.float32)
    actions[2, 4] = value
    with pytest.raises(ValueError, match="action"):
        envs.step(actions)
    with pytest.raises((TypeError, ValueError), match="action"):
        envs.step(np.zeros((3, 5)))
    assert envs._task.batch.digest() == before


@pytest.mark.parametrize("action", [[2, 1, 0, 0], [2, 1, 0, 0, 7], [2.5, 1, 0, 0, 3], None, "jump", 3])
def test_action_of_one_environment(action):
    env = SkiEnv(**SHORT)
    env.reset(seed=0)
    before = env._task.batch.digest()
    with pytest.raises((TypeError, ValueError), match="action"):
        env.step(action)
    assert env._task.batch.digest() == before


SEEDS = [
    (-1, ValueError),
    (2**64, ValueError),
    (1.5, TypeError),
    ("1", TypeError),
    (True, TypeError),
]


@pytest.mark.parametrize(("seed", "kind"), SEEDS)
def test_seeds(seed, kind):
    env, envs = SkiEnv(**SHORT), SkiVectorEnv(2, **SHORT)
    for one in (env, envs):
        one.reset(seed=0)
        before = one._task.batch.digest(), one.np_random.bit_generator.state
        with pytest.raises(kind, match="seed"):
            one.reset(seed=seed)
        assert (one._task.batch.digest(), one.np_random.bit_generator.state) == before
    with pytest.raises(kind, match=r"seed\[1\]"):
        envs.reset(seed=[0, seed])


def test_seeds_of_another_number():
    envs = SkiVectorEnv(2, **SHORT)
    with pytest.raises(ValueError, match="expected 2 seeds"):
        envs.reset(seed=[1, 2, 3])
    with pytest.raises(ValueError, match="seed"):
        envs.reset(seed=2**64 - 1)


PLACES = [
    ({"start": (1.0,)}, ValueError, "start"),
    ({"start": (1.0, float("nan"))}, ValueError, "start"),
    ({"start": (1.0, float("inf"))}, ValueError, "start"),
    ({"start": "here"}, TypeError, "start"),
    ({"start": [[1.0], [2.0, 3.0]]}, ValueError, "start"),
    ({"goal": (1.0, 2.0, 3.0)}, ValueError, "goal"),
    ({"goal": (float("nan"), float("nan"))}, ValueError, "goal"),
    ({"terrain_seed": 77}, ValueError, "pool's seeds 0, 1"),
    ({"terrain_seed": 1.0}, TypeError, "terrain_seed"),
    ({"terrain_seed": -1}, ValueError, "terrain_seed"),
    ({"gaol": (1.0, 2.0)}, ValueError, "did you mean 'goal'"),
    ([1], TypeError, "options"),
]


@pytest.mark.parametrize(("options", "kind", "message"), PLACES, ids=[str(case[0]) for case in PLACES])
@pytest.mark.parametrize("make", [SkiEnv, lambda **options: SkiVectorEnv(2, **options)], ids=["one", "many"])
def test_reset_options(make, options, kind, message):
    env = make(**SHORT)
    env.reset(seed=0)
    before = env._task.batch.digest()
    with pytest.raises(kind, match=message):
        env.reset(seed=5, options=options)
    assert env._task.batch.digest() == before


@pytest.mark.parametrize(
    ("options", "kind"),
    [
        ({"start": np.zeros((3, 2))}, ValueError),
        ({"start": [[0.0, 0.0], [0.0, np.nan]]}, ValueError),
        ({"terrain_seed": [0, 1, 0]}, ValueError),
        ({"terrain_seed": [0, 5]}, ValueError),
        ({"reset_mask": [True, False]}, TypeError),
        ({"reset_mask": np.array([1, 0])}, TypeError),
        ({"reset_mask": np.array([True])}, ValueError),
        ({"reset_mask": np.array([False, False])}, ValueError),
    ],
)
def test_reset_options_of_the_vector(options, kind):
    envs = SkiVectorEnv(2, **SHORT)
    envs.reset(seed=0)
    before = envs._task.batch.digest()
    with pytest.raises(kind, match=next(iter(options))):
        envs.reset(seed=5, options=options)
    assert envs._task.batch.digest() == before


def test_masked_reset_with_mixed_seeds_is_all_or_nothing():
    flat = discjump.Terrain.from_heights(np.zeros((33, 33)), edge="void")
    envs = SkiVectorEnv(2, terrains=[flat], goal_distance=(20.0, 60.0))
    envs.reset(seed=0)
    before = envs._task.batch.digest()
    # Environment 0 could begin there, environment 1 (next episode of its seed) has no ground under it.
    starts = np.array([[10.0, 10.0], [-1e4, 10.0]])
    with pytest.raises(ValueError, match="start"):
        envs.reset(seed=[7, None], options={"start": starts})
    assert envs._task.batch.digest() == before


def batch(num_envs=3, **options):
    made = SkiOptions.from_keywords(SHORT | options).batch(num_envs, "next_step", 1)
    made.reset(np.arange(num_envs, dtype=np.uint64))
    return made


def test_snapshot_brings_everything_back():
    one = batch()
    actions = random_actions(0, 60, 3)
    for action in actions[:30]:
        one.step(action)
    snapshot, digest = one.snapshot(), one.digest()
    tail = [one.step(action)[0] for action in actions[30:]]
    assert one.digest() != digest
    one.restore(snapshot)
    assert one.digest() == digest
    for action, observation in zip(actions[30:], tail, strict=True):
        same_bits(one.step(action)[0], observation)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda snapshot: snapshot[:-1],
        lambda snapshot: snapshot[:40],
        lambda snapshot: b"",
        lambda snapshot: snapshot + b"x",
        lambda snapshot: b"x" + snapshot[1:],
        lambda snapshot: snapshot[:100] + bytes([snapshot[100] ^ 1]) + snapshot[101:],
        lambda _: batch(4).snapshot(),
        lambda _: batch(terrain_seeds=[0]).snapshot(),
        lambda _: batch(fidelity="reference").snapshot(),
        lambda _: batch(frame_skip=3).snapshot(),
    ],
    ids=["cut", "header only", "empty", "longer", "magic", "bit", "count", "terrains", "fidelity", "task"],
)
def test_snapshots(spoil):
    one = batch()
    before = one.digest()
    with pytest.raises(ValueError, match="snapshot"):
        one.restore(spoil(batch().snapshot()))
    assert one.digest() == before


def test_batch_refuses_what_the_environments_never_pass():
    options = SkiOptions(terrains=[HERE])
    with pytest.raises(ValueError, match="autoreset"):
        options.batch(1, "sometimes", 1)
    one = options.batch(2, "next_step", 1)
    two = np.arange(2, dtype=np.uint64)
    with pytest.raises(ValueError, match="seed"):
        one.reset()
    with pytest.raises(ValueError, match="reset"):
        one.step(np.tile([1, 1, 0, 0, 3], (2, 1)))
    with pytest.raises(ValueError, match="seeds"):
        one.reset(np.arange(3, dtype=np.uint64))
    with pytest.raises(ValueError, match="mask"):
        one.reset(two, np.ones(3, np.bool_))
    with pytest.raises(ValueError, match="terrain"):
        one.reset(two, terrain=np.array([0, 9]))
    with pytest.raises(ValueError, match="start"):
        one.reset(two, start=np.zeros((3, 2)))
    with pytest.raises(ValueError, match="goal"):
        one.reset(two, goal=np.full((2, 2), np.inf))
