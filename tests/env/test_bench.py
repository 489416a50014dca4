"""`discjump bench`: every mode runs through, and what cannot be measured says why."""

import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from discjump._native import time_environments, time_players, time_resets
from discjump.bench import figure, peers
from discjump.bench.clock import Effort, Ready, Timed, Times, Unavailable, interleave
from discjump.bench.ways import Agents, Players, Vector, random_actions
from discjump.cli import main
from discjump.simulator import Simulator
from discjump.terrains import generated

QUICK = Effort(3, 0.001, quick=True)


def bench(*words: str, out: Path) -> tuple[str, dict[str, Any]]:
    result = CliRunner().invoke(main, ["bench", *words, "--quick", "--out", str(out)])
    assert result.exit_code == 0, result.output
    return result.output, json.loads(out.read_text())


def test_every_figure_has_a_line_and_its_spread(tmp_path: Path) -> None:
    output, made = bench("--figures", out=tmp_path / "bench.json")
    assert made["machine"]["processor"] in output
    assert made["machine"]["lanes"]["players"] in (1, 8, 16, 32)
    whats = [row["what"] for row in made["figures"]]
    assert len(set(whats)) == len(whats)
    for row in made["figures"]:
        assert f"| {row['what']} |" in output
        if "missing" in row:
            assert "lanes" in row["missing"]
            continue
        assert row["low"] <= row["median"] <= row["high"]
        asked, at_least = row["asked"], row["at_least"]
        expected = None if asked is None else (row["median"] >= asked) is at_least or row["median"] == asked
        assert row["met"] == expected
        if row["unit"] in ("M/s", "times", "bytes"):
            assert row["low"] > 0


def test_sizes_are_stepped_each_way_at_the_frame_skip_asked_for(tmp_path: Path) -> None:
    words = ("--num-envs", "1", "--num-envs", "3", "--frame-skip", "2", "--threads", "1")
    output, made = bench(*words, out=tmp_path / "bench.json")
    assert [(row["num_envs"], row["way"]) for row in made["rows"]] == [
        *((1, way) for way in ("Rust", "make_vec", "sb3", "make")),
        *((3, way) for way in ("Rust", "make_vec", "sb3")),
    ]
    assert made["frame_skip"] == 2
    row = made["rows"][0]
    assert f"| {2 * row['median']:,.0f} |" in output


def test_parts_of_a_step_are_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("discjump.bench.parts.measure.__defaults__", ((1, 512),))
    picture = tmp_path / "deep" / "bench.png"
    _, made = bench("--picture", str(picture), out=tmp_path / "bench.json")
    assert picture.read_bytes().startswith(b"\x89PNG")
    for row in made["parts"]:
        assert {"rest", "python"} <= row["parts_ns"].keys()
        assert sum(row["parts_ns"].values()) >= 0.999 * row["vector_ns"]


def test_a_peer_that_is_absent_says_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = importlib.import_module

    def absent(name: str, package: str | None = None) -> Any:
        if name == "envpool":
            raise ModuleNotFoundError("No module named 'envpool'")
        return real(name, package)

    monkeypatch.setattr(importlib, "import_module", absent)
    monkeypatch.setattr("discjump.bench.peers.measure.__defaults__", ((1, 64),))
    output, made = bench("--peers", out=tmp_path / "bench.json")
    assert peers.INSTALL in output
    for row in made["peers"]:
        assert ("missing" in row) == row["name"].startswith("EnvPool")
        if row["name"].startswith("gymnasium"):
            assert row["observation"] == 4
            assert row["ours_over_this"]["median"] > 0


def test_training_needs_figures(tmp_path: Path) -> None:
    result = CliRunner().invoke(main, ["bench", "--training", "--out", str(tmp_path / "bench.json")])
    assert result.exit_code == 2
    assert "--training goes with --figures" in result.output


def test_lanes_that_the_processor_lacks_are_no_failure() -> None:
    case = Players(32, 1, lanes=5)
    missing = interleave([case], QUICK, "")[case]
    assert isinstance(missing, Unavailable)
    assert str(missing) == "this processor has no 5 lanes"


