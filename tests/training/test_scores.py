import json
import shutil

import pytest
from click.testing import CliRunner

from discjump.cards import card
from discjump.cli import main
from discjump.envs.tasks import SKI
from discjump_training import scores
from discjump_training.courses import course_of

RUN = {
    "seed": 0,
    "steps": 6_000_000,
    "steps_per_second": 20_000.0,
    "seconds": {"environment": 30.0, "policy": 60.0, "update": 210.0, "evaluation": 9.0},
}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    course = course_of("ski", None)
    plan = {
        "course": course.name,
        "episodes": [{"episode": row, "seconds": 10.0 + row, "success": True} for row in range(4)],
    }
    (folder / "ski").mkdir()
    (folder / "ski" / "plan.json").write_text(json.dumps(plan))
    asked = ["skier", "tacker", "--no-baselines", "--episodes", "8", "--threads", "1", "--no-page"]
    asked += ["--planner", str(folder / "ski" / "plan.json"), "--out", str(folder / "ski")]
    result = CliRunner().invoke(main, ["evaluate", *asked])
    assert result.exit_code == 0, result.output
    for seed, rate in ((0, 20_000.0), (1, 10_000.0)):
        (folder / "ski" / "runs" / str(seed)).mkdir(parents=True)
        run = {**RUN, "seed": seed, "steps_per_second": rate}
        (folder / "ski" / "runs" / str(seed) / "run.json").write_text(json.dumps(run))
    return folder


def test_the_table_has_what_the_evaluation_has(results):
    result = CliRunner().invoke(scores.main, [str(results)])
    assert result.exit_code == 0, result.output
    made = json.loads((results / "scores.json").read_text())["ski"]
    evaluated = json.loads((results / "ski" / "evaluation.json").read_text())
    for row, one in zip(made["rows"][:2], evaluated["policies"], strict=True):
        assert row[0] == one["name"]
        assert row[2].startswith(f"{100 * one['success']['value']:.1f} [")
        assert row[3].startswith(f"{one['seconds']['value']:.2f} [")
        assert float(row[4]) == pytest.approx(one["percent_of_planner"]["value"], abs=0.05)
    # Ten to thirteen seconds, four successes: the exact interval of four out of four begins at 0.025^(1/4).
    assert made["rows"][2][:3] == ["planner", "4", f"100.0 [{100 * 0.025**0.25:.1f}, 100.0]"]
    assert made["rows"][2][3].startswith("11.50 [")
    # 6 M at 20,000 a second are 5 minutes, at 10,000 are 10.
    assert "| ski | 0, 1 | 6.0 M | 7.5 (5.0 to 10.0) | 15,000 | 10%, 20%, 70% |" in result.output
    # A card shows the same rows.
    shown = card(SKI, made)
    for row in made["rows"]:
        assert f"| {' | '.join(row)} |" in shown


def test_what_is_missing_or_damaged_is_named(results, tmp_path):
    result = CliRunner().invoke(scores.main, [str(tmp_path)])
    assert result.exit_code == 1
    assert "expected results of `discjump evaluate`" in result.output
    shutil.copytree(results, tmp_path / "results")
    (tmp_path / "results" / "ski" / "plan.json").write_text("{")
    result = CliRunner().invoke(scores.main, [str(tmp_path / "results")])
    assert result.exit_code == 1
    assert "plan.json: expected JSON" in result.output
    (tmp_path / "results" / "ski" / "plan.json").write_text('{"episodes": [{}]}')
    result = CliRunner().invoke(scores.main, [str(tmp_path / "results")])
    assert result.exit_code == 1
    assert "no results of this version" in result.output
