"""Contract of resuming: a run that was stopped and resumed has the same bits as one that never stopped."""

import csv
import signal
from dataclasses import asdict, replace

import numpy as np
import pytest
import torch

from discjump.envs.tasks import TASKS
from discjump_training import model, runs, train
from discjump_training.courses import COURSES
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError, TrainingError
from discjump_training.recipe import Recipe

from .conftest import TINY


def stop_after(monkeypatch, steps: int, times: int = 1) -> None:
    """Send Ctrl-C during the given step of the environments."""
    wait, count = train.TimedVecEnv.step_wait, 0

    def step_wait(self):
        nonlocal count
        count += 1
        if count == steps:
            for _ in range(times):
                signal.raise_signal(signal.SIGINT)
        return wait(self)

    monkeypatch.setattr(train.TimedVecEnv, "step_wait", step_wait)


def parameters(folder):
    return model.load(folder / "final.zip").policy.state_dict()


def optimiser(folder):
    return model.load(runs.newest_checkpoint(folder)).policy.optimizer.state_dict()


def curve(folder):
    with (folder / "curve.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [{key: value for key, value in row.items() if key != "training_seconds"} for row in rows]


def test_a_resumed_run_is_the_uninterrupted_run(tiny, tmp_path, monkeypatch):
    whole, halted = tmp_path / "whole", tmp_path / "halted"
    assert train.train(tiny, 3, whole, quiet=True).finished
    with monkeypatch.context() as patch:
        stop_after(patch, steps=24)  # in the middle of the second of four rollouts
        result = train.train(tiny, 3, halted, quiet=True)
    assert (result.finished, result.steps) == (False, 512)
    assert not (halted / "final.zip").exists()
    resumed = train.train(Recipe.load(halted / "recipe.toml"), 0, halted, resume=True, quiet=True)
    assert (resumed.finished, resumed.steps, resumed.progress.seed) == (True, 1_024, 3)

    assert curve(halted) == curve(whole)
    for name, tensor in parameters(whole).items():
        assert torch.equal(tensor, parameters(halted)[name]), name
    first, second = optimiser(whole), optimiser(halted)
    assert first["param_groups"] == second["param_groups"]
    for index, state in first["state"].items():
        for name, tensor in state.items():
            assert torch.equal(tensor, second["state"][index][name]), (index, name)


def test_the_learning_rate_falls_linearly_through_a_resume(tiny, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        stop_after(patch, steps=1)
        assert train.train(tiny, 0, tmp_path / "run", quiet=True).steps == 256
    train.train(tiny, 0, tmp_path / "run", resume=True, quiet=True)
    rates = {int(row["steps"]): float(row["learning_rate"]) for row in curve(tmp_path / "run")}
    # The update after `steps` decisions uses the rate for the share of the run that is left then.
    ppo = tiny.ppo
    for steps, rate in rates.items():
        left = 1.0 - steps / ppo.steps
        assert rate == pytest.approx(
            ppo.final_learning_rate + left * (ppo.learning_rate - ppo.final_learning_rate)
        )
    assert sorted(rates) == [512, 1_024]


def test_a_second_ctrl_c_stops_at_once(tiny, tmp_path, monkeypatch):
    before = signal.getsignal(signal.SIGINT)
    stop_after(monkeypatch, steps=24, times=2)
    with pytest.raises(KeyboardInterrupt):
        train.train(tiny, 0, tmp_path / "run", quiet=True)
    assert [path.name for path in runs.checkpoints(tmp_path / "run")] == ["000000000256.zip"]
    assert signal.getsignal(signal.SIGINT) is before


def test_a_run_without_a_checkpoint_is_begun_anew(tiny, tmp_path, monkeypatch):
    """Caught: what a crash or a second Ctrl-C left in the folder made it "not an empty folder" for ever."""
    folder = tmp_path / "run"
    with monkeypatch.context() as patch:
        stop_after(patch, steps=24, times=2)
        rare = Recipe.load("ski", (*TINY, "watch.checkpoint_every=1_000_000", "watch.evaluate_every=256"))
        with pytest.raises(KeyboardInterrupt):
            train.train(rare, 0, folder, quiet=True)
    left = {path.relative_to(folder).as_posix() for path in folder.rglob("*")}
    assert {"recipe.toml", "best.zip", "curve.csv", "tensorboard", "checkpoints"} <= left
    (folder / "tensorboard" / "mine.txt").write_text("mine")
    with pytest.raises(TrainingError, match="not an empty folder"):
        train.train(tiny, 0, folder, quiet=True)
    assert {path.relative_to(folder).as_posix() for path in folder.rglob("*")} == {
        *left, "tensorboard/mine.txt"
    }  # fmt: skip
    (folder / "tensorboard" / "mine.txt").unlink()
    assert train.train(tiny, 0, folder, quiet=True).finished
    assert len(list((folder / "tensorboard").iterdir())) == 1


def test_killed_between_the_last_two_files_a_run_can_still_end(tiny, tmp_path, monkeypatch):
    """Caught: with the last checkpoint but no final.zip, resuming said "is trained already" for ever."""
    folder, save = tmp_path / "run", model.save

    def killed(ppo, path, *rest):
        if path.name in ("final.zip", "000000001024.zip"):
            save(ppo, path, *rest)
            raise KeyboardInterrupt
        save(ppo, path, *rest)

    with monkeypatch.context() as patch:
        patch.setattr(model, "save", killed)
        with pytest.raises(KeyboardInterrupt):
            train.train(tiny, 0, folder, quiet=True)
    if not (folder / "final.zip").exists():
        train.train(tiny, 0, folder, resume=True, quiet=True)
    assert (folder / "final.zip").exists()
    assert train.train(tiny, 0, folder, resume=True, quiet=True).finished


def test_a_ctrl_c_right_after_an_update_still_leaves_a_checkpoint(tmp_path, monkeypatch):
    """Caught: a Ctrl-C between the two looks at the flag broke off the run, and nothing was saved."""
    after = train.Watcher._after_update
    interrupted: list[bool] = []

    def after_update(self):
        after(self)
        if not interrupted:
            interrupted.append(True)
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(train.Watcher, "_after_update", after_update)
    rare = Recipe.load("ski", (*TINY, "watch.checkpoint_every=1_000_000"))
    result = train.train(rare, 0, tmp_path / "run", quiet=True)
    assert not result.finished
    assert runs.newest_checkpoint(tmp_path / "run").stem == f"{result.steps:012d}"


def test_what_a_run_leaves_behind(tiny, tmp_path):
    folder = tmp_path / "run"
    train.train(tiny, 0, folder, quiet=True)
    assert {"recipe.toml", "run.json", "curve.csv", "best.zip", "final.zip"} <= {
        path.name for path in folder.iterdir()
    }
    assert [path.name for path in runs.checkpoints(folder)] == ["000000000768.zip", "000000001024.zip"]
    assert not list(folder.rglob("*.part"))
    assert list((folder / "tensorboard").glob("events*"))
    assert Recipe.load(folder / "recipe.toml") == tiny


def test_runs_of_different_seeds_share_no_environment_seed(tiny):
    seeds: list[set[int | None]] = []
    for seed in (0, 1):
        env = train.TimedVecEnv(train.make_env(tiny, seed))
        # stable-baselines3 seeds the environments anew with the seed of the model.
        train.make_model(tiny, env, seed)
        seeds.append(set(env.inner._seeds))
        env.close()
    assert [len(one) for one in seeds] == [16, 16]
    assert not seeds[0] & seeds[1]


def test_folders_that_cannot_be_used(tiny, tmp_path):
    taken = tmp_path / "taken"
    taken.mkdir()
    (taken / "note.txt").write_text("mine")
    with pytest.raises(TrainingError, match=r"taken exists and is not an empty folder: choose another --out"):
        train.train(tiny, 0, taken, quiet=True)
    with pytest.raises(TrainingError, match=r"nothing to resume: there is no checkpoint"):
        train.train(tiny, 0, taken, resume=True, quiet=True)


def test_a_finished_run_is_not_trained_again(tiny, tmp_path):
    folder = tmp_path / "run"
    train.train(tiny, 0, folder, quiet=True)
    with pytest.raises(TrainingError, match=r"is trained for 1,024 decisions already"):
        train.train(tiny, 0, folder, resume=True, quiet=True)
    with pytest.raises(TrainingError, match=r"go on with --resume"):
        train.train(tiny, 0, folder, quiet=True)
    longer = tiny.with_steps(1_280)
    assert train.train(longer, 0, folder, resume=True, quiet=True).steps == 1_280


def test_a_task_that_is_scored_by_shares_keeps_the_model_that_succeeds_most(tmp_path, monkeypatch, tiny):
    """Any task of the table is trained: here one that differs from ski in name, options and score."""
    other = replace(TASKS["ski"], name="other", score="share")
    monkeypatch.setitem(TASKS, "other", other)
    for kind in ("train", "validation"):
        course = replace(COURSES[f"ski-{kind}-v1"], name=f"other-{kind}-v1", task="other")
        monkeypatch.setitem(COURSES, course.name, course)
    recipe = Recipe.load("other", (*TINY, "watch.evaluate_every=256", "environment.goal_distance=[20, 60]"))
    assert recipe.watch.evaluate_course == "other-validation-v1"

    shares, seconds = iter((0.25, 0.75, 0.75, 0.5)), iter((1.0, 9.0, 8.0, 2.0))
    play = Stage.play

    def played(self, *arguments):
        episodes = play(self, *arguments)
        assert self.course.task == "other"
        assert self.inner.options.goal_distance == (20.0, 60.0)
        count, share = len(episodes.success), next(shares)
        return replace(
            episodes,
            success=np.arange(count) < share * count,
            seconds=np.full(count, next(seconds)),
        )

    monkeypatch.setattr(Stage, "play", played)
    result = train.train(recipe, 0, tmp_path / "run", quiet=True)
    assert [point.validation_success for point in result.progress.curve] == [0.25, 0.75, 0.75, 0.5]
    assert result.progress.best == result.progress.curve[2]
    about = model.about(tmp_path / "run" / "best.zip")
    assert (about["task"], about["steps"]) == ("other", 768)


def test_a_checkpoint_that_is_older_than_the_field_best_still_goes_on():
    progress = runs.Progress(3, curve=[point(5.0), point(4.0), point(6.0)], evaluated_at=7)
    older = asdict(progress)
    del older["best"]
    again = runs.Progress.from_dict({**older, "best_seconds": 4.0})
    assert again == replace(progress, best=point(4.0))
    assert runs.Progress.from_dict(asdict(again)) == again


def point(seconds: float) -> runs.Point:
    return runs.Point(1, 1.0, 1.0, seconds, 1.0, 1.0, 1e-3)


def test_a_damaged_checkpoint_is_refused(tiny, tmp_path):
    folder = tmp_path / "run"
    train.train(tiny, 0, folder, quiet=True)
    newest = runs.newest_checkpoint(folder)
    newest.write_bytes(newest.read_bytes()[:-500])
    with pytest.raises(ModelError, match=r"is not a (readable|whole) model file"):
        train.train(tiny.with_steps(1_280), 0, folder, resume=True, quiet=True)
