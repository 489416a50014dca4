"""`discjump accuracy`: what it measures, what it writes, and what it refuses."""

import builtins
import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import discjump
from discjump import cli
from discjump.accuracy import grounds, measure, report, scripts
from discjump.accuracy.command import record
from discjump.accuracy.plays import Play
from discjump.accuracy.situations import FIRE, JUMP, SITUATIONS

COMMITTED = Path(__file__).parents[2] / "core" / "docs" / "accuracy"


def run(*arguments):
    return CliRunner().invoke(cli.main, ["accuracy", *map(str, arguments)])


def plays(name, starts=16, ticks=312, seed=0):
    return SITUATIONS[name].plays(seed, starts, ticks)


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """The directory and the JSON of a quick run."""
    pytest.importorskip("matplotlib")
    out = tmp_path_factory.mktemp("accuracy")
    result = run("--quick", "--out", out)
    assert result.exit_code == 0, result.output
    return out, json.loads((out / "accuracy.json").read_text())


def test_quick_form_measures_everything(quick):
    out, figures = quick
    measured = {(row["situation"], row["tier"], row["seconds"]) for row in figures["rows"]}
    tiers = ("authentic", "swept", "fast", "engine", "anyway", "nudged")
    assert measured == {(name, tier, s) for name in SITUATIONS for tier in tiers for s in (1.0, 5.0)}
    assert len(figures["rows"]) == len(measured)
    assert figures["command"] == f"discjump accuracy --quick --out {out}"
    assert figures["versions"]["discjump"] == discjump.__version__
    for row in figures["rows"]:
        assert 0.0 <= row["position"]["median"] <= row["position"]["p95"] <= row["position"]["largest"]
        assert np.isfinite([*row["position"].values(), *row["speed"].values()]).all()
        shares = [row["over"][limit] for limit in ("0.01", "0.1", "1")]
        assert shares == sorted(shares, reverse=True)


def test_the_table_is_that_of_the_json(quick):
    out, figures = quick
    compare_page(out / "accuracy.md", figures)


def compare_page(path, figures):
    """Every cell of the three tables against its figure, to the digits shown."""
    sections = re.split(r"^## ", path.read_text(), flags=re.MULTILINE)[1:]
    assert len(sections) == 3
    cells = [table_cells(section) for section in sections]
    assert cells[0].keys() == cells[1].keys() == cells[2].keys()
    assert len(cells[0]) == len(figures["rows"])
    for row in figures["rows"]:
        key = (row["situation"], row["tier"], f"{row['seconds']:g} s")
        wanted = [row[name][of] for name in ("position", "speed") for of in ("median", "p95")]
        wanted += [100.0 * share for share in row["over"].values()]
        shown = [float(x) for table in cells for x in re.findall(r"\d[\d.e+-]*", table[key])]
        np.testing.assert_allclose(shown[:4], wanted[:4], rtol=0.051)
        np.testing.assert_allclose(shown[4:], wanted[4:], atol=0.501)


def table_cells(section):
    lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in section.splitlines() if "|" in line]
    times = lines[0][2:]
    return {
        (row[0], row[1], time): cell for row in lines[2:] for time, cell in zip(times, row[2:], strict=True)
    }


def test_the_picture_is_drawn(quick):
    image = pytest.importorskip("PIL.Image").open(quick[0] / "accuracy.png")
    colours = {tuple(pixel) for pixel in np.asarray(image.convert("RGB")).reshape(-1, 3)}
    for tier in ((0x00, 0x72, 0xB2), (0x00, 0x9E, 0x73), (0xD5, 0x5E, 0x00), (0xCC, 0x79, 0xA7)):
        assert tier in colours


def test_reference_against_itself_is_zero():
    made = record(8, ("reference",), tuple(SITUATIONS), 0, 5.0)
    for row in made["rows"]:
        assert set(row["position"].values()) == {0.0}, row
        assert set(row["speed"].values()) == {0.0}, row
        assert set(row["over"].values()) == {0.0}, row


