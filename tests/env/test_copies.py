"""Snapshots, copies and pickles.

Contract: each goes on with the bits of the original: in the middle of an episode, in another process, with
other threads and lanes, one environment moved among others.
"""

import copy
import pickle
import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import discjump
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.sb3 import SharedInfos, make_vec_env

from .play import SHORT, random_actions, same_bits

WAYS = {"deepcopy": copy.deepcopy, "pickle": lambda one: pickle.loads(pickle.dumps(one))}
TIERS = ("authentic", "reference", "swept", "fast", "engine")


@pytest.fixture(params=WAYS)
def again(request):
    return WAYS[request.param]


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_copies_of_many_environments_go_on_alike(again, mode):
    envs = gymnasium.make_vec("discjump/Ski-v0", num_envs=9, threads=1, autoreset_mode=mode, **SHORT)
    envs.reset(seed=0)
    ends = 0
    for step, action in enumerate(random_actions(0, 80, 9)):
        copied = again(envs)
        result = envs.step(action)
        same_bits(copied.step(action), result, f"step {step}")
        over = result[2] | result[3]
        ends += over.sum()
        if mode is AutoresetMode.DISABLED and over.any():
            # That a reset must come first is copied as well.
            copied = again(envs)
            with pytest.raises(gymnasium.error.ResetNeeded):
                copied.step(action)
            masked = {"reset_mask": over}
            same_bits(copied.reset(options=masked), envs.reset(options=masked))
    assert ends > 5


def test_copies_of_one_environment_go_on_alike(again):
    env = gymnasium.make("discjump/Ski-v0", render_mode="rgb_array", **SHORT)
    env.reset(seed=3)
    for action in random_actions(1, 20, 1)[:, 0]:
        other = again(env)
        same_bits(other.render(), env.render())
        same_bits(other.step(action), env.step(action))
    # So do its generator and its next episode.
    other = again(env)
    assert other.unwrapped.np_random.random() == env.unwrapped.np_random.random()
    same_bits(other.reset(), env.reset())


def test_copies_for_stable_baselines3_go_on_alike(again):
    envs = make_vec_env("discjump/Ski-v0", n_envs=9, seed=0, threads=1, **SHORT)
    envs.reset()
    envs.set_attr("name", "mine", indices=[2])
    other = again(envs)
    assert other.get_attr("name", indices=[2]) == ["mine"]
    quiet = 0
    for action in random_actions(2, 60, 9):
        left, right = other.step(action), envs.step(action)
        same_bits(left[:3], right[:3])
        assert isinstance(left[3], SharedInfos) == isinstance(right[3], SharedInfos)
        quiet += isinstance(left[3], SharedInfos)
        for one, two in zip(left[3], right[3], strict=True):
            # Seconds since the object was made.
            for info in (one, two):
                info.get("episode", {}).pop("t", None)
            same_bits(dict(one), dict(two))
    assert 0 < quiet < 60


@pytest.mark.parametrize("scene", ["sandbox", "disc_jump", "mission"])
def test_copies_of_simulators_go_on_alike(again, scene):
    sim = discjump.Simulator(
        discjump.Terrain.raindance(0), 12, scene, "medium", True, "swept", players_per_world=3, threads=1
    )
    inputs = sim.inputs()
    inputs["forward"], inputs["fire"], inputs["pitch"] = 1, True, -0.5
    sim.step(inputs, 30)
    other = again(sim)
    assert other.digest() == sim.digest()
    sim.step(inputs, 60)
    other.step(inputs, 60)
    same_bits(other.state(), sim.state())
    assert other.digest() == sim.digest()


def test_a_pickle_is_opened_in_a_new_process():
    envs = SkiVectorEnv(
        5, terrains=[discjump.Terrain.from_heights(np.zeros((129, 129)))], goal_distance=(20, 60)
    )
    envs.reset(seed=7)
    action = random_actions(4, 1, 5)[0]
    envs.step(action)
    pickled = pickle.dumps((envs, action))
    code = "import pickle, sys; e, a = pickle.load(sys.stdin.buffer); sys.stdout.buffer.write(e.step(a)[0])"
    done = subprocess.run(
        [sys.executable, "-c", code], input=pickled, capture_output=True, check=True, timeout=60
    )
    assert done.stdout == envs.step(action)[0].tobytes()


