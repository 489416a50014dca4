"""`discjump replay` and `discjump bisect` as one types them, other installations included."""

import json
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import discjump
from discjump import cli
from discjump.replays import load

from .recordings import episode, ticks

LONG: dict[str, Any] = {"terrain_seeds": [0], "time_limit": 30.0}


def run(*arguments: object) -> Any:
    return CliRunner().invoke(cli.main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    made: Path = tmp_path_factory.mktemp("replays")
    episode(seed=4, **LONG).save(made / "run.replay")
    ticks().save(made / "ticks.replay")
    return made


# ------------------------------------------------------------------------------------ replay


def test_a_card_says_what_it_is(folder):
    result = run("replay", folder / "run.replay")
    assert result.exit_code == 0, result.output
    for text in ("discjump/Ski-v0", "number 0 of seed 4", "time_limit=30.0", "authentic", " bytes"):
        assert text in result.output
    result = run("replay", folder / "ticks.replay", "--json")
    card = json.loads(result.output)
    assert (card["scene"], card["ticks"]) == ("disc_jump", "90 of 32 ms")
    assert "its heights are in the file" in card["terrain"]


def test_verify_passes_and_fails(folder, tmp_path):
    result = run("replay", "--verify", folder)
    assert result.exit_code == 0, result.output
    assert "2 of 2 replays are as recorded" in result.output
    replay = load(folder / "run.replay")
    replay.changed({"seed": 5}).save(tmp_path / "a.replay")
    rows = replay.arrays["actions"].copy()
    rows[20, 4] = (rows[20, 4] + 1) % 7
    replay.changed(arrays={"actions": rows}).save(tmp_path / "b.replay")
    replay.changed({"id": "discjump/Ski-v9"}).save(tmp_path / "c.replay")
    (tmp_path / "d.replay").write_bytes(b"nothing of the kind")
    (tmp_path / "e.replay").write_bytes((folder / "run.replay").read_bytes())
    result = run("replay", "--verify", tmp_path)
    assert result.exit_code == 1
    assert "a.replay: state differs at the beginning" in result.output
    assert "b.replay: state differs after one of the decisions 17 to 24" in result.output
    assert "c.replay: id: this recording needs discjump/Ski-v9" in result.output
    assert "d.replay: expected a replay of discjump" in result.output
    assert "1 of 5 replays are as recorded" in result.output
    result = run("replay", "--verify", "--json", tmp_path / "b.replay")
    told = json.loads(result.output)
    assert (told["verified"], "decisions 17 to 24" in told["mismatch"]) == (False, True)


def test_render(folder, tmp_path):
    image = pytest.importorskip("PIL.Image")
    result = run("replay", folder / "run.replay", "--render", tmp_path / "deep" / "map.png")
    assert result.exit_code == 0, result.output
    assert len(np.unique(np.asarray(image.open(tmp_path / "deep" / "map.png")))) > 50
    result = run("replay", folder / "ticks.replay", "--render", tmp_path / "none.png")
    assert result.exit_code == 1
    assert "expected the replay of an environment" in result.output
    assert run("replay", folder, "--render", tmp_path / "none.png").exit_code == 2
    assert not (tmp_path / "none.png").exists()


def test_a_folder_without_replays(tmp_path):
    result = run("replay", tmp_path)
    assert result.exit_code == 1
    assert "expected replays (*.replay)" in result.output


# ------------------------------------------------------------------------------------ bisect


def test_bisect_of_tiers(folder, tmp_path):
    result = run("bisect", folder / "run.replay", "fidelity=fast", "--out", tmp_path)
    assert result.exit_code == 1, result.output
    figures = json.loads((tmp_path / "bisect.json").read_text())
    assert f"apart after tick {figures['tick']} (" in result.output
    assert f"{figures['ulps']:,} ULP of float32" in result.output
    assert figures["field"] == "state.position[0]"
    assert figures["inputs"].startswith("forward ")
    assert load(tmp_path / "bisect.replay").verify() is None
    command = figures["command"].split()[1:]
    again = run(*command, "--out", tmp_path / "again")
    assert again.exit_code == 1
    assert "apart after tick 1 (0.032 s), player 0" in again.output
    found = json.loads((tmp_path / "again" / "bisect.json").read_text())
    assert {name: found[name] for name in ("field", "a", "b", "ulps")} == {
        name: figures[name] for name in ("field", "a", "b", "ulps")
    }


def test_bisect_of_the_same(folder, tmp_path):
    result = run("bisect", folder / "run.replay", "batch=3", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    assert "the same in every bit: " in result.output
    assert json.loads((tmp_path / "bisect.json").read_text())["same"] is True
    assert not (tmp_path / "bisect.replay").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fidelity=fast", "fidelity=swept"], "expected the file of a replay first"),
        (["none.replay", "x=1"], "none.replay"),
        (["run.replay", "python=/no/such/python"], "expected an interpreter"),
        (["run.replay", f"python={sys.executable},fidelity=exact"], "fidelity: expected one of"),
    ],
)
def test_mistakes_are_explained(folder, tmp_path, arguments, message):
    words = [str(folder / word) if word.endswith(".replay") else word for word in arguments]
    result = run("bisect", *words, "--out", tmp_path)
    assert result.exit_code == 2, result.output
    assert message in result.output
    assert "Traceback" not in result.output


# ------------------------------------------------------------------------------------ other installations