def test_same_command_same_figures(quick):
    again = record(16, ("swept", "engine"), ("ski", "blast"), 0, 5.0)
    wanted = [
        row
        for row in quick[1]["rows"]
        if row["situation"] in ("ski", "blast") and row["tier"] in ("swept", "engine")
    ]
    assert again["rows"] == wanted
    other = record(16, ("swept", "engine"), ("ski", "blast"), 1, 5.0)
    assert other["rows"] != wanted


def rolling_ski(starts, ticks):
    """As `ski`, on smooth waves of 256 m x 256 m about the origin."""
    y, x = np.mgrid[0:33, 0:33] * (2.0 * np.pi / 32.0)
    heights = 6.0 * (np.sin(x + np.cos(y)) + np.sin(2 * y - x))
    heights[-1], heights[:, -1] = heights[0], heights[:, 0]
    terrain = discjump.Terrain.from_heights(heights.astype(np.float32).astype(float), 8.0, (-128.0, -128.0))
    rng = np.random.default_rng(5)
    return SITUATIONS["ski"].make(rng, "waves", terrain, starts, ticks)


def test_authentic_stays_within_what_the_specification_says():
    """Section 12: float32 against float64 stays below 3.3 mm after 20 s on rolling terrain."""
    errors = measure.compare([rolling_ski(64, 625)], ["authentic"], lambda _: None)["authentic"]
    assert 0.0 < errors.position[-1].max() < 3.3e-3
    # What a map of 2 km adds is the coarser float32 far from its middle; few starts meet a doubtful contact.
    errors = measure.compare(plays("ski", 64, 625), ["authentic"], lambda _: None)["authentic"]
    assert np.median(errors.position[-1]) < 3.3e-3
    assert (errors.position[-1] > 0.01).mean() < 0.1


def test_a_nudge_is_a_millimetre():
    errors = measure.compare(plays("ski", 8, 3), ["nudged"], lambda _: None)["nudged"]
    np.testing.assert_allclose(errors.position, 0.001, rtol=1e-6)


