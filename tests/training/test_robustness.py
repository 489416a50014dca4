import json

import numpy as np
import pytest
from click.testing import CliRunner

from discjump import Terrain
from discjump.envs.tasks import TASKS
from discjump_training.courses import course_of
from discjump_training.judge import judge
from discjump_training.robustness import command, conditions
from discjump_training.robustness.conditions import CONDITIONS, Condition, rougher, steeper, waves


@pytest.mark.parametrize("condition", CONDITIONS, ids=lambda one: one.name)
def test_every_condition_can_be_met(condition):
    for task in condition.tasks:
        options = condition.options(course_of(task, None))
        TASKS[task].options.from_keywords(options)


def slopes(terrain):
    down, along = np.gradient(np.asarray(terrain.heights), terrain.square_size)
    return np.hypot(down, along)


def test_grounds_are_what_they_are_called():
    terrain = Terrain.raindance(10_000)
    usual = slopes(terrain)
    np.testing.assert_allclose(slopes(steeper(terrain)), 1.5 * usual, atol=1e-4)
    # Rougher, as the mean turn of the slope from one square to the next has it.
    turns = [
        np.abs(np.diff(np.asarray(one.heights), 2, axis=0)).mean() for one in (terrain, rougher(terrain))
    ]
    assert turns[1] > 1.5 * turns[0]
    heights = np.asarray(waves(terrain).heights)
    assert heights.max() - heights.min() == pytest.approx(48.0, abs=0.5)
    # All of them go on beyond the rim without a step.
    for ground in (steeper, rougher, waves):
        made = np.asarray(ground(terrain).heights)
        np.testing.assert_allclose(made[0], made[-1], atol=1e-3)
        np.testing.assert_allclose(made[:, 0], made[:, -1], atol=1e-3)


def test_other_ticks_leave_the_time_between_decisions():
    for task, of in TASKS.items():
        options = Condition("", {"tick_ms": 64}).options(course_of(task, None))
        assert options["tick_ms"] * options["frame_skip"] == of.options.tick_ms * of.options.frame_skip


def test_the_command_writes_a_table_and_goes_on_where_it_stopped(tmp_path, monkeypatch):
    some = (
        Condition("as trained"),
        Condition("heavy armor", {"armor": "heavy"}),
        Condition("noise", noise=0.1),
    )
    monkeypatch.setattr(command, "CONDITIONS", some)
    asked = ["tacker", "--task", "ski", "--episodes", "2", "--threads", "1", "--out", str(tmp_path)]
    real, calls = judge, []

    def stopped(*arguments):
        calls.append(arguments)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return real(*arguments)

    monkeypatch.setattr(command, "judge", stopped)
    assert CliRunner().invoke(command.main, asked).exit_code != 0
    assert not (tmp_path / "ski.md").exists()
    assert sorted(path.name for path in (tmp_path / ".ski").iterdir()) == ["0", "1"]
    result = CliRunner().invoke(command.main, asked)
    assert result.exit_code == 0, result.output
    made = json.loads((tmp_path / "ski.json").read_text())
    assert list(made["conditions"]) == [one.name for one in some]
    seconds = {name: row["tacker"]["seconds"]["value"] for name, row in made["conditions"].items()}
    assert seconds["heavy armor"] > seconds["as trained"]
    assert seconds["noise"] != seconds["as trained"]
    assert (tmp_path / "ski.md").read_text().count("\n| ") == 4
    assert not (tmp_path / ".ski").exists()
    assert conditions.BARE == ("ski", "disc-jump")
