"""Two policies on the same episodes, and scores beside a planner's."""

import json
from typing import Any

import numpy as np
import pytest
from scipy import stats

from discjump_training.courses import HELD_OUT
from discjump_training.errors import TrainingError
from discjump_training.judge import Conditions, planner
from discjump_training.judge.compare import compare


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """An evaluation of both scripts."""
    from click.testing import CliRunner

    from discjump_training.commands.evaluate import evaluate

    made = tmp_path_factory.mktemp("evaluation")
    asked = ["tacker", "skier", "--no-baselines", "--no-page", "--episodes", "32", "--out", str(made)]
    result = CliRunner().invoke(evaluate, asked)
    assert result.exit_code == 0, result.output
    return made


@pytest.fixture(scope="module")
def data(folder):
    return json.loads((folder / "evaluation.json").read_text())


def test_earlier_results_compare_as_the_policies_do(folder, data, invoke, tmp_path):
    file = folder / "evaluation.json"
    told = {}
    for name, pair in {"files": (file, f"{file}:skier"), "policies": ("tacker", "skier")}.items():
        asked = () if name == "files" else ("--episodes", 32)
        result = invoke("compare", *pair, *asked, "--out", tmp_path / f"{name}.json")
        assert result.exit_code == 0, result.output
        assert "32 episodes: tacker does better than skier" in result.output
        told[name] = json.loads((tmp_path / f"{name}.json").read_text())
    assert told["files"] == told["policies"]
    x, y = (np.array(one["members"][0]["seconds"]) for one in data["policies"])
    found = told["files"]
    assert found["difference"]["value"] == pytest.approx((x - y).mean())
    assert found["ratio"]["value"] == pytest.approx(x.mean() / y.mean())
    assert found["improvement"]["value"] == pytest.approx(((x < y) + 0.5 * (x == y)).mean())
    assert found["tests"][0]["p"] == pytest.approx(stats.wilcoxon(x - y, zero_method="pratt").pvalue)
    terrain = np.array(data["starts"]["terrain"])
    wins = [(x - y)[terrain == index].mean() < 0 for index in set(terrain.tolist())]
    assert (found["faster_terrains"], found["terrains"]) == (sum(wins), len(wins))
    assert set(found["by_terrain"]) == {str(data["terrain_seeds"][index]) for index in set(terrain.tolist())}


def test_nobody_beats_himself(play):
    one = play("skier", episodes=6)
    found = compare(one, one)
    assert (found.difference.low, found.difference.high, found.ratio.value) == (0.0, 0.0, 1.0)
    assert found.improvement.value == 0.5
    assert [test.p for test in found.tests] == [1.0, 1.0]


def test_a_share_counts_successes_and_not_times(play):
    """Who is faster but succeeds as often has no advantage there."""
    fast, slow = play("tacker", episodes=6), play("skier", episodes=6)
    assert compare(fast, slow, "seconds").improvement.value > 0.8
    assert compare(fast, slow, "share").improvement.value == 0.5
    never = play("random", episodes=6)
    assert compare(fast, never, "share").improvement.value == 1.0


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda data: data.update(course_digest="0"), "cannot be compared: their course_digest is"),
        (lambda data: data["starts"]["goals"][3].__setitem__(0, 0.1), "but their goals differs"),
        (lambda data: data.update(schema_version=1), "expected an evaluation of schema 2, got 1"),
        (lambda data: data.pop("policies"), "is no whole evaluation: KeyError"),
        (
            lambda data: data["policies"][0]["members"][0]["seconds"].pop(),
            "is no whole evaluation: ValueError",
        ),
    ],
)
def test_what_cannot_be_compared(edit, message, folder, data, tmp_path, refused):
    changed = json.loads(json.dumps(data))
    edit(changed)
    (tmp_path / "other.json").write_text(json.dumps(changed))
    assert message in refused("compare", tmp_path / "other.json", f"{folder / 'evaluation.json'}:skier")


def test_mistakes_are_explained(folder, tmp_path, refused, invoke):
    file = folder / "evaluation.json"
    assert "has no policy nobody; it has tacker, skier" in refused("compare", file, f"{file}:nobody")
    assert "expected two policies, or two files" in refused("compare", file, "skier")
    assert "expected two policies, got skier twice" in refused("compare", "skier", "skier")
    assert "cannot read" in refused("compare", file, tmp_path / "nowhere.json")
    (tmp_path / "x.json").write_text("{")
    assert "x.json is no evaluation" in refused("compare", file, tmp_path / "x.json")
    result = invoke("compare", file, f"{file}:skier", "--episodes", 3)
    assert result.exit_code == 2
    assert "--episodes does not fit with earlier results" in result.output


def plan(path, **changes):
    episodes = [{"episode": row, "seconds": 10.0 + row, "success": True, "seed": row} for row in (4, 0, 2)]
    path.write_text(json.dumps({"course": HELD_OUT.name, "episodes": episodes, **changes}))
    return path


def test_percent_of_the_planner_on_the_episodes_that_both_played(play, tmp_path, invoke):
    one = play("skier", episodes=4)
    conditions = Conditions(HELD_OUT, 4)
    beside = planner.load(plan(tmp_path / "plan.json"), conditions)
    percent = planner.percent(one, beside, "seconds")
    assert percent is not None
    found, count = percent
    rows = [0, 2]
    assert count == 2
    assert found.value == pytest.approx(100 * np.mean([10.0, 12.0]) / one.table("seconds")[0, rows].mean())
    share = planner.percent(one, beside, "share")
    assert share is not None
    assert share[0].value == 100.0
    asked = ("skier", "--no-baselines", "--no-page", "--episodes", 4, "--out", tmp_path)
    result = invoke("evaluate", *asked, "--planner", tmp_path)
    assert result.exit_code == 0, result.output
    data = json.loads((tmp_path / "evaluation.json").read_text())
    assert data["policies"][0]["percent_of_planner"]["value"] == pytest.approx(found.value)
    assert "of the planner's, %" in (tmp_path / "evaluation.md").read_text()


def test_plans_that_do_not_fit(tmp_path):
    conditions = Conditions(HELD_OUT, 4)
    path = tmp_path / "plan.json"
    with pytest.raises(TrainingError, match="cannot read"):
        planner.load(path, conditions)
    with pytest.raises(TrainingError, match="is about the course ski-public-v1, not ski-held-out-v1"):
        planner.load(plan(path, course="ski-public-v1"), conditions)
    wrong: Any
    for wrong in ([], [{"episode": 0, "seconds": 0.0, "success": True}]):
        with pytest.raises(TrainingError, match="has no episodes, one twice, or times that are none"):
            planner.load(plan(path, episodes=wrong), conditions)
    for wrong in (3, [{"episode": 0}]):
        with pytest.raises(TrainingError, match=r"plan\.json is no result of discjump plan"):
            planner.load(plan(path, episodes=wrong), conditions)
