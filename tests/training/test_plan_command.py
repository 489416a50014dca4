import json

import pytest
from click.testing import CliRunner

from discjump import replays
from discjump_training.planner import play
from discjump_training.planner.command import plan

TINY = ("ski", "--episodes", 1, "--candidates", 16, "--horizon", 1, "--iterations", 1, "--elites", 4)


def invoke(*arguments):
    return CliRunner().invoke(plan, [str(argument) for argument in (*TINY, *arguments)])


def test_results_and_figures(tmp_path):
    result = invoke("--out", tmp_path, "--commit", 4, "--threads", 1, "--quiet")
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "plan.json").read_text())
    figures = json.loads((tmp_path / "figures.json").read_text())
    (episode,) = told["episodes"]
    assert figures["seconds"]["value"] == episode["seconds"]
    assert f"{episode['seconds']:.2f} [" in result.output
    (path,) = (tmp_path / "replays").iterdir()
    replay = replays.load(path)
    assert isinstance(replay, replays.EpisodeReplay)
    assert len(replay.actions) == episode["decisions"]
    # 8 decisions of 16 candidates for each plan of 4 decisions; the first plan takes four times as many, the
    # last two fewer where candidates arrive.
    plans = -(-episode["decisions"] // 4)
    assert 16 * 8 * (plans + 1) < episode["cost"]["decisions"] <= 16 * 8 * (plans + 3)
    assert episode["cost"]["ticks"] == 4 * episode["cost"]["decisions"]
    again = invoke("--out", tmp_path, "--commit", 4)
    assert again.exit_code == 1
    assert "holds a plan already" in again.output


def test_ctrl_c_keeps_what_is_finished(tmp_path, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(play._Player, "play", interrupted)
    result = invoke("--out", tmp_path)
    assert result.exit_code == 130
    assert "Stopped after 0 episodes" in result.output
    assert "--resume" in result.output
    assert json.loads((tmp_path / "plan.json").read_text())["partial"]


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        (["--candidates", 3], "elites: expected fewer than the 3 candidates, got 4", 1),
        (["--model", "nobody.zip"], "no model file at nobody.zip", 1),
        (["--model", "skier", "--value", "nobody.zip"], "no model file at nobody.zip", 1),
        (["--episodes", 513], "1 to 512 episodes to offer, not 513", 1),
        (["--course", "nowhere"], "no course is named 'nowhere'", 1),
        (["--course", "route-held-out-v1"], "is one of the task route, not of ski", 1),
    ],
)
def test_mistakes_are_explained(arguments, message, code, tmp_path):
    result = invoke("--out", tmp_path / "run", *arguments)
    assert result.exit_code == code, result.output
    assert message in result.output
    assert "Traceback" not in result.output
    assert not (tmp_path / "run").exists()
