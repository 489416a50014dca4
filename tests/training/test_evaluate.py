import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from pydantic import BaseModel, ConfigDict

from discjump_training import baselines, cli, train
from discjump_training.courses import HELD_OUT
from discjump_training.episodes import FAILURE_SECONDS, Stage
from discjump_training.errors import TrainingError
from discjump_training.judge.compare import compare
from discjump_training.judge.judged import SHARED, Judged
from discjump_training.judge.policies import entrants

EPISODES = 12


class Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class EstimateJson(Strict):
    value: float
    low: float
    high: float


class PercentJson(EstimateJson):
    episodes: int


class FailureJson(Strict):
    policy: str
    member: str
    episode: int
    terrain: str
    cause: str
    time: float
    start_distance: float
    replay: str | None


class BandJson(Strict):
    low: float
    high: float
    episodes: int
    success: EstimateJson
    seconds: EstimateJson


class MemberJson(Strict):
    name: str
    success: list[bool]
    death: list[bool]
    seconds: list[float]
    time: list[float]
    moved: list[float]
    mean_speed: list[float]
    top_speed: list[float]
    damage: list[float]


class PolicyJson(Strict):
    name: str
    kind: str
    actions: str
    frame_skip: int
    episodes: int
    partial: bool
    success: EstimateJson
    seconds: EstimateJson
    iqm: EstimateJson
    mean_speed: EstimateJson
    top_speed: EstimateJson
    damage: EstimateJson
    percent_of_planner: PercentJson | None
    share_of_reachable: None
    deaths: int
    causes: dict[str, int]
    failures: list[FailureJson]
    bands: list[BandJson]
    episode_seconds: list[float]
    members: list[MemberJson]


class TestJson(Strict):
    __test__ = False

    name: str
    p: float


class ComparisonJson(Strict):
    policy: str
    against: str
    episodes: int
    seconds_difference: EstimateJson
    seconds_ratio: EstimateJson
    success_difference: EstimateJson
    improvement: EstimateJson
    tests: list[TestJson]
    faster_share: float
    faster_terrains: int
    terrains: int
    by_terrain: dict[str, float]


class StartsJson(Strict):
    terrain: list[int]
    start_distance: list[float]
    goals: list[list[float]]


class EvaluationJson(Strict):
    """The published form of evaluation.json: what it lacks or has too much fails here."""

    schema_version: int
    task: str
    score: str
    course: str
    course_digest: str
    terrain_seeds: list[int]
    first_environment_seed: int
    episodes: int
    partial: bool
    fidelity: str
    changes: dict[str, Any]
    failure_seconds: float
    interval: str
    causes: str
    starts: StartsJson
    policies: list[PolicyJson]
    comparisons: list[ComparisonJson]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    from discjump_training.recipe import Recipe

    from .conftest import TINY

    folder = tmp_path_factory.mktemp("runs") / "ski"
    train.train(Recipe.load("ski", TINY), 0, folder, quiet=True)
    return folder


def invoke(*arguments: object):
    return CliRunner().invoke(cli.evaluate, [str(argument) for argument in arguments])


def test_a_run_is_judged_against_all_baselines(run):
    result = invoke(run, "--episodes", EPISODES, "--threads", 1)
    assert result.exit_code == 0, result.output
    data = EvaluationJson.model_validate_json((run / "evaluation" / "evaluation.json").read_text())
    assert [one.name for one in data.policies] == [str(run), "random", "skier", "tacker"]
    assert [one.actions for one in data.policies] == ["greedy", "uniform", "scripted", "scripted"]
    assert [(one.policy, one.against) for one in data.comparisons] == [
        (str(run), name) for name in baselines.names("ski")
    ]
    for one in data.policies:
        assert len(one.episode_seconds) == data.episodes == EPISODES
        assert one.seconds.value == pytest.approx(np.mean(one.episode_seconds), abs=1e-3)
        for figure in (one.success, one.seconds, one.iqm, one.mean_speed, one.top_speed, one.damage):
            assert figure.low <= figure.value <= figure.high
    times = {one.name: np.array(one.episode_seconds) for one in data.policies}
    for pair in data.comparisons:
        a, b = times[pair.policy], times[pair.against]
        assert pair.seconds_difference.value == pytest.approx((a - b).mean(), abs=2e-3)
        assert pair.seconds_ratio.value == pytest.approx(a.mean() / b.mean(), abs=1e-3)
        assert pair.faster_share == pytest.approx((a < b).mean())

    table = (run / "evaluation" / "evaluation.md").read_text()
    assert "| skier | scripted |" in table
    assert "Time-outs and deaths count as 60 s. Fewer than 200 episodes" in table
    with Image.open(run / "evaluation" / "evaluation.png") as picture:
        assert picture.width > 800
        assert len(set(picture.convert("RGB").resize((64, 64)).get_flattened_data())) > 100
    for suffix in ("json", "md", "png", "html"):
        assert str(run / "evaluation" / f"evaluation.{suffix}") in result.output
    assert not (run / "evaluation" / ".unfinished").exists()