def test_rows_are_numpys_quantiles():
    rng = np.random.default_rng(0)
    errors = measure.Errors(rng.lognormal(-4, 3, (157, 21)), rng.lognormal(-4, 3, (157, 21)))
    one, five = measure.rows("ski", "fast", errors)
    for row, tick in ((one, 31), (five, 156)):
        ordered = np.sort(errors.position[tick])
        # Of 21 values the median is the eleventh and the 95th percentile the twentieth.
        assert (row["position"]["median"], row["position"]["p95"]) == (ordered[10], ordered[19])
        assert row["speed"]["largest"] == errors.speed[tick].max()
        assert row["over"] == {limit: sum(ordered > float(limit)) / 21 for limit in ("0.01", "0.1", "1")}


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--tiers", "fats"], "--tiers"),
        (["--situations", "jump"], "--situations"),
        (["--starts", 0], "--starts"),
        (["--starts", "many"], "--starts"),
        (["--seed", -1], "--seed"),
    ],
)
def test_bad_options_are_refused_by_name(tmp_path, arguments, named):
    result = run(*arguments, "--quick", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert named in result.output
    assert str(arguments[1]) in result.output
    assert not (tmp_path / "out").exists()


def test_without_matplotlib_its_name_is_told_before_the_work(tmp_path, monkeypatch):
    real = builtins.__import__

    def refuse(name, *rest, **more):
        if name.split(".")[0] == "matplotlib":
            raise ImportError("No module named 'matplotlib'")
        return real(name, *rest, **more)

    for name in [m for m in sys.modules if m.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", refuse)
    result = run("--quick", "--out", tmp_path / "out")
    assert result.exit_code != 0
    assert "pip install matplotlib" in result.output
    assert not (tmp_path / "out").exists()


def test_committed_results_are_the_commands():
    """The page is the JSON's; the JSON's figures come out again. If not, run its command again."""
    figures = json.loads((COMMITTED / "accuracy.json").read_text())
    assert figures["command"] == "discjump accuracy --out core/docs/accuracy"
    assert (COMMITTED / "accuracy.md").read_text() == report.render(figures)
    compare_page(COMMITTED / "accuracy.md", figures)
    assert (COMMITTED / "accuracy.png").stat().st_size < 400_000

    names = ("ski", "crease")
    again = record(figures["starts"], tuple(figures["tiers"]), names, figures["seed"], figures["seconds"])
    wanted = [row for row in figures["rows"] if row["situation"] in names]
    assert len(again["rows"]) == len(wanted)
    for new, old in zip(again["rows"], wanted, strict=True):
        assert (new["situation"], new["tier"], new["over"]) == (old["situation"], old["tier"], old["over"])
        for name in ("position", "speed"):
            np.testing.assert_allclose(list(new[name].values()), list(old[name].values()), rtol=1e-9)


# What the situations are said to be.


@pytest.mark.parametrize("name", SITUATIONS)
def test_starts_are_shared_out_and_exact_in_float32(name):
    made = plays(name, starts=13, ticks=5)
    assert sum(len(play.position) for play in made) == 13
    assert len({play.name for play in made}) == len(made) == 4
    for play in made:
        for numbers in (play.position, play.velocity, play.yaw, play.inputs["turn"], play.inputs["pitch"]):
            np.testing.assert_array_equal(numbers, numbers.astype(np.float32))
        heights = play.terrain.heights
        np.testing.assert_array_equal(heights, heights.astype(np.float32))
        assert (play.position[:, 2] >= play.terrain.height(play.position[:, :2].copy())).all()


def slopes_at_random(terrain, count=20_000):
    xy = np.random.default_rng(0).uniform(-500.0, 500.0, (count, 2))
    return np.degrees(np.arccos(terrain.normal(xy)[:, 2]))


def test_slopes_of_the_grounds():
    for seed in range(4):
        assert np.median(slopes_at_random(grounds.steep(seed))) == pytest.approx(60.0, abs=1.0)
    for degrees in (30.0, 60.0):
        np.testing.assert_allclose(slopes_at_random(grounds.creased(degrees)), degrees, atol=1e-3)


def flight(play):
    """Height of the feet above the ground in `reference`, (ticks + 1, n)."""
    position = measure.run(play, "reference").position
    ground = play.terrain.height(position[..., :2].reshape(-1, 2).copy())
    return position[..., 2] - ground.reshape(position.shape[:2])


def test_crests_are_flown_over():
    highest = np.hstack([flight(play).max(axis=0) for play in plays("crest", 32, 156)])
    # A jump on level ground reaches 1.6 m.
    assert np.median(highest) > 3.2


def test_falls_hurt_as_they_should():
    for play in plays("landing", 32, 40):
        assert ((play.velocity[:, 2] <= -25.0) & (play.velocity[:, 2] >= -60.0)).all()
        sim = discjump.Simulator(play.terrain, len(play.position), fidelity="reference")
        state = sim.state()
        for name in ("position", "velocity", "yaw"):
            state[name] = getattr(play, name)
        sim.set_state(state)
        sim.step(play.inputs[0], ticks=40)
        damage = sim.state()["damage"]
        # 0.005 for each m/s beyond 25 (section 2), of at most 60 m/s and what a fall adds.
        assert 0.0 < np.median(damage) < 0.005 * (64.0 - 25.0)


def test_disc_jumps_start_from_rest_and_go_off():
    for play in plays("blast", 16, 40):
        speed = measure.run(play, "reference").speed
        assert not speed[JUMP].any()
        # The best jump and disc give 28.7 m/s more, the worst one of the eight delays some 12.
        assert speed[JUMP + 9].min() > 12.0
    fired = plays("blast", 16, FIRE + 2)[0].inputs["fire"]
    assert fired.sum(axis=0).tolist() == [1, 0] * (fired.shape[1] // 2)


def test_the_bridge_carries():
    standing = 0
    for play in plays("bridge", 32, 60):
        bare = Play(play.name, play.terrain, "sandbox", play.position, play.velocity, play.yaw, play.inputs)
        with_solids = measure.run(play, "reference").position[-1]
        without = measure.run(bare, "reference").position[-1]
        standing += (with_solids[:, 2] > without[:, 2] + 1.0).sum()
    assert standing >= 8


def test_jets_burn_a_third_to_a_half_of_the_time():
    inputs = scripts.bursts(np.random.default_rng(0), scripts.held(900, 50, jump=True))
    assert 0.28 < inputs["jet"].mean() < 0.52
    assert set(np.unique(inputs["strafe"])) == {-1, 0, 1}
