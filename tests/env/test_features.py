"""`discjump features`: what a feature left out changes, and what it must not change."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from discjump import cli
from discjump.features.measure import FEATURES, ROUTES, compared, measure
from discjump.features.skier import MAX_DAMAGE, SHOT, Run, run
from discjump.terrains import generated

TICKS = 500


@pytest.fixture(scope="module")
def runs() -> dict[str | None, Run]:
    route = ROUTES["bases"](np.random.default_rng(1), generated(1003), 32)
    return {feature: run(route, TICKS, feature) for feature in (None, *FEATURES)}


def test_a_run_repeats(runs: dict[str | None, Run]) -> None:
    again = run(ROUTES["bases"](np.random.default_rng(1), generated(1003), 32), TICKS, None)
    np.testing.assert_array_equal(again.position, runs[None].position)


def test_damage_moves_nobody(runs: dict[str | None, Run]) -> None:
    np.testing.assert_array_equal(runs["landing_damage"].position, runs[None].position)
    assert runs["landing_damage"].damage.max() == 0.0 < runs[None].damage.max()
    assert not runs["landing_damage"].killed.any()


def test_paths_part_when_the_feature_is_first_used(runs: dict[str | None, Run]) -> None:
    whole = runs[None].position
    same = {feature: (runs[feature].position == whole).all(axis=2).all(axis=1) for feature in FEATURES}
    # The disc bursts in the tick of the shot or the next, and is felt from the tick after.
    assert same["discs"][: SHOT + 2].all()
    assert not same["discs"][SHOT + 4]
    # A light's tank lasts 109 ticks.
    assert same["energy"][:100].all()
    assert not same["energy"][-1]
    assert not same["jump"][-1]
    assert not same["jet"][-1]
    assert not same["solids"][-1]


def test_nobody_without_jets_flies_as_high(runs: dict[str | None, Run]) -> None:
    without, whole = (runs[feature].position[:, :, 2].max(axis=0) for feature in ("jet", None))
    assert (without <= whole + 1.0).all()


def made(position: list[float], damage: float = 0.0, arrived: int = -1) -> Run:
    """One skier who goes east."""
    path = np.zeros((len(position), 1, 3))
    path[:, 0, 0] = position
    speed = np.abs(np.gradient(np.asarray(position)))[:, None]
    harm = np.full((len(position), 1), damage)
    return Run(path, speed, harm, np.array([arrived]), np.array([damage > MAX_DAMAGE]))


def test_what_is_told_of_two_runs() -> None:
    """By hand: one arrives half a second later without, another only with everything."""
    x = np.linspace(0.0, 62.0, 63).tolist()
    whole = [made(x, 0.5, 20), made(x, 0.0, 10)]
    without = [made([2.0 * each for each in x], 0.0, 36), made(x)]
    told = compared(whole, without)
    assert told["skiers"] == 2
    assert told["arrived"] == 0.5
    assert told["seconds"] == pytest.approx(36 * 0.032)
    assert told["seconds_changed"] == pytest.approx(16 * 0.032)
    assert told["top_speed_changed"] == pytest.approx(0.5)
    assert told["damage"] == 0.0
    assert told["apart"] == {"1": {"median": 15.5, "p90": pytest.approx(27.9), "over_1_m": 0.5}}


def test_command(tmp_path: Path) -> None:
    out = tmp_path / "features.json"
    words = ["features", "--starts", "8", "--seconds", "3", "--out", str(out)]
    result = CliRunner().invoke(cli.main, words)
    assert result.exit_code == 0, result.output
    rows = json.loads(out.read_text())["rows"]
    assert [(row["route"], row["left_out"]) for row in rows] == [
        (route, feature) for route in ROUTES for feature in (None, *FEATURES)
    ]
    assert rows == measure(8, 3.0, 0, lambda done: None)
    assert all(row["apart"]["1"]["p90"] == 0.0 for row in rows if row["left_out"] is None)
    for words in (["--starts", "3"], ["--seconds", "0"], ["--out", str(tmp_path)]):
        assert CliRunner().invoke(cli.main, ["features", *words]).exit_code == 2
