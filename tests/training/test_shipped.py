"""The policies that come with the package do what their cards say."""

import hashlib

import numpy as np
import pytest
from stable_baselines3 import PPO

from discjump.envs.tasks import TASKS
from discjump_training import baselines, model, shipped
from discjump_training.courses import COURSES, course_of
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.evaluate import in_task
from discjump_training.judge import find

EPISODES = 24


def stage(task):
    about = model.about(shipped.policy(task))
    return Stage(course_of(task, None), EPISODES, in_task(about["environment"], task), threads=1)


@pytest.mark.parametrize("task", TASKS)
def test_it_plays_as_its_card_says(task):
    scores = shipped.card(task)["scores"]
    assert scores["course"] == course_of(task, None).name
    assert scores["episodes"] == COURSES[scores["course"]].episodes
    candidate = find(shipped.NAME, course_of(task, None))
    where = stage(task)
    played = where.play(candidate.make(where))
    # Sums of a network are rounded as the processor likes: now and then that decides an action.
    told = np.array(scores["episode_seconds"])
    assert (np.abs(played.seconds - told[:EPISODES]) < 1e-3).mean() >= 0.75
    assert scores["seconds"]["value"] == pytest.approx(told.mean(), abs=1e-3)


@pytest.mark.parametrize("task", TASKS)
def test_it_beats_the_scripts(task):
    where, plain = stage(task), Stage(course_of(task, None), EPISODES, baselines.options(task), threads=1)
    own = where.play(find(shipped.NAME, course_of(task, None)).make(where)).seconds
    for name in baselines.scripts(task):
        # A single capture that fails counts as twice as long.
        assert np.median(own) < np.median(plain.play(baselines.make(name, plain)).seconds)


@pytest.mark.parametrize("task", TASKS)
def test_stable_baselines_opens_it_and_onnx_runs_the_same(task):
    onnxruntime = pytest.importorskip("onnxruntime")
    loaded = PPO.load(shipped.policy(task), device="cpu")
    path = shipped.policy(task, ".onnx")
    assert hashlib.sha256(path.read_bytes()).hexdigest() == shipped.card(task)["digest"]
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    where = stage(task)
    observations, _ = where.env.reset(seed=list(range(EPISODES)))
    same = count = 0
    for _ in range(20):
        actions, _ = loaded.predict(observations, deterministic=True)
        (told,) = session.run(["action"], {"observation": np.asarray(observations)})
        same += int((np.asarray(told) == actions).all(axis=1).sum())
        count += len(actions)
        observations, *_ = where.env.step(actions)
    # Sums that are rounded differently may decide a tie differently.
    assert same >= 0.99 * count


def test_policies_are_small():
    for task in TASKS:
        for suffix in (".zip", ".onnx"):
            assert shipped.policy(task, suffix).stat().st_size < 400_000


def test_a_task_without_one_is_named():
    with pytest.raises(
        ModelError, match=r"task: expected one with a shipped policy \(disc-jump, .*got 'golf'"
    ):
        shipped.policy("golf")
