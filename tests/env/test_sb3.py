"""The stable-baselines3 adapter.

Contract: bit for bit what stable-baselines3's own `DummyVecEnv` over as many monitored single environments
gives, but for the infos of environments whose episode goes on: those are one shared, empty, read-only dict.
"""

import copy
import pickle
import subprocess
import sys
import warnings

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from gymnasium.error import ResetNeeded
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import (
    DummyVecEnv,
    VecCheckNan,
    VecFrameStack,
    VecMonitor,
    VecNormalize,
)

from discjump.envs.named import SkiEnv
from discjump.sb3 import TaskVecEnv, make_vec_env

from .play import SHORT, random_actions, same_bits

ID = "discjump/Ski-v0"


def make(n_envs, seed=0, **options):
    return make_vec_env(ID, n_envs=n_envs, seed=seed, **(SHORT | options))


def dummy(n_envs, seed=0, **options):
    envs = DummyVecEnv([lambda: Monitor(SkiEnv(**(SHORT | options))) for _ in range(n_envs)])
    envs.seed(seed)
    return envs


@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
def test_same_bits_as_dummy_vec_env(actions):
    ours, theirs = make(6, actions=actions), dummy(6, actions=actions)
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    same_bits(ours.reset(), theirs.reset())
    same_bits(ours.reset_infos[2], theirs.reset_infos[2])
    ends = 0
    for t, action in enumerate(random_actions(0, 200, 6)):
        if actions == "box":
            action = np.random.default_rng(t).uniform(-1, 1, (6, 5)).astype(np.float32)
        observations, rewards, dones, infos = ours.step(action)
        expected = theirs.step(action)
        same_bits(observations, expected[0], f"step {t}")
        same_bits(rewards, expected[1], f"step {t}")
        same_bits(dones, expected[2], f"step {t}")
        for index, (info, other) in enumerate(zip(infos, expected[3], strict=True)):
            if not dones[index]:
                assert info == {}
                continue
            ends += 1
            episode, other_episode = info.pop("episode"), other.pop("episode")
            assert episode["l"] == other_episode["l"]
            assert episode["r"] == pytest.approx(other_episode["r"], abs=1e-6)
            assert episode["t"] >= 0
            same_bits(info, other, f"step {t} of environment {index}")
            same_bits(ours.reset_infos[index], theirs.reset_infos[index])
    assert ends > 10


def test_flags_are_never_both_true_and_both_kinds_of_end_turn_up():
    envs = make(20)
    envs.reset()
    kinds = set()
    for action in random_actions(1, 100, 20):
        _, _, dones, infos = envs.step(action)
        for index in np.flatnonzero(dones):
            info = infos[index]
            arrived_or_dead = info["is_success"] or info["death"]
            assert info["TimeLimit.truncated"] != arrived_or_dead
            assert info["TimeLimit.truncated"] is info["timeout"]
            assert info["terminal_observation"].shape == envs.observation_space.shape
            kinds.add(info["TimeLimit.truncated"])
    assert kinds == {True, False}


def test_running_environments_share_one_info_that_refuses_changes():
    envs = make_vec_env(ID, n_envs=5, seed=0, terrain_seeds=[0])
    envs.reset()
    infos = envs.step(random_actions(0, 1, 5)[0])[3]
    assert all(info is infos[0] for info in infos)
    info = infos[0]
    for change in (
        lambda: info.__setitem__("a", 1),
        lambda: info.update(a=1),
        lambda: info.setdefault("a", 1),
        lambda: info.pop("a", None),
        lambda: info.popitem(),
        lambda: info.clear(),
        lambda: info.__ior__({"a": 1}),
        lambda: info.__delitem__("a"),
    ):
        with pytest.raises(TypeError, match="shared by all environments"):
            change()
    for twin in (
        copy.copy(info),
        copy.deepcopy(info),
        info.copy(),
        pickle.loads(pickle.dumps(info)),
        info | {},
    ):
        assert type(twin) is dict
        twin["a"] = 1
    assert info == {}
    assert isinstance(info, dict)


