import json

import numpy as np
import pytest

from discjump_training.errors import TrainingError
from discjump_training.tradeoff import transfer

from .conftest import TINY

HOMES = (transfer.TASK, transfer.Home("engine", {"fidelity": "engine"}))
STEPS = 4_096


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    out = tmp_path_factory.mktemp("transfer")
    told: list[str] = []
    tiny = [change for change in TINY if not change.startswith("ppo.steps")]
    rows = transfer.measure(out, HOMES, 2, STEPS, 8, overrides=tiny, threads=1, done=told.append)
    return out, tiny, rows, told


def test_the_task_has_no_gap_to_itself_to_the_last_bit(runs):
    out, _, rows, told = runs
    assert told == ["authentic, seed 0", "engine, seed 0", "authentic, seed 1", "engine, seed 1"]
    own = rows[0]
    assert (own.gap_seconds.value, own.gap_seconds.low, own.gap_seconds.high) == (0.0, 0.0, 0.0)
    assert own.cost_seconds.value == 0.0
    played = json.loads((out / "authentic" / "seed-0" / transfer.JUDGED).read_text())
    assert played["home"] == played["task"]
    other = json.loads((out / "engine" / "seed-0" / transfer.JUDGED).read_text())
    assert other["home"] != other["task"]


def test_what_is_done_is_not_done_again(runs):
    out, tiny, rows, _ = runs
    before = {path: path.stat().st_mtime_ns for path in out.rglob("*.*")}
    again = transfer.measure(out, HOMES, 2, STEPS, 8, overrides=tiny, threads=1)
    assert again == rows
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*.*")} == before


def test_a_run_by_another_recipe_is_not_taken_for_this_one(runs):
    out, tiny, _, _ = runs
    with pytest.raises(TrainingError, match="another recipe"):
        transfer.measure(out, HOMES, 2, 2 * STEPS, 8, overrides=tiny, threads=1)


def test_means_are_numpys(runs):
    out, _, rows, _ = runs
    for row in rows:
        where = out / row.home
        played = [json.loads((where / f"seed-{seed}" / transfer.JUDGED).read_text()) for seed in (0, 1)]
        seconds = np.array([[one[place]["seconds"] for one in played] for place in ("home", "task")])
        assert row.home_seconds.value == pytest.approx(seconds[0].mean(), abs=1e-9)
        assert row.gap_seconds.value == pytest.approx((seconds[1] - seconds[0]).mean(), abs=1e-9)
        assert row.gap_seconds.low <= row.gap_seconds.value <= row.gap_seconds.high
        assert row.failures == sum(not ok for one in played for ok in one["task"]["success"])
