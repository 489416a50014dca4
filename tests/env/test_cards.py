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
def test_the_tables_of_the_observation_are_the_layouts(name):
    section = card(TASKS[name]).split("## Observation")[1].split("## Reward")[0]
    plain, wide = section.split("With `jet_landings=True`")

    def told(text):
        lines = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("|")]
        cells = [[cell.strip() for cell in line] for line in lines[2:]]
        return [(field, int(count), unit, float(scale)) for field, count, unit, scale, _ in cells]

    def layout(**options):
        env: Any = gymnasium.make(TASKS[name].id, terrain_seeds=[0], **options).unwrapped
        fields = env.observation_layout
        assert sum(f.slice.stop - f.slice.start for f in fields) == env.observation_space.shape[0]
        return [
            (f.name, f.slice.stop - f.slice.start, f.unit, pytest.approx(f.scale, rel=1e-5)) for f in fields
        ]

    assert told(plain) == layout()
    before, after = [[one[0] for one in some] for some in (told(plain), layout(jet_landings=True))]
    at = before.index("fan")
    assert after == before[:at] + [one[0] for one in told(wide)] + before[at:]
    assert [one for one in layout(jet_landings=True) if one[0] not in before] == told(wide)


def test_the_command_prints_one_and_writes_all(tmp_path):
    run = CliRunner().invoke(main, ["card", "route"])
    assert run.exit_code == 0
    assert run.output == card(TASKS["route"])
    assert CliRunner().invoke(main, ["card", "--out", str(tmp_path)]).exit_code == 0
    assert sorted(path.stem for path in tmp_path.iterdir()) == sorted(TASKS)
    assert CliRunner().invoke(main, ["card", "golf"]).exit_code == 2