@pytest.mark.parametrize("fidelity", TIERS)
def test_an_environment_is_moved_among_others(fidelity):
    """From the fourth of nine to one alone, to the last of seventeen in another mode, and back."""
    options = {**SHORT, "fidelity": fidelity}
    many = SkiVectorEnv(9, threads=1, **options)
    more = SkiVectorEnv(17, threads=3, autoreset_mode=AutoresetMode.SAME_STEP, **options)
    alone: SkiEnv = gymnasium.make("discjump/Ski-v0", lanes=1, **options).unwrapped  # type: ignore[assignment]
    many.reset(seed=100)
    more.reset(seed=200)
    alone.reset(seed=300)
    moved = 0
    for action in random_actions(5, 60, 1)[:, 0]:
        # What is over begins anew in each mode at another time: an episode is moved while it goes on.
        before = many.snapshot(3)
        others = more.state()
        more.restore(before, 16)
        alone.restore(before)
        same_bits(more.state()[:16], others[:16])
        assert more.snapshot(16) == before == alone.snapshot()
        one = alone.step(action)
        left = many.step(np.tile(action, (9, 1)))
        right = more.step(np.tile(action, (17, 1)))
        for mine, its, theirs in zip(one[1:4], left[1:4], right[1:4], strict=True):
            assert np.asarray(mine).tobytes() == its[3].tobytes() == theirs[16].tobytes()
        if not (one[2] or one[3]):
            assert one[0].tobytes() == left[0][3].tobytes() == right[0][16].tobytes()
            moved += 1
        else:
            many.reset(options={"reset_mask": np.arange(9) == 3})
            assert more.snapshot(16) == many.snapshot(3)
    assert moved > 40


def test_a_snapshot_of_one_is_refused_where_it_does_not_fit():
    envs = SkiVectorEnv(4, **SHORT)
    envs.reset(seed=0)
    before = envs.snapshot()
    one = envs.snapshot(0)
    for bad, index, words in (
        (one, 4, "index: expected an integer from 0 to 3"),
        (one, -1, "index: expected an integer from 0 to 3"),
        (one, None, "snapshot: expected 4 players, got 1"),
        (before, 1, "snapshot: expected 1 players, got 4"),
        (one[:-1], 1, "snapshot: "),
        (SkiVectorEnv(1, fidelity="fast", **SHORT).snapshot(), 1, "another layout"),
    ):
        with pytest.raises(ValueError, match=words):
            envs.restore(bad, index)
        assert envs.snapshot() == before
    with pytest.raises(TypeError, match="index: expected"):
        envs.restore(one, "0")  # type: ignore[arg-type]


def test_a_snapshot_with_any_byte_flipped_is_refused():
    envs = SkiVectorEnv(2, **SHORT)
    envs.reset(seed=0)
    snapshot, sim = envs.snapshot(), discjump.Simulator(discjump.Terrain.raindance(0), 2, threads=1)
    for one, whole in ((envs, snapshot), (sim, sim.snapshot())):
        for at in range(len(whole)):
            damaged = whole[:at] + bytes([whole[at] ^ 0x10]) + whole[at + 1 :]
            with pytest.raises(ValueError, match=r"^snapshot: "):
                one.restore(damaged)
        assert one.snapshot() == whole


def test_one_player_of_a_simulator_is_moved():
    terrain = discjump.Terrain.raindance(0)
    sim = discjump.Simulator(terrain, 20, "disc_jump", threads=1)
    inputs = sim.inputs()
    inputs["forward"], inputs["jet"], inputs["fire"] = 1, np.arange(20) % 2, np.arange(20) % 3 == 0
    inputs["turn"] = 0.1 * np.arange(20)
    sim.step(inputs, 40)
    other = discjump.Simulator(terrain, 3, "disc_jump", threads=1)
    for player in (0, 9, 19):
        other.restore(sim.snapshot(player), 1)
        assert other.snapshot(1) == sim.snapshot(player)
        same_bits(other.state()[1:2], sim.state()[player : player + 1])
        three = other.inputs()
        three[1] = inputs[player]
        ahead = copy.deepcopy(sim)
        ahead.step(inputs, 20)
        other.step(three, 20)
        assert other.snapshot(1) == ahead.snapshot(player)
    for bad in (20, -1):
        with pytest.raises(ValueError, match="player: expected an integer from 0 to 19"):
            sim.snapshot(bad)
