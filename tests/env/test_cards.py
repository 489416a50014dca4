"""The committed cards of the tasks are what the code says, and what the environments are."""

import json
from pathlib import Path
from typing import Any

import gymnasium
import pytest
from click.testing import CliRunner

from discjump.cards import card
from discjump.cli import main
from discjump.envs.tasks import TASKS

ROOT = Path(__file__).parents[2]
CARDS = ROOT / "env" / "docs" / "tasks"
SCORES = ROOT / "training" / "results" / "scores.json"


def scores(name):
    return json.loads(SCORES.read_text()).get(name) if SCORES.exists() else None


@pytest.mark.parametrize("name", TASKS)
def test_the_committed_card_is_the_codes(name):
    assert (CARDS / f"{name}.md").read_text() == card(TASKS[name], scores(name)), "discjump card --out "
    "env/docs/tasks"


@pytest.mark.parametrize("name", TASKS)
def test_the_table_of_the_observation_is_the_layout(name):
    lines = card(TASKS[name]).split("## Observation")[1].split("## Reward")[0].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    told = [(field, int(count), unit, float(scale)) for field, count, unit, scale, _ in cells[2:]]
    env: Any = gymnasium.make(TASKS[name].id, terrain_seeds=[0]).unwrapped
    layout = [(f.name, f.slice.stop - f.slice.start, f.unit, f.scale) for f in env.observation_layout]
    assert told == [(*rest, pytest.approx(scale, rel=1e-5)) for *rest, scale in layout]
    assert sum(count for _, count, _, _ in told) == env.observation_space.shape[0]


def test_the_command_prints_one_and_writes_all(tmp_path):
    run = CliRunner().invoke(main, ["card", "route"])
    assert run.exit_code == 0
    assert run.output == card(TASKS["route"])
    assert CliRunner().invoke(main, ["card", "--out", str(tmp_path)]).exit_code == 0
    assert sorted(path.stem for path in tmp_path.iterdir()) == sorted(TASKS)
    assert CliRunner().invoke(main, ["card", "golf"]).exit_code == 2