def test_steps_without_an_end_share_one_list_of_infos_that_refuses_changes():
    envs = make_vec_env(ID, n_envs=3, seed=0, terrain_seeds=[0])
    envs.reset()
    infos = envs.step(random_actions(0, 1, 3)[0])[3]
    assert envs.step(random_actions(0, 1, 3)[0])[3] is infos
    for change in (
        lambda: infos.__setitem__(0, {}),
        lambda: infos.__delitem__(0),
        lambda: infos.__iadd__([{}]),
        lambda: infos.__imul__(2),
        lambda: infos.append({}),
        lambda: infos.clear(),
        lambda: infos.extend([{}]),
        lambda: infos.insert(0, {}),
        lambda: infos.pop(),
        lambda: infos.remove({}),
        lambda: infos.reverse(),
        lambda: infos.sort(key=len),
    ):
        with pytest.raises(TypeError, match="shared by all steps"):
            change()
    for twin in (
        copy.copy(infos),
        copy.deepcopy(infos),
        infos.copy(),
        infos[:],
        pickle.loads(pickle.dumps(infos)),
        list(infos),
    ):
        assert type(twin) is list
        assert twin == [{}] * 3
        twin[0] = {"a": 1}
    assert infos == [{}, {}, {}]
    assert isinstance(infos, list)


def test_list_of_infos_of_an_end_belongs_to_the_caller():
    envs, ends = make(3), 0
    envs.reset()
    for action in random_actions(0, 200, 3):
        dones, infos = envs.step(action)[2:]
        assert all(info == {} for info, done in zip(infos, dones, strict=True) if not done)
        if dones.any():
            ends += 1
            infos[:] = [{"mine": 1}] * 3
    assert ends > 3


def test_rewards_may_be_changed_in_place():
    calm, rude = make(4), make(4)
    calm.reset()
    rude.reset()
    for action in random_actions(0, 60, 4):
        one, other = calm.step(action), rude.step(action)
        same_bits(one[1], other[1])
        other[1][:] += 100
        other[2][:] = True


@pytest.mark.parametrize(
    "wrap",
    [VecMonitor, VecNormalize, VecCheckNan, lambda envs: VecFrameStack(envs, 3)],
    ids=["VecMonitor", "VecNormalize", "VecCheckNan", "VecFrameStack"],
)
def test_wrappers_of_stable_baselines3_work(wrap):
    with warnings.catch_warnings():
        # VecMonitor says that it overwrites our statistics.
        warnings.filterwarnings("ignore", message="The environment is already wrapped with a `Monitor`")
        warnings.filterwarnings("error", category=RuntimeWarning)
        envs = wrap(make(4))
        envs.reset()
        for action in random_actions(0, 80, 4):
            _, _, dones, infos = envs.step(action)
            for index in np.flatnonzero(dones):
                assert infos[index]["terminal_observation"].shape == envs.observation_space.shape
                assert infos[index]["episode"]["l"] > 0


def test_seeds_count_up_and_are_used_once():
    envs = make(3, seed=7)
    first, second = envs.reset(), envs.reset()
    assert first.tobytes() != second.tobytes()
    assert envs.seed(7) == [7, 8, 9]
    same_bits(envs.reset(), first)
    same_bits(envs.reset(), second)
    assert make(3, seed=None).reset().tobytes() != make(3, seed=None).reset().tobytes()


def test_options_apply_to_the_next_reset_only():
    envs = make_vec_env(ID, n_envs=2, seed=0, terrain_seeds=[0, 1])
    envs.set_options({"start": (0.0, 0.0), "goal": (0.0, 123.0)})
    envs.reset()
    assert [info["distance"] for info in envs.reset_infos] == pytest.approx([123.0] * 2, abs=1e-3)
    envs.set_options([{"start": (0.0, 0.0), "goal": (0.0, 123.0), "terrain_seed": 1}, {"terrain_seed": 0}])
    envs.reset()
    near, far = (info["distance"] for info in envs.reset_infos)
    assert near == pytest.approx(123.0, abs=1e-3)
    assert 300 <= far <= 800
    envs.reset()
    assert all(300 <= info["distance"] <= 800 for info in envs.reset_infos)


def test_the_end_of_one_episode_asks_nothing_of_all_environments(monkeypatch):
    """Caught: any end made the status of all environments, for the reset_infos of a few."""
    envs = make(4)
    envs.reset()

    class Batch:
        def __init__(self, batch):
            self.batch = batch

        def __getattr__(self, name):
            assert name not in ("status", "state", "goals"), name
            return getattr(self.batch, name)

    monkeypatch.setattr(envs._task, "batch", Batch(envs._task.batch))
    assert sum(envs.step(action)[2].sum() for action in random_actions(3, 80, 4)) > 4


def test_a_snapshot_from_before_the_first_reset_needs_a_reset():
    """Caught: restoring said that every environment was reset, whatever the snapshot held."""
    envs = make(3)
    fresh = envs.snapshot()
    envs.reset()
    envs.restore(fresh)
    with pytest.raises(ResetNeeded):
        envs.step(random_actions(0, 1, 3)[0])