def test_baselines_alone_are_compared_with_each_other(tmp_path):
    result = invoke("skier", "tacker", "--no-baselines", "--episodes", 4, "--no-page", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    data = json.loads((tmp_path / "evaluation.json").read_text())
    assert [(one["policy"], one["against"]) for one in data["comparisons"]] == [("skier", "tacker")]


def test_failures_count_as_60_seconds():
    played = Stage(HELD_OUT, 8, baselines.OPTIONS).play(baselines.Random(), record=(0, 3))
    assert not played.success.all()
    assert (played.seconds[~played.success] == FAILURE_SECONDS).all()
    assert (played.seconds[played.success] <= FAILURE_SECONDS).all()
    assert sorted(played.paths) == [0, 3]


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        (["nobody"], "neither a baseline (random, skier, tacker) nor ppo", 1),
        (["skier", "--episodes", "513"], "has 1 to 512 episodes to offer, not 513", 1),
        (["skier", "--course", "mars"], "no course is named 'mars'; there are ski-train-v1", 1),
        (["skier", "--course", "ski-held-out-v2"], "of ski-held-out there is ski-held-out-v1", 1),
        ([], "Missing argument", 2),
    ],
)
def test_mistakes_are_explained(arguments, message, code, tmp_path):
    result = invoke(*arguments, "--no-baselines", "--out", tmp_path)
    assert result.exit_code == code
    assert message in result.output
    assert "Traceback" not in result.output


def test_a_folder_without_a_model_and_a_damaged_one(tmp_path):
    result = invoke(tmp_path, "--no-baselines", "--episodes", 2)
    assert result.exit_code == 1
    assert "neither a baseline" in result.output
    (tmp_path / "best.zip").write_bytes(b"nonsense")
    result = invoke(tmp_path, "--no-baselines", "--episodes", 2)
    assert result.exit_code == 1
    assert "best.zip is not a readable model file" in result.output


def judged(name, **options):
    played = Stage(HELD_OUT, 4, baselines.OPTIONS | options).play(baselines.Random())
    return Judged(name, "uniform", "model", (name,), (played,), options.get("frame_skip", 4), 4)


def test_only_the_same_episodes_are_compared():
    """Caught: episodes were paired by their row alone, whatever was played in them."""
    a, b = judged("a"), judged("b", frame_skip=2, landing=True)
    assert compare(a, b).episodes == 4
    with pytest.raises(TrainingError, match=r"a and c cannot be compared: .*start_distance differs"):
        compare(a, judged("c", goal_distance=(300.0, 700.0)))
    for key in SHARED:
        spoilt = getattr(a.episodes, key).copy()
        spoilt.view(np.uint8).reshape(-1)[0] ^= 1
        other = replace(a, name="d", played=(replace(a.episodes, **{key: spoilt}),))
        with pytest.raises(TrainingError, match=f"{key} differs"):
            compare(a, other)


def test_another_frame_skip_is_named():
    """Caught: a model trained at 2 ticks per decision stood unmarked beside ones at 4."""
    one = replace(judged("m"), note="greedy", frame_skip=2)
    assert one.actions == "greedy, frame_skip 2"
    assert replace(one, frame_skip=4).actions == "greedy"


def test_models_come_first_and_nobody_twice(run):
    def names(given, added):
        return [one.name for one in entrants(given, HELD_OUT, with_baselines=added)]

    assert names((str(run), "skier", "skier"), True) == [str(run), "skier", "random", "tacker"]
    assert names(("tacker",), False) == ["tacker"]
