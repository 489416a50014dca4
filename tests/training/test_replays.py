"""`discjump evaluate --replays` keeps every judged episode, and judges as it does without."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from discjump import replays
from discjump.replays import EpisodeReplay
from discjump_training import baselines
from discjump_training.commands.evaluate import evaluate
from discjump_training.courses import HELD_OUT
from discjump_training.episodes import Stage

EPISODES = 6


def invoke(*arguments):
    return CliRunner().invoke(evaluate, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("evaluation")
    judged = ("skier", "random", "--no-baselines", "--no-page", "--episodes", EPISODES)
    result = invoke(*judged, "--out", made / "with", "--replays", made / "replays")
    assert result.exit_code == 0, result.output
    assert f"Replays: {made / 'replays'} (12 episodes)" in result.output
    assert invoke(*judged, "--out", made / "without").exit_code == 0
    return made


def test_evaluation_stays_the_same(folder):
    """But for where the replays of failures are."""
    for name in ("evaluation.md", "evaluation.png"):
        assert (folder / "with" / name).read_bytes() == (folder / "without" / name).read_bytes()
    figures = [json.loads((folder / name / "evaluation.json").read_text()) for name in ("with", "without")]
    for one in figures:
        for policy in one["policies"]:
            for failure in policy["failures"]:
                assert Path(failure.pop("replay")).is_file()
    assert figures[0] == figures[1]


def test_every_episode_has_its_file(folder):
    names = {path.name for path in (folder / "replays").iterdir()}
    assert names == {
        f"{HELD_OUT.name}-{row:04}-{policy}.replay"
        for row in range(EPISODES)
        for policy in ("skier", "random")
    }


def test_replays_are_the_judged_episodes(folder):
    """Seeds and times are those of the course and of evaluation.json; all verify."""
    figures = json.loads((folder / "with" / "evaluation.json").read_text())
    for policy in figures["policies"]:
        for row, seconds in enumerate(policy["episode_seconds"]):
            replay = replays.load(folder / "replays" / f"{HELD_OUT.name}-{row:04}-{policy['name']}.replay")
            assert isinstance(replay, EpisodeReplay)
            assert (replay.seed, replay.episode) == (HELD_OUT.base_seed + row, 0)
            assert replay.options["terrain_seeds"] == list(HELD_OUT.terrain_seeds)
            assert replay.outcome is not None
            assert round(replay.outcome["time"] if replay.outcome["is_success"] else 60.0, 3) == seconds
            assert replay.verify() is None


def test_a_stage_gives_each_row_once():
    seen: list[int] = []
    stage = Stage(HELD_OUT, 4, baselines.OPTIONS)
    played = stage.play(baselines.make("skier", stage), on_replay=lambda row, _: seen.append(row))
    assert sorted(seen) == list(range(4))
    again = stage.play(baselines.make("skier", stage))
    np.testing.assert_array_equal(played.seconds, again.seconds)
