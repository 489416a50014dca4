import signal
import tomllib

import pytest
from click.testing import CliRunner

from discjump_training import cli, train
from discjump_training.recipe import Recipe

from .conftest import TINY

SETTINGS = [argument for override in TINY for argument in ("--set", override)]


def ski(*arguments: object):
    return CliRunner().invoke(cli.train, ["ski", *(str(argument) for argument in arguments)])


def test_show_recipe_prints_a_recipe_with_help_and_trains_nothing(tmp_path):
    result = ski("--show-recipe", "--recipe", "ski", "--steps", 5, "--out", tmp_path / "run")
    assert result.exit_code == 0
    recipe = Recipe.parse(tomllib.loads(result.output), "output")
    assert (recipe.ppo.steps, recipe.ppo.joint) == (5, True)
    assert "# weight of the entropy bonus" in result.output
    assert not (tmp_path / "run").exists()


def test_ctrl_c_says_how_to_go_on_and_going_on_works(tmp_path, monkeypatch):
    folder = tmp_path / "run"
    wait = train.TimedVecEnv.step_wait

    def interrupted(self):
        signal.raise_signal(signal.SIGINT)
        monkeypatch.setattr(train.TimedVecEnv, "step_wait", wait)
        return wait(self)

    monkeypatch.setattr(train.TimedVecEnv, "step_wait", interrupted)
    result = ski(*SETTINGS, "--out", folder, "--seed", 2, "--quiet")
    assert result.exit_code == 130
    assert "Stopped at 256 of 1,024 decisions" in result.output
    assert f"discjump train ski --resume {folder}" in result.output
    result = ski("--resume", folder, "--quiet")
    assert result.exit_code == 0, result.output
    assert "1,024 decisions in" in result.output
    assert str(folder / "best.zip") in result.output


def test_without_a_checkpoint_nobody_is_sent_to_one(tmp_path, monkeypatch):
    """Caught: stopped at once before the first checkpoint, the message said to go on from the last one."""

    def interrupted(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(train.TimedVecEnv, "step_wait", interrupted)
    result = ski(*SETTINGS, "--out", tmp_path / "run", "--quiet")
    assert result.exit_code == 130
    assert "before the first checkpoint" in result.output
    assert "--resume" not in result.output


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        (["--recipe", "nowhere.toml"], "cannot read the recipe nowhere.toml", 1),
        (["--set", "ppo.gama=1"], "ppo.gama: unknown field", 1),
        (["--resume", "nowhere"], "cannot read the recipe nowhere/recipe.toml", 1),
        (["--resume", "x", "--out", "y"], "--out does not fit with it", 2),
        (["--resume", "x", "--seed", "1"], "--seed does not fit with it", 2),
        (["--resume", "x", "--set", "ppo.gamma=0.9"], "--set does not fit with it", 2),
        (["--seed", "4001"], "4001 is not in the range 0<=x<=4000", 2),
        (["--set", "environment.fidelity='imaginary'"], "fidelity", 1),
    ],
)
def test_mistakes_are_explained(arguments, message, code, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = ski(*arguments)
    assert result.exit_code == code, result.output
    assert message in result.output
    assert "Traceback" not in result.output
    assert not list(tmp_path.rglob("*.zip"))
