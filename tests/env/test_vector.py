"""The vector environment.

Contract: bit for bit what gymnasium's `SyncVectorEnv` makes of as many single environments with the same
seeds, in all three autoreset modes, observations, rewards, flags and every column and mask of info; and an
environment's bits depend on its seed alone, not on its index, its neighbours or the number of threads.
Training, evaluation and replays in different batch shapes rely on it.
"""

import warnings
from functools import partial

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv

import discjump  # noqa: F401
from discjump.envs.named import SkiEnv, SkiVectorEnv

from .play import SHORT, random_actions, same_bits

ID = "discjump/Ski-v0"
MODES = list(AutoresetMode)


def pair(num_envs, mode, **options):
    options = SHORT | options
    sync = SyncVectorEnv([lambda: SkiEnv(**options) for _ in range(num_envs)], autoreset_mode=mode)
    return SkiVectorEnv(num_envs, autoreset_mode=mode, **options), sync


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.value)
@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
def test_same_bits_as_gymnasiums_own_vector(mode, actions):
    ours, theirs = pair(5, mode, actions=actions)
    same_bits(ours.reset(seed=11), theirs.reset(seed=11), "reset")
    ends = 0
    for t, action in enumerate(random_actions(1, 150, 5)):
        if actions == "box":
            action = np.random.default_rng(t).uniform(-1, 1, (5, 5)).astype(np.float32)
        mine, yours = ours.step(action), theirs.step(action)
        same_bits(mine, yours, f"step {t}")
        over = mine[2] | mine[3]
        ends += over.sum()
        if mode is AutoresetMode.DISABLED and over.any():
            same_bits(
                ours.reset(options={"reset_mask": over}),
                theirs.reset(options={"reset_mask": over.copy()}),
                f"reset after step {t}",
            )
    assert ends > 10


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.value)
def test_reset_masks_seeds_and_places_match_too(mode):
    ours, theirs = pair(4, mode)
    same_bits(ours.reset(seed=[5, 1, 2**40, 9]), theirs.reset(seed=[5, 1, 2**40, 9]))
    actions = random_actions(2, 120, 4)
    rng = np.random.default_rng(3)
    for t, action in enumerate(actions):
        mine, yours = ours.step(action), theirs.step(action)
        same_bits(mine, yours, f"step {t}")
        over = mine[2] | mine[3]
        if over.any() or t % 13 == 0:
            # Also environments that just ended and await their autoreset, and some that still run.
            mask = over | (rng.random(4) < 0.3)
            mask[rng.integers(4)] = True
            seeds = [None, int(rng.integers(100)), None, int(rng.integers(100))]
            place = {"start": (30.0, -20.0), "goal": (60.0, 10.0), "terrain_seed": 1}
            for options in ({"reset_mask": mask}, {"reset_mask": mask} | place):
                same_bits(
                    ours.reset(seed=seeds, options=dict(options)),
                    theirs.reset(seed=seeds, options=dict(options)),
                    f"reset after step {t}",
                )


def test_made_by_gymnasium_without_a_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        envs = gymnasium.make_vec(ID, num_envs=3, terrain_seeds=[0])
    assert isinstance(envs, SkiVectorEnv)
    assert envs.num_envs == 3
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert envs.observation_space.shape == (3, envs.observation_layout[-1].slice.stop)
    assert envs.action_space.shape == (3, 5)
    observations, _ = envs.reset(seed=0)
    assert observations in envs.observation_space
    assert envs.step(envs.action_space.sample())[0] in envs.observation_space
    envs.close()


@pytest.mark.parametrize("mode", [*MODES, *(mode.value for mode in MODES)])
def test_mode_is_in_the_metadata(mode):
    envs = gymnasium.make_vec(ID, num_envs=1, terrain_seeds=[0], autoreset_mode=mode)
    assert envs.metadata["autoreset_mode"] is AutoresetMode(mode)
    assert SkiVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_gymnasiums_sync_mode_works_as_well():
    envs = gymnasium.make_vec(ID, num_envs=2, vectorization_mode="sync", **SHORT)
    native = gymnasium.make_vec(ID, num_envs=2, **SHORT)
    same_bits(envs.reset(seed=4)[0], native.reset(seed=4)[0])


