"""Python callables as policies."""

import numpy as np
import pytest

from discjump_training.errors import ModelError

from . import conftest
from .conftest import Counting, ahead, ahead_in_batches

#: This folder's helpers as the command line names them; the working directory is searched.
HERE = "funcs_of_the_test"


@pytest.fixture
def module(tmp_path, monkeypatch):
    (tmp_path / f"{HERE}.py").write_text(f"from {conftest.__name__} import *\n")
    monkeypatch.chdir(tmp_path)
    return HERE


def test_one_observation_at_a_time_or_many_makes_no_difference(play):
    one, many = play(ahead), play(ahead_in_batches)
    for key in ("time", "top_speed", "moved", "damage"):
        np.testing.assert_array_equal(one.table(key), many.table(key))
    assert (one.note, one.kind) == ("function", "function")


def test_a_factory_makes_a_policy_for_every_stretch(play):
    before = Counting.made
    twice = [play(Counting, episodes=3) for _ in range(2)]
    assert Counting.made > before + 1
    np.testing.assert_array_equal(twice[0].table("top_speed"), twice[1].table("top_speed"))
    assert not np.array_equal(twice[0].table("top_speed"), play(ahead, episodes=3).table("top_speed"))


def test_an_attribute_says_what_it_takes(play):
    def batched(observations):
        assert observations.ndim == 2
        return ahead_in_batches(observations)

    def single(observation):
        assert observation.ndim == 1
        return ahead(observation)

    batched.batched, single.batched = True, False  # type: ignore[attr-defined]
    np.testing.assert_array_equal(play(batched).table("time"), play(single).table("time"))


def test_options_of_the_environment(play):
    sizes = []

    def wide(observations):
        sizes.append(observations.shape[1])
        return ahead_in_batches(observations)

    wide.options = {"fan_bearings": [0.0], "fan_ranges": [10.0], "landing": False}  # type: ignore[attr-defined]
    wide.batched = True  # type: ignore[attr-defined]
    play(wide, episodes=1)
    plain: list[int] = []

    def usual(observations):
        plain.append(observations.shape[1])
        return ahead_in_batches(observations)

    play(usual, episodes=1)
    assert set(sizes) != set(plain)


def test_by_name(module, invoke, tmp_path):
    result = invoke(
        "evaluate", f"{module}:ahead", f"{module}:Counting", "--no-baselines", "--episodes", 2, "--no-page"
    )
    assert result.exit_code == 0, result.output
    assert (tmp_path / "runs" / "evaluation" / "evaluation.json").is_file()


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("nowhere:policy", "nowhere:policy: cannot import nowhere: ModuleNotFoundError"),
        (f"{HERE}:nothing", f"the module {HERE} has no nothing"),
        (f"{HERE}:SPOON", "expected a callable obs -> action, got int"),
        (f"{HERE}:raising", "raising raised RuntimeError: no idea"),
        (
            f"{HERE}:out_of_range",
            "expected an action in MultiDiscrete([3 3 2 2 7]), got [2, 1, 1, 0, 9] in row 0",
        ),
        (
            f"{HERE}:too_short",
            "expected actions of shape (2, 5) in MultiDiscrete([3 3 2 2 7]), got int64 of shape (2, 2)",
        ),
        (f"{HERE}:halves", "expected whole numbers as actions"),
    ],
)
def test_what_does_not_fit_is_explained(name, message, module, refused):
    assert message in refused("evaluate", name, "--no-baselines", "--episodes", 2, "--no-page")


def test_a_factory_that_makes_nothing(play):
    with pytest.raises(ModelError, match="called without arguments it should make a policy, it made int"):
        play(lambda: 3)