NUDGE = """
import numpy as np
from discjump.envs.named import SkiEnv
from discjump import Simulator

def step(self, action, step=SkiEnv.step):
    self.ticks = getattr(self, "ticks", 0) + 1
    return step(self, action)

def state(self, state=SkiEnv.state):
    seen = state(self)
    if self.options.frame_skip == 1 and getattr(self, "ticks", 0) >= 37:
        seen["velocity"][1] = np.nextafter(seen["velocity"][1], np.float32(np.inf))
    return seen

SkiEnv.step, SkiEnv.state = step, state
"""
"""A release that is off by one unit in the last place from tick 37 on."""

OLDER = """
import discjump, gymnasium
del gymnasium.registry["discjump/Ski-v0"]
"""

LOST = "import sys; sys.path[:] = [place for place in sys.path if 'lib' in place and 'site' not in place]"


def installation(folder: Path, code: str) -> Path:
    """An interpreter that runs `code` first."""
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(code)
    ours = Path(discjump.__file__).parents[1]
    python = folder / "python"
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{folder}:{ours}" exec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    return python


def test_another_installation_plays_the_same(folder, tmp_path):
    python = installation(tmp_path / "other", "")
    for name in ("run.replay", "ticks.replay"):
        result = run("bisect", folder / name, f"python={python}", "--out", tmp_path)
        assert result.exit_code == 0, result.output
        assert "the same in every bit" in result.output
        assert str(Path(discjump.__file__)) in result.output.splitlines()[1]


def test_a_release_that_is_off_by_a_bit_is_found(folder, tmp_path):
    python = installation(tmp_path / "other", NUDGE)
    result = run("bisect", folder / "run.replay", f"python={python}", "--out", tmp_path)
    assert result.exit_code == 1, result.output
    figures = json.loads((tmp_path / "bisect.json").read_text())
    assert (figures["tick"], figures["field"], figures["ulps"]) == (37, "state.velocity[1]", 1)
    assert figures["command"].endswith(f"python={python}")
    assert len(load(tmp_path / "bisect.replay").arrays["inputs"]) > 36
    # The other way round: the replay is still of the side that plays here.
    result = run("bisect", f"{folder / 'run.replay'},python={python}", "python=null", "--out", tmp_path)
    assert result.exit_code == 1, result.output
    assert load(tmp_path / "bisect.replay").verify() is None


def test_an_installation_that_cannot_play_it_says_so(folder, tmp_path):
    older = installation(tmp_path / "older", OLDER)
    result = run("bisect", folder / "run.replay", f"python={older}", "--out", tmp_path)
    assert result.exit_code == 2
    assert "this recording needs discjump/Ski-v0" in result.output
    lost = installation(tmp_path / "lost", LOST)
    result = run("bisect", folder / "run.replay", f"python={lost}", "--out", tmp_path)
    assert result.exit_code == 2
    assert "its worker ended with status 1" in result.output
    assert "ModuleNotFoundError" in result.output


def test_no_worker_is_left_behind(folder, tmp_path):
    """The worker is in the middle of its frames when the difference is found."""
    pids = tmp_path / "pids"
    python = installation(
        tmp_path / "other", NUDGE + f"\nimport os; open({str(pids)!r}, 'a').write(f'{{os.getpid()}}\\n')"
    )
    run("bisect", folder / "run.replay", f"python={python}", "--out", tmp_path)
    (pid,) = pids.read_text().split()
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid), 0)


# ------------------------------------------------------------------------------------ certificates


def certificate(path: Path, digests: dict[str, dict[str, str]], failed: bool = False) -> Path:
    rows = [{"subject": "discjump/Ski-v0", "tier": "fast", "row": "threads", "result": "fail"}]
    record = {
        "schema": "discjump-certificate/1",
        "versions": {"discjump": "0.1.0"},
        "machine": {"processor": "a processor"},
        "digests": {
            subject: {tier: {"digest": digest, "environments": 2} for tier, digest in tiers.items()}
            for subject, tiers in digests.items()
        },
        "rows": rows if failed else [],
    }
    path.write_text(json.dumps(record))
    return path


def test_certificates_are_compared(tmp_path):
    ski, mission = "discjump/Ski-v0", "scene mission"
    a = certificate(tmp_path / "a.json", {ski: {"fast": "1", "swept": "2"}, mission: {"fast": "3"}})
    b = certificate(tmp_path / "b.json", {ski: {"fast": "1", "swept": "9"}, mission: {}}, failed=True)
    result = run("bisect", a, b)
    assert result.exit_code == 1, result.output
    assert "1 of 2 digests that both have are equal" in result.output
    assert "differ: discjump/Ski-v0, swept" in result.output
    assert "fails by itself: discjump/Ski-v0, fast, threads" in result.output
    assert "say which interpreter has the other build" in result.output
    assert run("bisect", a, a).exit_code == 0
    for other, message in ((tmp_path / "c.json", "expected a certificate like A"), (f"{b},seed=3", "seed")):
        result = run("bisect", a, other)
        assert result.exit_code == 2
        assert message in result.output


def test_builds_of_certificates_are_run_against_each_other(tmp_path):
    """The episodes are those that the certificates' digests are of."""
    pytest.importorskip("discjump.verify")
    a = certificate(tmp_path / "a.json", {"discjump/Ski-v0": {"authentic": "1"}})
    b = certificate(tmp_path / "b.json", {"discjump/Ski-v0": {"authentic": "2"}})
    python = installation(tmp_path / "other", NUDGE)
    result = run("bisect", a, f"{b},python={python}", "--out", tmp_path)
    assert result.exit_code == 1, result.output
    assert "discjump/Ski-v0, authentic, seed 0" in result.output
    assert json.loads((tmp_path / "bisect.json").read_text())["tick"] == 37
    same = installation(tmp_path / "same", "")
    result = run("bisect", a, f"{b},python={same}", "--out", tmp_path)
    assert result.exit_code == 0, result.output