def roll(envs, seeds, actions):
    """All that an episode gives, step by step, one row per environment."""
    rows = [envs.reset(seed=seeds)[0]]
    for action in actions:
        observations, rewards, terminations, truncations, info = envs.step(action)
        rows += [observations, rewards, terminations, truncations, info["distance"], info["speed"]]
    return rows


@pytest.mark.parametrize(
    "mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP], ids=lambda mode: mode.value
)
def test_bits_depend_on_the_seed_alone(mode):
    seeds = np.random.default_rng(0).permutation(70).tolist()
    actions = random_actions(4, 90, 70)
    crowd = roll(SkiVectorEnv(70, autoreset_mode=mode, threads=2, **SHORT), seeds, actions)
    inline = roll(SkiVectorEnv(70, autoreset_mode=mode, threads=1, **SHORT), seeds, actions)
    for one, other in zip(crowd, inline, strict=True):
        same_bits(one, other)
    for size in (1, 2, 17):
        where = np.random.default_rng(size).choice(70, size, replace=False)
        few = roll(
            SkiVectorEnv(size, autoreset_mode=mode, **SHORT), [seeds[i] for i in where], actions[:, where]
        )
        for one, other in zip(few, crowd, strict=True):
            same_bits(one, np.ascontiguousarray(other[where]))


def test_threads_give_the_same_bits_in_a_large_batch():
    actions = random_actions(5, 20, 1500)
    one = roll(SkiVectorEnv(1500, threads=1, **SHORT), 0, actions)
    two = roll(SkiVectorEnv(1500, threads=2, **SHORT), 0, actions)
    for left, right in zip(one, two, strict=True):
        same_bits(left, right)


def test_an_int_counts_up_and_none_goes_on():
    counted, listed = SkiVectorEnv(3, **SHORT), SkiVectorEnv(3, **SHORT)
    same_bits(counted.reset(seed=40)[0], listed.reset(seed=[40, 41, 42])[0])
    second = counted.reset()[0]
    same_bits(second, listed.reset(seed=[None, None, None])[0])
    counted.reset(seed=40)
    same_bits(second, counted.reset(seed=None)[0])


def test_never_seeded_means_a_seed_from_the_operating_system():
    one, other = SkiVectorEnv(2, **SHORT).reset()[0], SkiVectorEnv(2, **SHORT).reset()[0]
    assert len({row.tobytes() for row in (*one, *other)}) == 4


def test_each_environment_can_have_its_own_place():
    envs = SkiVectorEnv(3, terrain_seeds=[0, 1])
    starts = np.array([[0.0, 0.0], [np.nan, np.nan], [50.0, 0.0]])
    _, info = envs.reset(
        seed=0, options={"start": starts, "goal": starts + np.array([0, 300]), "terrain_seed": [1, 0, 1]}
    )
    np.testing.assert_allclose(info["distance"][[0, 2]], 300, atol=1e-3)
    assert 300 <= info["distance"][1] <= 800
    np.testing.assert_array_equal(envs.terrain_index, [1, 0, 1])


def test_states_and_beacons_are_where_the_options_put_them():
    envs, env = SkiVectorEnv(2, terrain_seeds=[0]), SkiEnv(terrain_seeds=[0])
    place = {"start": (12.5, -30.0), "goal": (100.0, 200.0)}
    envs.reset(seed=0, options=place)
    env.reset(seed=0, options=place)
    for positions in (envs.state()["position"][1], env.state()["position"]):
        np.testing.assert_allclose(positions[:2], (12.5, -30.0), atol=1e-4)
        # Feet on the ground, at a 32-bit number's distance from it.
        np.testing.assert_allclose(positions[2], env.terrain.height([[12.5, -30.0]])[0], atol=1e-4)
    for goal in (envs.goals()[1], env.goal()):
        np.testing.assert_allclose(goal, (100.0, 200.0, env.terrain.height([[100.0, 200.0]])[0]), atol=1e-4)
    before = envs.state()
    copied = before.copy()
    envs.step(random_actions(0, 1, 2)[0])
    assert before.tobytes() == copied.tobytes()
    assert envs.state().tobytes() != before.tobytes()


