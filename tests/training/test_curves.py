import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy import stats

from discjump.envs.tasks import DISC_JUMP, SKI
from discjump_training import curves
from discjump_training.curves import Curves

SCORES = [[40.0, 20.0, 16.0], [42.0, 19.0, 17.0], [41.0, 21.0, 16.5]]


@pytest.fixture
def runs(tmp_path):
    paths = []
    for seed, row in enumerate(SCORES):
        lines = [f"{step}000000,{score / 100},{score}" for step, score in enumerate(row, 1)]
        # The last one is a decision longer.
        lines += ["4000000,0.15,15.0"] * (seed == 2)
        paths.append(tmp_path / f"{seed}.csv")
        paths[-1].write_text("\n".join(["steps,validation_success,validation_seconds", *lines, ""]))
    return paths


def axes():
    return Figure().add_subplot()


def test_several_seeds_are_their_mean_with_an_interval_over_seeds(runs):
    drawn = axes()
    curves.draw(drawn, Curves(SKI, {"ppo": runs}, {"skier": 22.0}))
    line, level = drawn.get_lines()
    np.testing.assert_allclose(line.get_xdata(), [1.0, 2.0, 3.0])
    np.testing.assert_allclose(line.get_ydata(), np.mean(SCORES, axis=0))
    assert set(level.get_ydata()) == {22.0}
    (band,) = drawn.collections
    corners = band.get_paths()[0].vertices
    for step, column in enumerate(np.transpose(SCORES), 1):
        at = corners[corners[:, 0] == step, 1]
        assert column.min() <= at.min() <= column.mean() <= at.max() <= column.max()
        # Not wider than what three numbers can tell, and not nothing.
        low, high = stats.t.interval(0.99, 2, column.mean(), stats.sem(column))
        assert low <= at.min() < at.max() <= high
    assert [text.get_text() for text in drawn.get_legend().get_texts()] == ["ppo, 3 seeds", "skier"]


def test_a_single_run_is_a_line(runs):
    drawn = axes()
    curves.draw(drawn, Curves(SKI, {"runs/ski": runs[:1]}, {}))
    assert len(drawn.get_lines()) == 1
    assert not drawn.collections
    assert drawn.get_yscale() == "log"
    assert drawn.get_ylabel() == "time to beacon, validation, s"


def test_shares_are_drawn_as_shares(runs):
    drawn = axes()
    curves.draw(drawn, Curves(DISC_JUMP, {"ppo": runs[:1]}, {"jumper": 57.0}))
    np.testing.assert_allclose(drawn.get_lines()[0].get_ydata(), SCORES[0])
    assert drawn.get_yscale() == "linear"
    assert drawn.get_ylabel() == "success, validation, %"
