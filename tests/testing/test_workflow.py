"""The reusable workflow: its steps are executed here as a runner does, in a repository that calls it.

What a runner provides (a checkout, an interpreter on PATH, a directory for temporary files) is provided;
steps that use other actions are left out. Nothing is downloaded: pip may not, and the interpreter has
discjump and pytest already.
"""

import os
import re
import subprocess
import sys
import textwrap
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
import yaml

FILE = Path(__file__).parents[2] / ".github" / "workflows" / "verify.yml"
DOCS = Path(__file__).parents[2] / "env" / "docs" / "testing.md"

# A user's repository: an environment that keeps the rules, and one that draws from a global generator.
PROJECT = {
    "pyproject.toml": """
        [build-system]
        requires = ["hatchling"]
        build-backend = "hatchling.build"

        [project]
        name = "hills"
        version = "1.0"

        [tool.hatch.build.targets.wheel]
        packages = ["hills"]

        [tool.pytest.ini_options]
        discjump_steps = 40
        discjump_envs = ["hills:make"]
        """,
    "hills/__init__.py": """
        import gymnasium
        import numpy as np

        class Hill(gymnasium.Env):
            observation_space = gymnasium.spaces.Box(-9, 9, (2,), np.float32)
            action_space = gymnasium.spaces.Discrete(2)
            wind = None

            def reset(self, *, seed=None, options=None):
                super().reset(seed=seed)
                self.place = self.np_random.uniform(-1, 1, 2).astype(np.float32)
                return self.place.copy(), {}

            def step(self, action):
                draw = self.np_random.uniform if self.wind is None else self.wind
                self.place = self.place + np.float32(draw(-0.3, 0.3)) + np.float32(0.2 * action - 0.1)
                return self.place.copy(), 1.0, bool(abs(self.place).max() > 2), False, {}

        class Windy(Hill):
            wind = staticmethod(np.random.uniform)

        def make(num_envs, windy=False):
            return gymnasium.vector.SyncVectorEnv([Windy if windy else Hill] * num_envs)
        """,
    "tests/test_own.py": "def test_own():\n    raise AssertionError('-m discjump leaves this out')\n",
}

OFFLINE_INSTALL = 'python -m pip install --no-deps --no-build-isolation --target "$RUNNER_TEMP/site" .'


