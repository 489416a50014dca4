"""Every task is judged alike."""

import json

import pytest

from discjump.envs.tasks import TASKS


@pytest.mark.parametrize("task", TASKS)
def test_every_task_is_judged_and_its_replays_count(task, invoke, tmp_path):
    asked = ("--task", task, "--course", "public", "--episodes", 3, "--threads", 1, "--no-page")
    out, kept = tmp_path / "out", tmp_path / "replays"
    result = invoke("evaluate", "random", "--no-baselines", *asked, "--out", out, "--replays", kept)
    assert result.exit_code == 0, result.output
    data = json.loads((out / "evaluation.json").read_text())
    assert (data["task"], data["score"]) == (task, TASKS[task].score)
    assert data["failure_seconds"] == TASKS[task].options().time_limit
    (policy,) = data["policies"]
    assert sum(policy["causes"].values()) == sum(not one for one in policy["members"][0]["success"])
    result = invoke("leaderboard", kept, "--episodes", 3, "--out", tmp_path / "board")
    assert "3 of 3 replays count." in result.output
