"""One test for each defect that was found and mended; each opens with what it caught."""

import json
import shlex
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from click.testing import CliRunner, Result

from discjump import Simulator, Terrain, cli
from discjump._results import save
from discjump.replays import Recorder, record


def flat(squares: int = 8, size: float = 8.0) -> Terrain:
    """Level ground."""
    return Terrain.from_heights(np.zeros((squares + 1, squares + 1)), square_size=size, edge="clamp")


def run(*words: object) -> Result:
    """The command `discjump` with these words."""
    return CliRunner().invoke(cli.main, [str(word) for word in words])


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A replay of two decisions."""
    env: Recorder = record(gymnasium.make("discjump/Ski-v0", time_limit=0.2, terrain_seeds=[0]))
    env.reset(seed=7)
    while not env.replays:
        env.step(np.array([2, 1, 1, 0, 3]))
    return env.replays[0].save(tmp_path / "run.replay")


def test_terrains_are_pickled_after_a_plain_import() -> None:
    """`import discjump` alone knew no rule for pickling a terrain: workers got "cannot pickle"."""
    code = (
        "import pickle, discjump, numpy as np\n"
        "terrain = discjump.Terrain.from_heights(np.zeros((3, 3)))\n"
        "assert pickle.loads(pickle.dumps(terrain)).digest() == terrain.digest()\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_positions_of_a_state_are_points_wherever_they_lie() -> None:
    """A single row of a packed state counts as contiguous at any address, and was refused as misaligned."""
    terrain = flat()
    sim = Simulator(terrain, 4, threads=1)
    for k in range(4):
        position = sim.state()[k : k + 1]["position"]
        assert terrain.height(position[:, :2]).tolist() == [0.0]


@pytest.mark.parametrize("name", ["num_players", "players_per_world", "tick_ms", "threads"])
def test_huge_numbers_are_refused_by_name(name: str) -> None:
    """Numbers beyond 64 bits ended as "int too big to convert"."""
    for value in (2**32, 2**64, 10**30):
        with pytest.raises(ValueError, match=f"{name}: expected"):
            Simulator(flat(), **{name: value})  # type: ignore[arg-type]


def test_switches_and_seeds_are_checked_by_name() -> None:
    """`physics=0` was taken as none, `physics="x"` ended in an AttributeError, and any seed was taken."""
    for wrong in (0, "x", {"ski_bug": True}):
        with pytest.raises(TypeError, match=r"physics: expected a discjump\.Physics"):
            Simulator(flat(), physics=wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="seed: expected"):
        Simulator(flat(), seed="x")  # type: ignore[arg-type]


def test_ragged_points_are_refused_by_name() -> None:
    """numpy's own message came through, which does not know the argument."""
    with pytest.raises(ValueError, match="points: expected"):
        Simulator(flat(), 2, threads=1).explode([[0.0, 0.0], [1.0]])


@pytest.mark.parametrize(
    "words",
    [
        ("bisect", "a", "b", "--tolerance", "nan"),
        ("features", "--seconds", "nan"),
        ("falloff", "--farthest", "nan"),
        ("stress", "--long", "--scale", "nan"),
        ("bench", "--seconds", "nan"),
    ],
)
def test_options_refuse_nan_by_name(words: tuple[str, ...]) -> None:
    """NaN is neither below nor above a limit: a traceback of one command, a wrong finding of another."""
    result = run(*words)
    assert result.exit_code == 2
    assert f"Invalid value for '{words[-2]}'" in result.output


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    """Commands that could not write their results ended in a traceback."""
    (tmp_path / "file").touch()
    result = run("features", "--starts", 4, "--seconds", 1, "--out", tmp_path / "file" / "figures.json")
    assert result.exit_code == 1
    assert isinstance(result.exception, SystemExit)
    assert f"Error: {tmp_path / 'file'}: " in result.output