def test_attributes_and_methods():
    envs = make(3)
    assert envs.get_attr("render_mode") == [None] * 3
    assert envs.get_attr("observation_layout", indices=1) == [envs.observation_layout]
    assert not envs.has_attr("nonsense")
    envs.set_attr("tag", "x", indices=[0, 2])
    assert envs.get_attr("tag", indices=[0, 2]) == ["x", "x"]
    with pytest.raises(AttributeError):
        envs.get_attr("tag")
    with pytest.raises(AttributeError, match="num_envs"):
        envs.set_attr("num_envs", 5)
    envs.set_attr("shout", lambda word, times=1: word.upper() * times)
    assert envs.env_method("shout", "a", times=2, indices=[1]) == ["AA"]
    with pytest.raises(AttributeError, match="whisper"):
        envs.env_method("whisper")
    assert envs.env_is_wrapped(Monitor) == [True] * 3
    assert envs.env_is_wrapped(VecMonitor, indices=0) == [False]
    assert envs.unwrapped is envs
    envs.close()


def test_pictures():
    envs = make(3, render_mode="rgb_array")
    envs.reset()
    envs.step(random_actions(0, 1, 3)[0])
    images = envs.get_images()
    assert len(images) == 3
    assert envs.render().shape == (2 * images[0].shape[0], 2 * images[0].shape[1], 3)
    same_bits(envs.env_method("render", indices=1)[0], images[1])


@pytest.mark.parametrize("env_id", [ID, f"discjump:{ID}"])
def test_ids(env_id):
    assert isinstance(make_vec_env(env_id, terrain_seeds=[0]), TaskVecEnv)


def test_ppo_learns_and_is_evaluated():
    envs = make(8)
    model = PPO("MlpPolicy", envs, n_steps=32, batch_size=64, n_epochs=1, device="cpu", seed=0)
    before = [parameter.detach().clone() for parameter in model.policy.parameters()]
    model.learn(2 * 8 * 32)
    assert model.num_timesteps == 2 * 8 * 32
    assert any(not old.equal(new) for old, new in zip(before, model.policy.parameters(), strict=True))
    assert model.ep_info_buffer
    assert model.ep_success_buffer
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # among them: no Monitor
        mean, _ = evaluate_policy(model, make(4), n_eval_episodes=4)
    assert np.isfinite(mean)


def test_sac_learns_within_wrappers_that_handle_infos():
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The environment is already wrapped with a `Monitor`")
        envs = VecNormalize(VecMonitor(make(4, actions="box")))
    model = SAC("MlpPolicy", envs, learning_starts=64, batch_size=32, buffer_size=1000, device="cpu", seed=0)
    before = [parameter.detach().clone() for parameter in model.actor.parameters()]
    # Long enough that episodes end within it: 4 s are 32 decisions.
    model.learn(4 * 60)
    assert any(not old.equal(new) for old, new in zip(before, model.actor.parameters(), strict=True))
    assert model.ep_info_buffer
    assert model.replay_buffer is not None
    assert model.replay_buffer.timeouts.any()


def test_without_stable_baselines3_the_package_works_and_the_adapter_says_what_to_install():
    code = (
        "import sys; sys.modules['stable_baselines3'] = None\n"
        "import discjump, gymnasium; gymnasium.make('discjump/Ski-v0', terrain_seeds=[0]).reset(seed=0)\n"
        "try:\n    import discjump.sb3\nexcept ImportError as error:\n    print(error)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert "pip install 'discjump[sb3]'" in run.stdout, run.stderr


def test_a_snapshot_brings_every_environment_back():
    envs, twin = make(5), make(5, seed=99)
    envs.reset()
    twin.reset()
    actions = random_actions(2, 80, 5)
    for action in actions[:40]:
        envs.step(action)
    snapshot = envs.snapshot()
    tail = [envs.step(action)[:3] for action in actions[40:]]
    for one in (envs, twin):
        one.restore(snapshot)
        for action, expected in zip(actions[40:], tail, strict=True):
            same_bits(one.step(action)[:3], expected)
    for spoilt in (snapshot[:-3], snapshot[:-2] + b"xx", snapshot[:90] + b"x" + snapshot[91:], b""):
        before = twin.snapshot()
        with pytest.raises(ValueError, match="snapshot"):
            twin.restore(spoilt)
        assert twin.snapshot() == before
    with pytest.raises(TypeError, match="snapshot"):
        twin.restore("text")
    with pytest.raises(ValueError, match="snapshot"):
        make(4).restore(snapshot)
