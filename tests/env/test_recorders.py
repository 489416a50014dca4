"""Recorders change nothing of what they record, and each of their replays is that of the episode it names.

An episode is a function of its seed and number, so a replay taken from row 5 of a batch on three threads must
be, bit for bit, the one that a single environment gives.
"""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.replays import EpisodeReplay, Recorder, VectorRecorder, load, record

from .play import SHORT, random_actions, same_bits

NUM_ENVS, DECISIONS = 6, 90


def batch(mode: AutoresetMode = AutoresetMode.NEXT_STEP, **more: object) -> SkiVectorEnv:
    return SkiVectorEnv(NUM_ENVS, autoreset_mode=mode, **{**SHORT, **more})


def play(env, seed=4, decisions=DECISIONS):
    """All that a rollout returns."""
    seen = [env.reset(seed=seed)]
    disabled = env.unwrapped.autoreset_mode == AutoresetMode.DISABLED
    for actions in random_actions(1, decisions, NUM_ENVS):
        seen.append(env.step(actions))
        over = seen[-1][2] | seen[-1][3]
        if disabled and over.any():
            seen.append(env.reset(options={"reset_mask": over}))
    return seen


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_a_recorder_changes_nothing_and_its_replays_verify(mode):
    recorder = record(batch(mode), every=8)
    assert isinstance(recorder, VectorRecorder)
    same_bits(tuple(play(recorder)), tuple(play(batch(mode))))
    under_way = len(recorder.replays)
    recorder.close()
    replays = recorder.replays
    assert under_way >= 2 * NUM_ENVS
    assert len(replays) - under_way <= NUM_ENVS
    named = {(replay.seed, replay.episode) for replay in replays}
    assert len(named) == len(replays)
    assert {seed for seed, _ in named} == set(range(4, 4 + NUM_ENVS))
    assert {episode for _, episode in named} >= {0, 1}
    outcomes = [replay.outcome or {} for replay in replays[:under_way]]
    assert any(outcome["is_success"] for outcome in outcomes)
    assert any(outcome["timeout"] for outcome in outcomes)
    for replay in replays:
        assert replay.verify() is None
        # Only the same-step mode has lost the last state when it returns.
        cut = replay.outcome is None
        assert ("final" in replay.arrays) == (cut or mode != AutoresetMode.SAME_STEP)


def test_a_batch_and_one_environment_record_the_same():
    """All but what is said of the way: file for file."""
    recorder = record(batch(threads=3), rows=[5], episodes=2)
    play(recorder)
    assert [replay.episode for replay in recorder.replays] == [0, 1]
    alone = record(SkiEnv(**SHORT))
    for replay in recorder.replays:
        alone.reset(seed=9 if replay.episode == 0 else None)
        for action in replay.actions:
            alone.step(action)
    for one, other in zip(recorder.replays, alone.replays, strict=True):
        assert (one.made["index"], other.made["index"]) == (5, 0)
        same: dict[str, Any] = {"made": {}}
        assert {**one.header, **same} == {**other.header, **same}
        same_bits(one.arrays, other.arrays)


def test_rows_and_numbers_of_episodes():
    recorder = record(batch(), rows=[1, 3], episodes=1)
    play(recorder)
    assert sorted(replay.made["index"] for replay in recorder.replays) == [1, 3]
    with pytest.raises(ValueError, match=r"rows\[1\]: expected an integer from 0 to 5, got 6"):
        record(batch(), rows=[0, 6])


def test_asked_places_are_each_rows_own():
    start = np.full((NUM_ENVS, 2), np.nan)
    start[2] = (10.0, 20.0)
    recorder = record(batch(time_limit=0.5))
    options = {"start": start, "goal": (0.0, 100.0), "terrain_seed": [0, 1, 0, 1, 0, 1]}
    recorder.reset(seed=0, options=options)
    for actions in random_actions(2, 4, NUM_ENVS):
        recorder.step(actions)
    placed = [replay.header["reset"] for replay in recorder.replays]
    assert placed[2] == {"start": [10.0, 20.0], "goal": [0.0, 100.0], "terrain_seed": 0}
    assert placed[3] == {"goal": [0.0, 100.0], "terrain_seed": 1}
    assert all(replay.verify() is None for replay in recorder.replays)


def test_files_and_callbacks(tmp_path):
    seen: list[EpisodeReplay] = []
    env = gymnasium.make("discjump/Ski-v0", terrain_seeds=[0], time_limit=0.3)
    recorder = Recorder(env, tmp_path / "deep", on_replay=seen.append)
    for number in range(2):
        recorder.reset(seed=8 if number == 0 else None)
        over = False
        while not over:
            _, _, terminated, truncated, _ = recorder.step(np.array([2, 1, 1, 0, 3]))
            over = terminated or truncated
    names = ["Ski-v0-seed8-episode0.replay", "Ski-v0-seed8-episode1.replay"]
    assert sorted(path.name for path in (tmp_path / "deep").iterdir()) == names
    assert recorder.replays == []
    for path, replay in zip(sorted((tmp_path / "deep").iterdir()), seen, strict=True):
        assert load(path).to_bytes() == replay.to_bytes()


def test_a_seed_from_the_operating_system_is_recorded():
    recorder = record(SkiEnv(terrain_seeds=[0], time_limit=0.3))
    recorder.reset()
    for _ in range(3):
        recorder.step(np.array([2, 1, 1, 0, 3]))
    recorder.close()
    assert recorder.replays[0].seed > 2**20
    assert recorder.replays[0].verify() is None


def test_numbers_of_an_episode_are_those_of_gymnasium():
    """`reset(seed=s)` is episode 0, each further reset the next, whoever resets."""
    envs = batch()
    envs.reset(seed=[7, 2**64 - 1, 0, 1, 2, 3])
    seeds, numbers = envs._task.batch.episodes()
    assert seeds.tolist() == [7, 2**64 - 1, 0, 1, 2, 3]
    assert numbers.tolist() == [0] * 6
    envs.reset()
    envs.reset(seed=[None, 5, None, None, None, None])
    seeds, numbers = envs._task.batch.episodes()
    assert seeds.tolist() == [7, 5, 0, 1, 2, 3]
    assert numbers.tolist() == [2, 0, 2, 2, 2, 2]


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: record(gymnasium.make("CartPole-v1")), TypeError, "expected an environment of discjump"),
        (lambda: record(gymnasium.make_vec("CartPole-v1", 2)), TypeError, "expected a vector environment"),
        (lambda: record(SkiEnv(terrain_seeds=[0]), every=0), ValueError, "every: expected an integer from 1"),
        (
            lambda: record(
                gymnasium.wrappers.RescaleAction(
                    SkiEnv(terrain_seeds=[0], actions="box"), np.float32(-2), np.float32(2)
                )
            ),
            ValueError,
            "expected a recorder inside of what changes actions",
        ),
    ],
)
def test_what_cannot_be_recorded_is_refused(make, error, message):
    with pytest.raises(error, match=message):
        make()
