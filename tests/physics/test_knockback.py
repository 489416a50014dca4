"""The explosion formulas for arrays, and the command that draws them."""

import builtins
import json
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import discjump
from discjump.cli import main
from discjump.explosions import falloff

FORMULAS = ("tribes", "basic", "linear_boosted")

# Section 6 of the specification: distance, power basic, boosted, tribes (to 4 digits), damage of 0.5.
TABLE = np.array(
    [
        [0.00, 1.0000, 2.3636, 0.0000, 0.4333],
        [1.00, 0.8667, 2.0485, 0.8667, 0.4333],
        [1.75, 0.7667, 1.8121, 1.5167, 0.4333],
        [2.00, 0.7333, 1.7333, 1.7333, 0.4333],
        [2.25, 0.7000, 1.6545, 1.5000, 0.4167],
        [3.00, 0.6000, 1.4182, 1.1000, 0.3667],
        [5.00, 0.3333, 0.7879, 0.5833, 0.2333],
        [6.50, 0.1333, 0.3152, 0.3152, 0.1333],
        [7.50, 0.0000, 0.0000, 0.1538, 0.0667],
        [8.25, 0.0000, 0.0000, 0.0379, 0.0167],
        [8.50, 0.0000, 0.0000, 0.0000, 0.0000],
    ]
)


def by_hand(d0, formula, radius, min_box, cutoff):
    """The specification's formulas in numpy."""
    if formula != "tribes":
        return np.maximum(1.0 - d0 / radius, 0.0) * (1.0 if formula == "basic" else 26.0 / 11.0)
    d = np.maximum(d0 - min_box, 1.0)
    ends = (d >= radius) | ((cutoff == "radius") & (d0 > radius))
    return np.where(ends, 0.0, d0 / d - d0 / radius)


@pytest.mark.parametrize(("column", "formula"), [(1, "basic"), (2, "linear_boosted"), (3, "tribes")])
def test_table(column, formula):
    np.testing.assert_allclose(discjump.knockback(TABLE[:, 0], formula), TABLE[:, column], atol=5.001e-5)
    damage = 0.5 * falloff(TABLE[:, 0], formula, 7.5, 1.0, "engine")[1]
    np.testing.assert_allclose(damage, TABLE[:, 4], atol=5.001e-5)


@given(
    distance=arrays.arrays(
        np.float64, arrays.array_shapes(min_dims=0, max_dims=3), elements=st.floats(0, 1e6)
    ),
    formula=st.sampled_from(FORMULAS),
    radius=st.floats(0.01, 1e3),
    min_box=st.floats(0.0, 1e3),
    cutoff=st.sampled_from(("engine", "radius")),
)
def test_any_shape_agrees_with_numpy(distance, formula, radius, min_box, cutoff):
    power = discjump.knockback(distance, formula, radius, min_box, cutoff)
    assert power.dtype == np.float64
    assert power.shape == distance.shape
    assert np.isfinite(power).all()
    assert (power >= 0.0).all()
    wanted = by_hand(distance, formula, radius, min_box, cutoff)
    # The two sides of d = R round apart; there the power is all but 0.
    np.testing.assert_allclose(power, wanted, rtol=1e-12, atol=1e-9 * (1.0 + min_box / radius))


def test_lists_integers_float32_and_strides():
    wanted = discjump.knockback(np.array([0.0, 2.0, 4.0]))
    np.testing.assert_array_equal(discjump.knockback([0, 2, 4]), wanted)
    np.testing.assert_array_equal(discjump.knockback(np.arange(5, dtype=np.float32)[::2]), wanted)
    square = np.arange(6.0).reshape(2, 3)
    np.testing.assert_array_equal(discjump.knockback(square.T), discjump.knockback(square).T)
    assert discjump.knockback(2.0).shape == ()
    assert discjump.knockback([]).shape == (0,)


@pytest.mark.parametrize(
    ("error", "name", "arguments"),
    [
        (ValueError, "distance", {"distance": -1.0}),
        (ValueError, "distance", {"distance": [[0.0, np.nan]]}),
        (ValueError, "distance", {"distance": np.inf}),
        (ValueError, "distance", {"distance": [[1.0], [1.0, 2.0]]}),
        (TypeError, "distance", {"distance": "far"}),
        (TypeError, "distance", {"distance": [True]}),
        (TypeError, "distance", {"distance": 1j}),
        (TypeError, "distance", {"distance": None}),
        (ValueError, "formula", {"formula": "tribe"}),
        (TypeError, "formula", {"formula": 1}),
        (ValueError, "radius", {"radius": 0.0}),
        (ValueError, "radius", {"radius": np.nan}),
        (TypeError, "radius", {"radius": "7.5"}),
        (ValueError, "min_box", {"min_box": -1.0}),
        (TypeError, "min_box", {"min_box": None}),
        (ValueError, "cutoff", {"cutoff": "box"}),
        (TypeError, "cutoff", {"cutoff": None}),
    ],
)
def test_bad_arguments_are_named(error, name, arguments):
    with pytest.raises(error, match=rf"^{name}: expected"):
        discjump.knockback(**{"distance": 1.0, **arguments})


def test_where_the_bad_distance_is():
    with pytest.raises(ValueError, match=r"got -3\.0 at \(1, 0\)"):
        discjump.knockback([[1.0, 2.0], [-3.0, np.nan]])


def test_the_curves_are_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    result = CliRunner().invoke(main, ["falloff", "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    figures = json.loads((tmp_path / "falloff.json").read_text())
    assert figures["tribes_peak"] == {"distance": 2.0, "power": pytest.approx(1.7333, abs=5e-5)}
    distance = np.array(figures["distance"])
    for formula in FORMULAS:
        np.testing.assert_array_equal(figures["power"][formula], discjump.knockback(distance, formula))
    assert max(figures["damage_share"]) == pytest.approx(1.0 - 1.0 / 7.5)
    pixels = np.asarray(pytest.importorskip("PIL.Image").open(tmp_path / "falloff.png").convert("RGB"))
    assert pixels.shape[0] > 300
    # Four curves in four colours.
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50


def test_without_matplotlib_its_name_is_told(tmp_path, monkeypatch):
    real = builtins.__import__

    def lacking(name, *rest):
        if name.split(".")[0] == "matplotlib":
            raise ImportError(f"No module named {name!r}")
        return real(name, *rest)

    for name in [m for m in sys.modules if m.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", lacking)
    result = CliRunner().invoke(main, ["falloff", "--out", str(tmp_path / "made")])
    assert result.exit_code == 1
    assert "pip install matplotlib" in result.output
    assert not (tmp_path / "made").exists()


@pytest.mark.parametrize("arguments", [["--radius", "0"], ["--min-box", "-1"], ["--cutoff", "box"]])
def test_bad_options(arguments):
    result = CliRunner().invoke(main, ["falloff", *arguments])
    assert result.exit_code == 2
    assert arguments[0] in result.output
