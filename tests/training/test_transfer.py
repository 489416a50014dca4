"""Trainings in other physics, judged in the task."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from discjump_training.errors import TrainingError
from discjump_training.tradeoff import homes, training, transfer
from discjump_training.tradeoff.grid import QUICK, Plan
from discjump_training.tradeoff.store import Missing, Store

PLAN = replace(QUICK, tiers=("authentic", "engine"), seeds=2, episodes=8)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    store = Store(tmp_path_factory.mktemp("transfer"))
    told: list[int] = []
    return store, transfer.Transfer().run(PLAN, store, told.append), told


def test_the_task_has_no_gap_to_itself_to_the_last_bit(made):
    store, section, told = made
    assert len(told) == transfer.Transfer().work(PLAN) == 4
    own, other = section["rows"]
    assert own["gap_seconds"] == own["cost_seconds"] == {"value": 0.0, "low": 0.0, "high": 0.0}
    pieces = [json.loads(path.read_text())["made"] for path in (store.pieces / "transfer").iterdir()]
    assert sorted(piece["home"] == piece["task"] for piece in pieces) == [False, False, True, True]
    assert other["home"] == "engine 32 ms"


def test_what_is_done_is_not_done_again(made):
    store, section, _ = made
    before = {path: path.stat().st_mtime_ns for path in store.folder.rglob("*.*")}
    again = transfer.Transfer().run(PLAN, Store(store.folder, frozen=True), lambda _: None)
    assert again == section
    assert {path: path.stat().st_mtime_ns for path in store.folder.rglob("*.*")} == before
    with pytest.raises(Missing):
        transfer.Transfer().run(replace(PLAN, seeds=3), Store(store.folder, frozen=True), lambda _: None)


def test_a_run_by_another_recipe_is_not_taken_for_this_one(made):
    store, _, _ = made
    with pytest.raises(TrainingError, match="another recipe"):
        transfer.Transfer().run(replace(PLAN, steps=12_288), store, lambda _: None)


def test_estimates_are_numpys(made):
    store, section, _ = made
    pieces = [json.loads(path.read_text())["made"] for path in (store.pieces / "transfer").iterdir()]
    for row in section["rows"]:
        own = [piece for piece in pieces if (piece["home"] == piece["task"]) == (row["tier"] == "authentic")]
        seconds = np.array([[one[place]["seconds"] for one in own] for place in ("home", "task")])
        assert row["home_seconds"]["value"] == pytest.approx(seconds[0].mean(), abs=1e-9)
        assert row["gap_seconds"]["value"] == pytest.approx((seconds[1] - seconds[0]).mean(), abs=1e-9)
        assert sorted(row["seconds_by_seed"]) == pytest.approx(sorted(seconds[1].mean(axis=1)))
        assert row["failures"] == sum(not ok for one in own for ok in one["task"]["success"])
        assert row["task_frame_skip"] == 4


def test_times_of_training_count_every_part(made, tmp_path):
    section = training.Training().run(PLAN, Store(tmp_path), lambda _: None)
    assert [row["home"] for row in section["rows"]] == ["authentic 32 ms", "engine 32 ms"]
    for row in section["rows"]:
        assert sum(row["shares"].values()) == pytest.approx(1.0)
        assert row["rate"]["median"] == pytest.approx(np.median(row["rates"]))


def test_homes_keep_the_time_between_two_decisions_unless_they_are_about_it():
    for home in homes.homes(Plan()):
        decision_ms = home.config.tick_ms * home.frame_skip
        assert decision_ms == 128 if home.skip is None else decision_ms == 32 * home.skip
        recipe = home.recipe(Plan(), 1_000)
        trained = recipe.environment.kwargs()
        assert trained["fidelity"] == home.config.tier
        assert trained["tick_ms"] * trained["frame_skip"] == decision_ms
    assert len({home.folder(Path(), 0) for home in homes.homes(Plan())}) == len(homes.homes(Plan()))