def test_options_belong_to_the_caller():
    envs = SkiVectorEnv(2, **SHORT)
    options = {"reset_mask": np.array([True, True])}
    envs.reset(seed=0, options=options)
    assert list(options) == ["reset_mask"]


def test_statistics_wrapper_agrees_with_info():
    envs = gymnasium.wrappers.vector.RecordEpisodeStatistics(SkiVectorEnv(8, **SHORT))
    envs.reset(seed=0)
    ends = 0
    for action in random_actions(6, 120, 8):
        info = envs.step(action)[4]
        if "episode" in info:
            ended = info["_episode"]
            np.testing.assert_array_equal(ended, info["_return"])
            np.testing.assert_array_equal(info["episode"]["l"][ended], info["length"][ended])
            np.testing.assert_allclose(
                info["episode"]["r"][ended], info["return"][ended], rtol=1e-5, atol=1e-5
            )
            ends += ended.sum()
    assert ends > 8


def test_disabled_refuses_to_step_over_an_end():
    envs = SkiVectorEnv(2, autoreset_mode="Disabled", terrain_seeds=[0], time_limit=0.128)
    envs.reset(seed=0)
    still = np.tile([1, 1, 0, 0, 3], (2, 1))
    assert envs.step(still)[3].all()
    with pytest.raises(ResetNeeded, match="2 environments"):
        envs.step(still)
    envs.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(ResetNeeded, match="first of them is 1"):
        envs.step(still)


def test_resetting_a_few_returns_the_others_as_they_were_whatever_was_written_there():
    envs, theirs = pair(6, AutoresetMode.DISABLED)
    envs.reset(seed=0)
    theirs.reset(seed=0)
    rng = np.random.default_rng(1)
    for t, action in enumerate(random_actions(8, 100, 6)):
        mine, yours = envs.step(action), theirs.step(action)
        same_bits(mine, yours, f"step {t}")
        over = mine[2] | mine[3]
        mine[0][:] = 7.0
        for _ in range(3):
            mask = over | (rng.random(6) < 0.2)
            if mask.any():
                mine, yours = (one.reset(options={"reset_mask": mask.copy()}) for one in (envs, theirs))
                same_bits(mine, yours, f"reset after step {t}")
                mine[0][:] = 7.0
        if t == 40:
            envs._task.restore(envs._task.snapshot())


def test_step_before_every_environment_was_reset_is_refused():
    envs = SkiVectorEnv(2, **SHORT)
    with pytest.raises(ResetNeeded):
        envs.step(np.tile([1, 1, 0, 0, 3], (2, 1)))
    envs.reset(seed=0, options={"reset_mask": np.array([True, False])})
    with pytest.raises(ResetNeeded):
        envs.step(np.tile([1, 1, 0, 0, 3], (2, 1)))


def test_workers_of_other_processes_give_the_same_bits():
    ours = SkiVectorEnv(2, **SHORT)
    theirs = AsyncVectorEnv([partial(SkiEnv, **SHORT) for _ in range(2)])
    try:
        same_bits(ours.reset(seed=3), theirs.reset(seed=3))
        for action in random_actions(7, 40, 2):
            same_bits(ours.step(action)[:4], theirs.step(action)[:4])
    finally:
        theirs.close()


def test_a_snapshot_of_ended_episodes_keeps_them_ended():
    """Caught: restoring said that no episode was over, and a disabled one could be stepped beyond its end."""
    envs = SkiVectorEnv(2, autoreset_mode=AutoresetMode.DISABLED, **(SHORT | {"time_limit": 0.128}))
    envs.reset(seed=0)
    running = envs._task.snapshot()
    assert envs.step(random_actions(0, 1, 2)[0])[3].all()
    over = envs._task.snapshot()
    envs._task.restore(running)
    envs.step(random_actions(0, 1, 2)[0])
    envs._task.restore(over)
    with pytest.raises(ResetNeeded):
        envs.step(random_actions(0, 1, 2)[0])