@pytest.mark.parametrize("change", ["seed=abc", "seed=-1", "episode=0.5"])
def test_bisect_names_a_wrong_seed_and_says_that_it_could_not_run(recording: Path, change: str) -> None:
    """A traceback, with the exit status that means "they part"."""
    result = run("bisect", recording, change)
    assert result.exit_code == 2
    assert f"Error: {change.partition('=')[0]}: expected" in result.output


def test_bisect_says_that_it_could_not_write(recording: Path, tmp_path: Path) -> None:
    """The same where the finding could not be written."""
    (tmp_path / "file").touch()
    for change in ("threads=1", "armor=heavy"):
        assert run("bisect", recording, change, "--out", tmp_path / "file" / "out").exit_code == 2


@pytest.mark.parametrize("part", ["digests", "rows", "versions", "machine"])
def test_bisect_refuses_a_malformed_certificate(part: str, tmp_path: Path) -> None:
    """An AttributeError, with the exit status that means "they part"."""
    whole = {"schema": "discjump-certificate/1", "digests": {}, "rows": [], "versions": {}, "machine": {}}
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    good.write_text(json.dumps(whole))
    bad.write_text(json.dumps({**whole, part: [3]}))
    assert run("bisect", good, good).exit_code == 0
    result = run("bisect", good, bad)
    assert result.exit_code == 2
    assert f"{bad}: expected a certificate" in result.output


def test_where_observations_part_bisect_says_how_to_go_on(recording: Path, tmp_path: Path) -> None:
    """It advised to compare the replay with itself: options of the task were left out."""
    result = run("bisect", recording, "fan_bearings=[0]", "--out", tmp_path)
    assert result.exit_code == 1
    figures = json.loads((tmp_path / "bisect.json").read_text())
    words = shlex.split(figures["command"])
    assert words[-1] == "fan_bearings=[0]"
    assert run(*words[1:], "--out", tmp_path).exit_code == 1


def test_stress_names_an_empty_file(tmp_path: Path) -> None:
    """numpy's EOFError was taken for a user's abort."""
    (tmp_path / "heights.npy").touch()
    result = run("stress", "--terrain", tmp_path / "heights.npy", "--quick", "--out", tmp_path)
    assert result.exit_code == 1
    assert "heights.npy: " in result.output


@pytest.mark.parametrize(
    "words", [("--quick",), ("--seed", "3"), ("--tiers", "fast"), ("--extremes", "plain")]
)
def test_the_long_form_refuses_what_it_would_not_heed(words: tuple[str, ...], tmp_path: Path) -> None:
    """It began hours of something else than was asked."""
    result = run("stress", "--long", *words, "--out", tmp_path)
    assert result.exit_code == 2
    assert f"{words[0]}: expected" in result.output


def test_a_picture_of_another_kind_is_refused(recording: Path, tmp_path: Path) -> None:
    """Pillow's ValueError came through, after the whole episode had been played."""
    result = run("replay", recording, "--render", tmp_path / "picture")
    assert result.exit_code == 1
    assert "expected a file that ends in .png" in result.output


def test_the_long_form_names_a_result_that_it_cannot_read(tmp_path: Path) -> None:
    """A result that was cut off while it was written ended every later run in a traceback."""
    (tmp_path / "long.json").write_text('{"comm')
    result = run("stress", "--long", "--scale", "1e-6", "--out", tmp_path)
    assert result.exit_code == 1
    assert "long.json: expected an earlier result" in result.output


def test_results_are_written_whole_or_not_at_all(tmp_path: Path) -> None:
    """Figures were written in place: who was stopped in the middle lost those that had been there."""
    save(tmp_path / "figures.json", {"a": 1})
    with pytest.raises(TypeError):
        save(tmp_path / "figures.json", {"a": object()})
    (tmp_path / "figures.json.new").mkdir()
    with pytest.raises(OSError, match="new"):
        save(tmp_path / "figures.json", {"a": 2})
    assert json.loads((tmp_path / "figures.json").read_text()) == {"a": 1}
