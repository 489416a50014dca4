"""A study trains what is missing, judges what is there, and its table says what numpy says."""

import json
import shlex

import numpy as np
import pytest
from click.testing import CliRunner

from discjump_training import courses, study
from discjump_training.errors import RecipeError, TrainingError
from discjump_training.recipe import Recipe

from .conftest import TINY


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    source = folder / "fans.toml"
    base = ", ".join(f"'{change}'" for change in TINY)
    source.write_text(
        f'title = "Fans"\nrecipe = "ski"\nseeds = [0, 1]\ncourse = "ski-validation-v1"\nbase = [{base}]\n'
        '[variants]\nfull = []\nnone = ["environment.fan_bearings=[]"]\n'
    )
    result = run(source)
    assert result.exit_code == 0, result.output
    return source


def run(source, *more):
    folder = source.parent
    words = [source, "--runs", folder / "runs", "--out", folder / "out", "--threads", 1, *more]
    return CliRunner().invoke(study.main, [str(word) for word in words])


def test_the_table_is_of_the_runs(made):
    folder = made.parent
    result = json.loads((folder / "out" / "fans.json").read_text())
    rows = result["variants"]
    assert list(rows) == ["full", "none"]
    one = study.judge(study.Study.load(made), "none", folder / "runs", 1)
    assert one is not None
    assert one.seconds.shape == (2, courses.VALIDATION.episodes)
    assert rows["none"]["seconds"]["value"] == pytest.approx(one.seconds.mean())
    assert rows["none"]["seconds_of_seeds"] == pytest.approx(one.seconds.mean(axis=1).tolist())
    gap = np.subtract(rows["none"]["seconds"]["value"], rows["full"]["seconds"]["value"])
    assert rows["none"]["difference"]["value"] == pytest.approx(gap)
    assert rows["none"]["percent"] == pytest.approx(100 * gap / rows["full"]["seconds"]["value"])
    assert sum(rows["none"]["shares"].values()) == pytest.approx(1.0)
    text = (folder / "out" / "fans.md").read_text()
    assert len({line.count("|") for line in text.splitlines() if line.startswith("|")}) == 1


def test_its_commands_make_its_runs(made, tmp_path):
    from discjump_training.cli import train

    folder = made.parent
    command = json.loads((folder / "out" / "fans.json").read_text())["variants"]["none"]["commands"][1]
    words = shlex.split(command)
    assert words[:2] == ["discjump", "train"]
    result = CliRunner().invoke(train, [*words[2:-1], str(tmp_path / "again"), "--quiet"])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "again" / "curve.csv").read_text().splitlines()[0]
    again, first = (
        Recipe.load(at / "recipe.toml") for at in (tmp_path / "again", folder / "runs" / "none-1")
    )
    assert study.same(again, first)
    assert again.environment.kwargs()["fan_bearings"] == []


def test_what_is_there_is_not_made_again(made):
    before = {path: path.stat().st_mtime_ns for path in (made.parent / "runs").rglob("*")}
    assert run(made).exit_code == 0
    assert {path: path.stat().st_mtime_ns for path in (made.parent / "runs").rglob("*")} == before


def test_a_run_by_another_recipe_is_not_taken_for_this_one(made, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(made.read_text().replace("none = [", "none = ['ppo.gamma=0.9', "))
    with pytest.raises(TrainingError, match=r"none-0 holds a run by another recipe"):
        study.train_all(study.Study.load(other), made.parent / "runs")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = [", "is no study"),
        ('title = "a"', "recipe"),
        (
            'title="a"\nrecipe="ski"\nseeds=[0]\ncourse="ski-held-out-v1"\n[variants]\na=["ppo.gama=1"]',
            r"ppo\.gama: unknown field",
        ),
    ],
)
def test_what_is_no_study_is_refused(tmp_path, text, message):
    source = tmp_path / "s.toml"
    source.write_text(text)
    with pytest.raises(RecipeError, match=message):
        study.Study.load(source)
