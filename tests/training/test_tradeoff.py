"""`discjump tradeoff`: what it writes, that it goes on where it stopped, and what it refuses."""

import importlib
import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from discjump.accuracy import measure
from discjump_training.tradeoff import paths, record, report, speed
from discjump_training.tradeoff.command import SECTIONS as NAMES
from discjump_training.tradeoff.command import tradeoff
from discjump_training.tradeoff.grid import QUICK, TRUTH, Config, Plan
from discjump_training.tradeoff.section import Panel
from discjump_training.tradeoff.sections import SECTIONS
from discjump_training.tradeoff.store import Missing, Store, code

TINY = replace(
    QUICK,
    tiers=("reference", "fast"),
    tick_ms=(32, 64),
    situations=("ski",),
    starts=4,
    seconds=1.024,
    episodes=2,
    players=32,
    num_envs=4,
    repeat_seconds=0.001,
)
EXACT = ("errors", "outcomes", "apex")
"""Sections whose results are the same every time."""
MEASURED = ("speed", "instructions", *EXACT)
"""All that train nothing."""


def run(*arguments):
    return CliRunner().invoke(tradeoff, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """The folder and the JSON of a quick run, trainings excepted."""
    out = tmp_path_factory.mktemp("tradeoff")
    result = run("--quick", "--sections", ",".join(MEASURED), "--out", out)
    assert result.exit_code == 0, result.output
    return out, json.loads((out / "tradeoff.json").read_text())


def test_quick_form_measures_every_configuration(quick):
    out, figures = quick
    assert figures["command"] == f"discjump tradeoff --sections {','.join(MEASURED)} --quick --out {out}"
    assert tuple(figures["sections"]) == MEASURED
    assert tuple(SECTIONS) == NAMES
    configs = {tuple(config.values()) for config in figures["configs"]}
    assert len(configs) == len(QUICK.tiers) * len(QUICK.tick_ms) * len(QUICK.surfaces)
    for name in ("speed", "errors", "outcomes"):
        rows = figures["sections"][name]["rows"]
        of = {(row["tier"], row["tick_ms"], row["surface"]) for row in rows if row["tier"] != paths.NUDGED}
        assert of == configs
    for row in figures["sections"]["speed"]["rows"]:
        low, middle, high = np.quantile(row["rates"], [0.25, 0.5, 0.75])
        assert list(row["rate"].values()) == pytest.approx([middle, low, high], rel=1e-12)
        seconds = row["tick_ms"] / 1000 * (row["frame_skip"] or 1)
        assert row["player_seconds_per_second"]["median"] == pytest.approx(middle * seconds, rel=1e-12)


def test_instructions_are_counted_where_valgrind_is(quick):
    rows = quick[1]["sections"]["instructions"]["rows"]
    if shutil.which("valgrind") is None:
        assert "valgrind" in quick[1]["sections"]["instructions"]["missing"]
        return
    counts = {(Config.of(row), row["lanes"]): row["per_player_tick"] for row in rows}
    assert len(counts) == len(rows) == (5 + 3) * len(QUICK.tick_ms) * len(QUICK.surfaces)
    for (config, lanes), count in counts.items():
        assert 50.0 < count < 5_000.0
        assert count <= counts[config, 1]
        # Slices are of a metre: longer ticks have more.
        if lanes == 1 and config.tick_ms == 64:
            assert count > counts[replace(config, tick_ms=32), 1]


def test_without_valgrind_the_rest_is_measured(tmp_path, monkeypatch):
    monkeypatch.setattr("discjump.bench.instructions.available", lambda: False)
    made = record.measure(TINY, ("instructions", "apex"), Store(tmp_path))
    assert made["instructions"]["rows"] == []
    assert "apt-get install valgrind" in made["instructions"]["missing"]
    assert made["apex"]["rows"]
    assert "Not counted: valgrind" in "\n".join(SECTIONS["instructions"].tables(made["instructions"]))
    # It is not taken for an answer once valgrind is there.
    with pytest.raises(Missing):
        SECTIONS["instructions"].run(TINY, Store(tmp_path, frozen=True), lambda _: None)


def test_the_truth_has_no_error(quick):
    sections = quick[1]["sections"]
    for name in ("errors", "outcomes"):
        own = [
            row for row in sections[name]["rows"] if Config.of(row) == TRUTH and row.get("frame_skip", 4) == 4
        ]
        assert own
        for row in own:
            if name == "errors":
                assert row["error"] in ("truth", "own")
                assert {value for at in row["at"] for value in at["position"].values()} == {0.0}
            else:
                assert {
                    value for key in ("seconds", "top_speed") for value in row[key]["difference"].values()
                } == {0}


def test_the_page_is_that_of_the_json(quick):
    out, figures = quick
    page = (out / "tradeoff.md").read_text()
    assert page == report.render(figures)
    short = page.split("## All configurations")[1].split("\n## ")[0]
    for row in figures["sections"]["errors"]["rows"]:
        if (row["situation"], row["error"]) == ("ski", "truth") and row["tier"] != paths.NUDGED:
            cell = search(rf"^\| {Config.of(row).name} \|.* (\S+) \((\S+)\) \|", short)
            wanted = [row["at"][-1]["position"][name] for name in ("median", "p95")]
            np.testing.assert_allclose([float(x) for x in cell.groups()], wanted, rtol=0.051)


def search(pattern, text):
    found = re.search(pattern, text, re.MULTILINE)
    assert found is not None, pattern
    return found


def test_the_picture_shows_who_is_not_beaten(quick):
    image = pytest.importorskip("PIL.Image").open(quick[0] / "tradeoff.png")
    colours = {tuple(pixel) for pixel in np.asarray(image.convert("RGB")).reshape(-1, 3)}
    # `fast` is the fastest of all, and in grey there is always somebody.
    assert (0xD5, 0x5E, 0x00) in colours
    assert (204, 204, 204) in colours


def test_the_same_command_again_measures_nothing(quick, monkeypatch):
    out, figures = quick

    def refuse(*arguments):
        raise AssertionError("measured again")

    for name in ("speed.clock.prepare", "paths.run", "outcomes.play", "apex.apexes"):
        monkeypatch.setattr(f"discjump_training.tradeoff.{name}", refuse)
    assert run("--quick", "--sections", ",".join(MEASURED), "--out", out).exit_code == 0
    assert json.loads((out / "tradeoff.json").read_text()) == figures


class Stopped:
    """A progress bar that a user interrupts."""

    def __init__(self, after):
        self.left = after

    def __call__(self, _):
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt


@pytest.mark.parametrize("name", EXACT)
def test_interrupted_is_uninterrupted(name, tmp_path):
    section = SECTIONS[name]
    whole = section.run(TINY, Store(tmp_path / "whole"), lambda _: None)
    stops = 0
    while True:
        try:
            broken = section.run(TINY, Store(tmp_path / "broken"), Stopped(after=stops + 1))
        except KeyboardInterrupt:
            stops += 1
            continue
        break
    assert stops >= 2
    assert broken == whole
    left, right = ({path.name for path in (tmp_path / of).rglob("*.json")} for of in ("whole", "broken"))
    assert left == right


def test_rounds_of_the_clock_are_kept(tmp_path):
    store = Store(tmp_path)
    timings = SECTIONS["speed"].work(TINY)
    with pytest.raises(KeyboardInterrupt):
        SECTIONS["speed"].run(TINY, store, Stopped(after=timings // 2))
    kept = {path: path.read_bytes() for path in tmp_path.rglob("*.json")}
    assert len(kept) == 1
    done: list[int] = []
    made = SECTIONS["speed"].run(TINY, store, done.append)
    assert sum(done) == timings
    assert all(path.read_bytes() == content for path, content in kept.items())
    first = json.loads(next(iter(kept.values())))["made"]
    for row, seconds in zip(made["rows"], first, strict=True):
        assert 1.0 / seconds in row["rates"]


def test_another_option_remakes_what_depends_on_it_alone(tmp_path):
    store = Store(tmp_path)
    for name in EXACT:
        SECTIONS[name].run(TINY, store, lambda _: None)
    other = replace(TINY, starts=8)
    frozen = Store(tmp_path, frozen=True)
    with pytest.raises(Missing):
        SECTIONS["errors"].run(other, frozen, lambda _: None)
    for name in ("outcomes", "apex"):
        SECTIONS[name].run(other, frozen, lambda _: None)
    for fewer in (replace(TINY, tiers=("fast",)), replace(TINY, tick_ms=(64,))):
        for name in EXACT:
            SECTIONS[name].run(fewer, frozen, lambda _: None)


def test_a_damaged_piece_is_made_again(tmp_path):
    store = Store(tmp_path)
    made = store.piece("apex", {"of": 1}, lambda: {"is": (1.5, None)})
    assert made == {"is": [1.5, None]}
    (path,) = tmp_path.rglob("*.json")
    for content in (b"", b'{"identity": {"of": 1', b'{"identity": {"of": 2}, "made": 0}', b"7", b"\xff"):
        path.write_bytes(content)
        assert store.piece("apex", {"of": 1}, lambda: 3) == 3
    assert store.piece("apex", {"of": 1}, lambda: 4) == 3
    with pytest.raises(ValueError, match="JSON"):
        store.piece("apex", {"of": 5}, lambda: float("nan"))
    assert list(tmp_path.rglob("*.*")) == [path]


def test_code_is_what_is_in_the_files(tmp_path, monkeypatch):
    package = tmp_path / "measuring"
    (package / "deep").mkdir(parents=True)
    for name in ("__init__.py", "deep/one.py", "tuned.toml", "notes.txt"):
        (package / name).write_text("1")
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("measuring")
    before = code(module)
    (package / "notes.txt").write_text("2")
    assert code(module) == before
    seen = {before, code(str(package / "tuned.toml"))}
    for name in ("deep/one.py", "tuned.toml"):
        (package / name).write_text("2")
        seen.add(code(module))
    assert len(seen) == 4


def test_ctrl_c_says_how_to_go_on(tmp_path, monkeypatch):
    real, calls = measure.run, []

    def interrupted(*arguments):
        calls.append(arguments)
        if len(calls) == 8:
            raise KeyboardInterrupt
        return real(*arguments)

    monkeypatch.setattr("discjump_training.tradeoff.paths.run", interrupted)
    words = [
        "--quick",
        "--sections",
        "errors",
        "--tiers",
        "fast, reference",
        "--tick-ms",
        "32",
        "--starts",
        "4",
    ]
    result = run(*words, "--anew", "--out", tmp_path)
    assert result.exit_code == 130
    again = "discjump tradeoff --sections errors --tiers reference,fast --tick-ms 32 --starts 4 --quick --out"
    assert f"Go on with: {again} {tmp_path}" in result.output
    assert not (tmp_path / "tradeoff.json").exists()
    result = run(*words, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    made = json.loads((tmp_path / "tradeoff.json").read_text())
    assert list(made["sections"]) == ["errors"]
    # Nothing to draw without speeds.
    assert not (tmp_path / "tradeoff.png").exists()
    whole = SECTIONS["errors"].run(Plan(**tupled(made["plan"])), Store(tmp_path / "other"), lambda _: None)
    assert made["sections"]["errors"] == whole


def tupled(plan):
    return {key: tuple(value) if isinstance(value, list) else value for key, value in plan.items()}


def test_anew_measures_again_and_shows_the_rest(tmp_path):
    store = Store(tmp_path)
    made = record.measure(TINY, ("speed", *EXACT), store)
    again = record.measure(TINY, ("speed",), store, anew=True)
    assert all(again[name] == made[name] for name in EXACT)
    rates = [[row["rates"] for row in of["speed"]["rows"]] for of in (made, again)]
    assert rates[0] != rates[1]


def test_panels_have_both_speed_and_error(quick):
    sections = quick[1]["sections"]
    axis = speed.speeds(sections["speed"])
    panels = [panel for name in EXACT for panel in SECTIONS[name].panels(sections[name], axis)]
    assert len(panels) == 3
    for panel in panels:
        assert isinstance(panel, Panel)
        assert len(panel.points) == len(quick[1]["configs"])
        assert all(low <= median <= high for median, low, high in (point.speed for point in panel.points))
        (truth,) = [point for point in panel.points if point.config == TRUTH]
        assert truth.error == 0.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tiers", "fats"], "'fats' is none of reference, authentic, swept, fast, engine"),
        (["--sections", "speed,errors,nothing"], "'nothing' is none of speed, instructions, errors"),
        (["--tick-ms", "10"], "'10' is none of 8, 16, 32, 64"),
        (["--tick-ms", ""], "'' is none of 8, 16, 32, 64"),
        (["--surfaces", "spheres"], "'spheres' is none of triangles, bilinear"),
        (["--frame-skips", "1,3"], "'3' is none of 1, 2, 4, 8"),
        (["--starts", "3"], "--starts"),
        (["--episodes", "513"], "--episodes"),
        (["--repeats", "many"], "--repeats"),
    ],
)
def test_mistakes_are_explained(arguments, message, tmp_path):
    result = run(*arguments, "--quick", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert message in result.output
    assert not (tmp_path / "out").exists()


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "out").write_text("mine")
    result = run("--quick", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "--out" in result.output
    assert (tmp_path / "out").read_text() == "mine"


def test_the_committed_page_is_that_of_its_figures():
    """If not, run the command again in the folder of its pieces: nothing is measured anew."""
    folder = Path(__file__).parents[2] / "training" / "results" / "tradeoff"
    figures = json.loads((folder / "tradeoff.json").read_text())
    assert (folder / "tradeoff.md").read_text() == report.render(figures)
    assert (folder / "tradeoff.png").stat().st_size < 400_000
    rows = figures["sections"]["errors"]["rows"]
    assert {Config.of(row) for row in rows if row["tier"] != paths.NUDGED} == set(Plan().configs())
