"""What a caller of `check_vector_env` gets, passes wrongly, and is spared."""

import json
import re
import subprocess
import sys
import threading
import time

import gymnasium
import numpy as np
import pytest
from tests.testing import doubles
from tests.testing.walk import DISABLED, NEXT, Walk

from discjump.testing import ConformanceError, check_vector_env
from discjump.testing.trees import difference, frozen


def test_failures_raise_one_error_that_lists_them_all():
    class Both(doubles.IntegerFlags, doubles.NeverClosed):
        pass

    with pytest.raises(ConformanceError) as caught:
        check_vector_env(Both)
    assert isinstance(caught.value, AssertionError)
    assert [outcome.name for outcome in caught.value.report.failures] == ["flag_arrays", "closed_is_set"]
    assert "flag_arrays (gymnasium): call 1 (step): terminated: expected dtype bool, got int8" in str(
        caught.value
    )
    assert "closed_is_set" in str(caught.value)


def test_a_report_is_read_by_name_and_as_json():
    report = check_vector_env(doubles.OneSeedForAll, raise_on_failure=False)
    assert not report.passed
    assert report["seeds_differ"].verdict == "fail"
    assert report["seed_repeats"].verdict == "pass"
    read = json.loads(json.dumps(report.to_dict()))
    assert {one["name"]: one["verdict"] for one in read["outcomes"]}["seeds_differ"] == "fail"
    with pytest.raises(KeyError, match="no check of name 'sedes'"):
        report["sedes"]


def test_a_failure_names_call_environment_field_and_values():
    detail = check_vector_env(doubles.DependsOnBatchSize, raise_on_failure=False)[
        "batch_size_does_not_matter"
    ].detail
    assert re.match(
        r"seed 2 alone: call \d+ \(step\), environment 2, observation\[0\]: \S+ against \S+", detail
    )


def test_an_environment_that_is_passed_in_stays_open():
    env = Walk(3)
    report = check_vector_env(env)
    assert not env.closed
    needs = {outcome.name for outcome in report.skipped}
    assert needs == {"new_instance_repeats", "batch_size_does_not_matter", "close_twice", "closed_is_set"}
    assert "pass a factory" in report["close_twice"].detail
    assert check_vector_env(doubles.DependsOnPosition(3), raise_on_failure=False)[
        "position_does_not_matter"
    ].verdict


def test_skipped_checks_do_not_block_those_that_need_them():
    report = check_vector_env(doubles.OneSeedForAll, skip=["seeds_differ", "seed_repeats"])
    assert report["seeds_differ"].detail == "left out by the caller"
    assert report["reset_forgets"].verdict == "pass"


def test_keys_of_info_that_cannot_repeat_are_ignored_on_request():
    class Clock(Walk):
        def info(self, mask):
            now = np.full(self.num_envs, time.perf_counter())
            inner = {"t": now, "_t": mask.copy()}
            return {**super().info(mask), "episode": inner, "_episode": mask.copy()}

    assert [one.name for one in check_vector_env(Clock, raise_on_failure=False).failures] == ["seed_repeats"]
    assert check_vector_env(Clock, ignore_info=["episode.t"]).passed
    assert check_vector_env(Clock, ignore_info=["episode"]).passed


def test_modes_without_reset_masks_are_checked_as_far_as_they_go():
    for double in (doubles.RefusesMasks, doubles.RefusesLists):
        report = check_vector_env(double)
        assert all(outcome.detail.startswith("refuses ") for outcome in report.skipped)
        assert report.skipped
    report = check_vector_env(lambda n: doubles.RefusesMasks(n, DISABLED), raise_on_failure=False)
    assert report["seed_repeats"].verdict == "pass"


def test_long_episodes_are_reported_as_unseen():
    report = check_vector_env(Walk, steps=1)
    assert "no episode ended within 1 steps" in report["next_step_ignores_action"].detail


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"env": "CartPole-v1"}, TypeError, "env: expected a gymnasium.vector.VectorEnv or a callable"),
        ({"num_envs": 0}, ValueError, "num_envs: expected an integer from 1"),
        ({"steps": 1.5}, TypeError, "steps: expected an integer"),
        ({"seed": -1}, ValueError, "seed: expected an integer from 0"),
        ({"timeout": 0}, ValueError, "timeout: expected a number in"),
        ({"strict": 1}, TypeError, "strict: expected True or False"),
        ({"skip": "seeds_differ"}, TypeError, "skip: expected a collection of names"),
        ({"skip": ["seeds_difer"]}, ValueError, "did you mean 'seeds_differ'"),
        (
            {"env": lambda n: Walk(n + 1)},
            ValueError,
            "factory: expected 3 environments when called with that, got 4",
        ),
        ({"env": lambda n: gymnasium.make("CartPole-v1")}, TypeError, "factory: expected it to return"),
    ],
)
def test_wrong_arguments_are_named(arguments, error, text):
    with pytest.raises(error, match=text):
        check_vector_env(**{"env": Walk, **arguments})


def test_what_a_factory_raises_goes_through():
    def make(num_envs):
        raise RuntimeError("no licence")

    with pytest.raises(RuntimeError, match="no licence"):
        check_vector_env(make)


def test_a_blocked_call_is_left_behind():
    begin = time.monotonic()
    report = check_vector_env(lambda n: doubles.NeverAnswers(n, NEXT), timeout=0.3, raise_on_failure=False)
    assert time.monotonic() - begin < 20
    assert report["rollout_runs"].detail == "not done within 0.3 s"
    assert report["seed_repeats"].detail == "needs rollout_runs, which failed"


def test_a_slow_environment_meets_its_limit_in_any_thread():
    class Slow(Walk):
        def step(self, actions):
            time.sleep(0.05)
            return super().step(actions)

    reports = []
    thread = threading.Thread(
        target=lambda: reports.append(check_vector_env(Slow, timeout=0.2, raise_on_failure=False))
    )
    thread.start()
    thread.join(30)
    assert not thread.is_alive()
    assert [outcome.name for outcome in reports[0].failures] == ["rollout_runs"]


def test_neither_pytest_nor_stable_baselines3_is_needed():
    script = (
        "import sys; sys.modules.update(dict.fromkeys(('pytest', '_pytest', 'stable_baselines3', 'torch')))\n"
        "import gymnasium\nfrom discjump.testing import check_vector_env\n"
        "env = gymnasium.make_vec('CartPole-v1', 2, vectorization_mode='sync')\n"
        "print(check_vector_env(env, steps=30).passed)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def test_equality_is_of_bits():
    assert difference(np.array([0.0]), np.array([-0.0])) is not None
    assert difference(np.array([np.nan]), np.array([np.nan])) is None
    assert difference(np.float32(1), np.float64(1)) is not None
    assert difference({"a": np.arange(3)}, {"a": np.arange(3, dtype=np.int32)}) is not None
    tree = {"a": (np.arange(3), np.array([np.zeros(2), None], object))}
    assert difference(tree, frozen(tree)) is None
    assert not np.shares_memory(tree["a"][1][0], frozen(tree)["a"][1][0])