def workflow() -> dict[Any, Any]:
    loaded = yaml.safe_load(FILE.read_text(encoding="utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def inputs_of() -> dict[str, dict[str, Any]]:
    # YAML 1.1 reads the key `on` as true.
    found: dict[str, dict[str, Any]] = workflow()[True]["workflow_call"]["inputs"]
    return found


def steps_of() -> list[dict[str, Any]]:
    steps: list[dict[str, Any]] = workflow()["jobs"]["verify"]["steps"]
    return steps


def evaluated(text: str, inputs: dict[str, Any]) -> str:
    """`${{ inputs.x }}` replaced; any other expression is an error here."""

    def value(match: re.Match[str]) -> str:
        found = inputs[match[1]]
        return str(found).lower() if isinstance(found, bool) else str(found)

    text = re.sub(r"\$\{\{\s*inputs\.([\w-]+)\s*\}\}", value, text)
    assert "${{" not in text, text
    return text


class Runner:
    """Executes the steps that are scripts, one after the other, until one fails."""

    def __init__(self, directory: Path) -> None:
        self.workspace, self.temporary = directory / "work", directory / "temp"
        self.temporary.mkdir()
        for name, text in PROJECT.items():
            path = self.workspace / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(textwrap.dedent(text), encoding="utf-8")

    def run(self, **given: Any) -> tuple[str, subprocess.CompletedProcess[str]]:
        """The name of the last step that ran, and how it ended."""
        inputs = {name: spec["default"] for name, spec in inputs_of().items()}
        assert given.keys() <= inputs.keys()
        inputs |= given
        name, done = "", None
        for step in steps_of():
            if "uses" in step:
                continue
            name = step["name"]
            script = self.temporary / "step.sh"
            script.write_text(step["run"], encoding="utf-8")
            directory = evaluated(
                workflow()["jobs"]["verify"]["defaults"]["run"]["working-directory"], inputs
            )
            # How a runner starts a step whose shell is bash.
            done = subprocess.run(
                ["bash", "--noprofile", "--norc", "-eo", "pipefail", str(script)],
                cwd=self.workspace / directory,
                env=self.environment()
                | {name: evaluated(str(text), inputs) for name, text in step.get("env", {}).items()},
                capture_output=True,
                text=True,
                timeout=120,
                check=False,
            )
            if done.returncode:
                break
        assert done is not None
        return name, done

    def environment(self) -> dict[str, str]:
        path = os.pathsep.join([str(self.temporary / "site"), *filter(None, [os.environ.get("PYTHONPATH")])])
        return {
            "PATH": os.pathsep.join([str(Path(sys.executable).parent), "/usr/bin", "/bin"]),
            "HOME": str(self.temporary),
            "CI": "true",
            "GITHUB_WORKSPACE": str(self.workspace),
            "RUNNER_TEMP": str(self.temporary),
            "PYTHONPATH": path,
            "PIP_NO_INDEX": "1",
            "PIP_DISABLE_PIP_VERSION_CHECK": "1",
            # Found by its entry point as well, once the package is installed anew.
            "PYTEST_ADDOPTS": "-p discjump_pytest",
        }


def test_a_repository_that_declares_its_environment_passes(tmp_path):
    runner = Runner(tmp_path)
    step, done = runner.run(install=OFFLINE_INSTALL)
    assert (step, done.returncode) == ("Verify", 0), done.stdout + done.stderr
    suite = ET.parse(tmp_path / "temp" / "discjump.xml").getroot()[0]
    assert int(suite.attrib["tests"]) > 30
    assert (suite.attrib["failures"], suite.attrib["errors"]) == ("0", "0")


def test_a_broken_environment_fails_the_job_by_name(tmp_path):
    step, done = Runner(tmp_path).run(
        install=OFFLINE_INSTALL,
        envs="hills:make windy=True\nCartPole-v1 vectorization_mode=sync\n",
        strict=True,
        **{"pytest-args": "-q --no-header"},
    )
    assert (step, done.returncode) == ("Verify", 1), done.stdout + done.stderr
    failed = sorted(re.findall(r"^FAILED discjump::(.*?)::(\w+)", done.stdout, re.MULTILINE))
    sync = "CartPole-v1 vectorization_mode=sync"
    assert failed == [(sync, "refused_actions_change_nothing"), ("hills:make windy=True", "seed_repeats")]


def test_an_installation_that_fails_ends_the_job(tmp_path):
    step, done = Runner(tmp_path).run(install="false; echo 'went on'")
    assert step == "Install the project"
    assert done.returncode != 0
    assert "went on" not in done.stdout


def test_inputs_never_become_text_of_a_script():
    for step in steps_of():
        assert "${{" not in step.get("run", "")
    for name, spec in inputs_of().items():
        assert spec["description"], name
        assert type(spec["default"]) is {"string": str, "boolean": bool, "number": int}[spec["type"]]


def test_the_usage_in_the_docs_calls_it_with_inputs_that_exist():
    example = re.search(
        r"In `.github/workflows/` of your repository:\n\n((?:    .*\n|\n)+)", DOCS.read_text("utf-8")
    )
    assert example is not None
    job = yaml.safe_load(textwrap.dedent(example[1]))["jobs"]["verify"]
    assert job["uses"].split("@")[0] == "OWNER/discjump/.github/workflows/verify.yml"
    assert job["with"].keys() <= inputs_of().keys()
    assert len(job["with"]["envs"].splitlines()) == 2


@pytest.mark.parametrize("name", ["checkout", "setup-python", "upload-artifact"])
def test_actions_are_pinned_to_a_version(name):
    (uses,) = [step["uses"] for step in steps_of() if f"actions/{name}@" in step.get("uses", "")]
    assert re.fullmatch(rf"actions/{name}@v\d+", uses)
