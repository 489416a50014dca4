"""The pytest plugin as a project uses it: with an ini file, a conftest.py and tests of its own."""

import importlib.metadata
import subprocess
import sys

import pytest

from discjump.testing import CHECKS

pytest_plugins = ["pytester"]

PLUGIN = ("-p", "discjump_pytest", "-p", "no:cacheprovider")

ENVIRONMENTS = """
import gymnasium
import numpy as np
from gymnasium.vector import VectorWrapper

def make(num_envs, scale=1.0):
    return gymnasium.make_vec("Pendulum-v1", num_envs, g=10.0 * scale)

class Noisy(VectorWrapper):
    def step(self, actions):
        observation, *rest = self.env.step(actions)
        return np.clip(observation + np.random.uniform(0, 1e-3), -1, 1, dtype=np.float32), *rest

def noisy(num_envs):
    return Noisy(make(num_envs))

def missing(num_envs):
    raise RuntimeError("no licence")
"""


@pytest.fixture
def project(pytester):
    pytester.makepyfile(envs=ENVIRONMENTS)
    # A rollout that ends no episode is enough here.
    pytester.makeini("[pytest]\npythonpath = .\ndiscjump_steps = 20\ndiscjump_envs =\n    envs:make\n")
    return pytester


def run(project, *arguments):
    return project.runpytest_inprocess(*PLUGIN, *arguments)


def test_each_check_of_each_environment_is_an_item(project):
    result = run(project, "--discjump-verify", "--discjump-env", "envs:make scale=2", "--collect-only", "-q")
    of_one = len(CHECKS) - 2  # neither strict nor with a reference
    result.stdout.fnmatch_lines([f"discjump::envs:make{words}::seed_repeats" for words in ("", " scale=2")])
    result.stdout.fnmatch_lines([f"{2 * of_one} tests collected*"])


def test_a_sound_environment_passes(project):
    result = run(project, "--discjump-verify", "-k", "rows or seed or stay")
    outcomes = result.parseoutcomes()
    assert result.ret == 0
    assert outcomes["passed"] >= 10
    assert "failed" not in outcomes


def test_a_broken_environment_fails_by_name_with_the_rule(project):
    result = run(project, "--discjump-verify", "--discjump-env", "envs:noisy", "-k", "noisy")
    assert result.ret == 1
    assert result.parseoutcomes()["failed"] == 1
    result.stdout.fnmatch_lines(
        [
            "*envs:noisy: seed_repeats*",
            "the second rollout of seed 0: call 1 (step), environment 0, observation*",
            "The rule (gymnasium's documentation*",
            "FAILED discjump::envs:noisy::seed_repeats*",
        ]
    )


def test_an_environment_that_cannot_be_made_is_one_error(project):
    result = run(project, "--discjump-verify", "--discjump-env", "envs:missing", "-k", "missing")
    assert result.parseoutcomes()["errors"] == 1
    assert "passed" not in result.parseoutcomes()
    result.stdout.fnmatch_lines(["*RuntimeError: no licence*"])


def test_conftest_declares_and_tests_of_the_project_run_beside(project):
    project.makeconftest(
        "import envs\n"
        "def pytest_discjump_envs(config):\n"
        "    return {'heavy': lambda n: envs.make(n, scale=3.0)}\n"
    )
    project.makepyfile(
        test_mine="""
        def test_each(discjump_env_factory, discjump_check):
            report = discjump_check(discjump_env_factory, skip=["seeds_differ"])
            assert report["seeds_differ"].detail == "left out by the caller"
            assert "20 steps" in report["rollout_runs"].detail
        """
    )
    result = run(project, "--discjump-verify", "-v", "-k", "test_each or heavy and rollout")
    result.stdout.fnmatch_lines(
        ["test_mine.py::test_each[[]envs:make[]] PASSED*", "test_mine.py::test_each[[]heavy[]] PASSED*"]
    )
    assert result.parseoutcomes()["passed"] == 3
    # Without the option the items are not there, the fixtures are.
    run(project).assert_outcomes(passed=2)


def test_a_project_may_define_the_factory_itself(project):
    project.makepyfile(
        test_mine="""
        import envs, pytest

        @pytest.fixture
        def discjump_env_factory():
            return envs.make

        def test_once(discjump_env_factory):
            assert discjump_env_factory(2).num_envs == 2
        """
    )
    run(project).assert_outcomes(passed=1)


def test_settings_of_an_environment_win(project):
    line = "envs:noisy skip=seed_repeats num_envs=1"
    result = run(project, "--discjump-verify", "--discjump-env", line, "-rs", "-k", "noisy and reset_forgets")
    assert result.parseoutcomes()["failed"] == 1
    result.stdout.fnmatch_lines(["after a reset in the middle of an episode: call 1 (step), environment 0*"])


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--override-ini", "discjump_envs="], "no environment to verify: set discjump_envs"),
        (["--discjump-env", "envs:make"], "declared twice: envs:make"),
        (["--discjump-env", "envs:make fast"], "expected words key=value after 'envs:make', got 'fast'"),
        (["--discjump-env", "envs:make steps=few"], "envs:make: steps: expected a number, got 'few'"),
    ],
)
def test_wrong_declarations_are_usage_errors(project, arguments, text):
    result = run(project, "--discjump-verify", *arguments)
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([f"ERROR: *{text}*"])


def test_a_check_of_another_name_is_an_error(project):
    result = run(
        project, "--discjump-verify", "--override-ini", "discjump_skip=seed_repeat", "-k", "rollout_runs"
    )
    result.stdout.fnmatch_lines(["*did you mean 'seed_repeats'*"])
    assert result.ret == 1


def test_the_plugin_costs_nothing_at_start(tmp_path):
    """A pytest that never asks for it imports neither numpy nor gymnasium nor discjump."""
    script = (
        "import sys, pytest\n"
        "pytest.main(['-p', 'discjump_pytest', '--collect-only'])\n"
        "heavy = {'numpy', 'gymnasium', 'discjump', 'discjump._native'} & set(sys.modules)\n"
        "assert 'discjump_pytest' in sys.modules\n"
        "assert not heavy, heavy\n"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_pytest_finds_the_plugin_by_the_entry_point_of_the_package():
    (entry,) = [
        entry
        for entry in importlib.metadata.entry_points(group="pytest11")
        if entry.value.startswith("discjump")
    ]
    assert (entry.name, entry.value) == ("discjump_pytest", "discjump_pytest")