class Pretended:
    """A case whose clock counts calls: 2 s for each."""

    units = 10

    def __init__(self, calls: int | None) -> None:
        self.calls = calls
        self.asked: list[int] = []

    def make(self) -> Ready:
        def timed(calls: int) -> float:
            self.asked.append(calls)
            return 2.0 * calls

        return Ready(timed)


def test_cases_take_turns_and_calls_fill_a_repeat() -> None:
    free, fixed = Pretended(None), Pretended(7)
    times = interleave([free, fixed, free], Effort(3, 100.0), "")
    timed = times[free]
    assert isinstance(timed, Timed)
    np.testing.assert_array_equal(timed.seconds, [2.0] * 3)
    np.testing.assert_array_equal(timed.rate, [5.0] * 3)
    assert free.asked[-3:] == [50, 50, 50]
    assert fixed.asked == [1, 7, 7, 7]


def test_figures_are_reckoned_from_seconds_a_call() -> None:
    """By hand: 10 units in 2 s or in 4 s."""
    fast, slow = Pretended(None), Pretended(None)
    times: Times = {
        fast: Timed(np.array([2.0]), 10, 0, 0),
        slow: Timed(np.array([4.0]), 10, 0, 0),
    }

    def reached(made: figure.Figure) -> float:
        value: float = figure.row(made, times)["median"]
        return value

    assert reached(figure.rate("", slow)) == 2.5e-6
    assert reached(figure.ratio("", (slow, fast), 2.0, at_least=False)) == 2.0
    assert reached(figure.call("", slow)) == 4e6
    assert reached(figure.beside("", slow, fast, per_unit=False)) == 2e6
    assert reached(figure.beside("", slow, fast, per_unit=True)) == 2e5
    times[slow] = Unavailable("gone")
    assert figure.row(figure.ratio("", (slow, fast), 2.0, at_least=False), times)["missing"] == "gone"


def test_rust_and_gymnasium_play_the_same_batch() -> None:
    """What the bench calls the same step is: the way in from Rust leaves the bits that `step` leaves."""
    batch, other = Agents(40, threads=1).batch(), Agents(40, threads=1).batch()
    actions = random_actions(40, np.int8)
    seconds, _ = time_environments(batch, actions, 20)
    for call in range(20):
        other.step(actions[call % len(actions)])
    assert seconds > 0
    assert batch.digest() == other.digest()
    assert Vector(40).units == Agents(40).units == 40


def test_resets_from_rust_are_resets_by_mask() -> None:
    batch, other = Agents(3, threads=1).batch(), Agents(3, threads=1).batch()
    assert time_resets(batch, 4) > 0
    for index in (0, 1, 2, 0):
        other.reset(None, np.arange(3) == index)
    assert batch.digest() == other.digest()


def test_the_native_clock_refuses_what_does_not_fit() -> None:
    batch = Agents(4, threads=1).batch()
    for shape in ((0, 4, 5), (2, 3, 5), (2, 4, 4)):
        with pytest.raises(ValueError, match=r"actions: expected shape \(k, 4, 5\) with k >= 1, got"):
            time_environments(batch, np.zeros(shape, np.int8), 1)
    with pytest.raises(ValueError, match=r"actions\[1, 0\]"):
        time_environments(batch, np.full((1, 4, 5), [[0] * 5, [9] * 5, [0] * 5, [0] * 5], np.int8), 1)
    sim = Simulator(generated(7), 3, scene="ski", threads=1)
    with pytest.raises(ValueError, match="inputs: expected k times 72 bytes with k >= 1, got 71"):
        time_players(sim._native, b"x" * 71, 1, 1)


def test_copies_and_answers_are_measured(tmp_path: Path) -> None:
    output, made = bench("--copies", out=tmp_path / "bench.json")
    for row in made["copies"]:
        assert f"| {row['what']} |" in output
        assert 0 < row["low"] <= row["median"] <= row["high"]
    answers = [row for row in made["copies"] if row["unit"] == "ms"]
    assert len(answers) == 7
    # Below 100 ms is measured, not tested; a call that ignored the signal would have had no end.
    assert all(len(row["values"]) == 2 for row in answers)
