"""`discjump verify`: that it passes what is deterministic, and catches by name what is not.

Contract: the bits of a rollout depend on seeds and actions alone. Whoever keeps a certificate in CI relies on
every axis being played, and on a broken environment failing the row that names what it depends on.
"""

import json
import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from discjump import cli
from discjump.simulator import FIDELITIES, SCENES
from discjump.verify import Certificate, compare, verified, verify
from discjump.verify.certificate import BadCertificate
from discjump.verify.children import METHODS, Child
from discjump.verify.environments import Environment, ids
from discjump.verify.form import FULL, QUICK, configurations
from discjump.verify.matrix import Outcome
from discjump.verify.parts import ulps

from . import broken

SHORT = {"terrain_seeds": [0, 1], "goal_distance": (20.0, 60.0), "time_limit": 4.0}
GOLDEN = Path(__file__).parents[1] / "golden" / "certificate.json"


def double(kind):
    """A double of the id in the fast tier, with short episodes."""

    def make(id, **options):
        options.pop("vectorization_mode", None)
        return kind(**options)

    return Environment("discjump/Ski-v0", "fast", make, SHORT)


def failing(kind):
    """Rows that a double fails, with their reasons."""
    certificate = verified([double(kind)], QUICK, processes=[])
    assert len(certificate.rows) > 20
    return {row.row: row.reason for row in certificate.failed}


def test_an_honest_double_passes_every_row():
    assert failing(broken.Honest) == {}


class TestDoubles:
    """Each is caught, by the rows that name what it depends on."""

    def test_a_global_generator(self):
        failed = failing(broken.GlobalGenerator)
        assert "observation[3] (speed)" in failed["again"]

    def test_uninitialised_padding(self):
        if double(broken.Padding).widths() == [1]:
            pytest.skip("this processor has no lanes, hence no padding")
        failed = failing(broken.Padding)
        assert "again" not in failed
        # 64 and 4,096 fill their registers.
        assert {row for row in failed if row.startswith("batch ")} == {
            row for row in configured() if re.match(r"batch (1|3),.*lanes (8|16|32)$", row)
        }

    def test_the_position_in_the_batch(self):
        failed = failing(broken.Position)
        assert "position: 31 places on" in failed
        assert "again" not in failed
        assert not [row for row in failed if row.startswith(("batch 1,", "batch 3,"))]
        assert ", 1 ULP apart" in failed["position: 31 places on"]

    def test_the_number_of_threads(self):
        failed = failing(broken.Threads)
        named = {row for row in failed if row.startswith("batch ")}
        assert named == {row for row in configured() if re.search("threads (3|16),", row)}
        assert named

    def test_the_size_of_the_batch(self):
        failed = failing(broken.BatchSize)
        named = {row for row in failed if row.startswith("batch ")}
        assert named == {row for row in configured() if not row.startswith("batch 1,")}

    def test_the_width_of_lanes(self):
        widths = double(broken.Lanes).widths()
        if widths == [1]:
            pytest.skip("this processor has no lanes")
        failed = failing(broken.Lanes)
        named = {row for row in failed if row.startswith("batch ")}
        assert named == {row for row in configured() if not row.endswith("lanes 1")}

    def test_a_snapshot_that_forgets_a_field(self):
        failed = failing(broken.Forgetful)
        assert {"snapshot 0: back", "snapshot 0: another object"} <= failed.keys()
        # The other ways in do not lead to the double.
        assert all(row.startswith(("snapshot", "way")) for row in failed)
        assert "reward is" in failed["snapshot 0: back"]

    def test_seeds_that_are_forgotten(self):
        failed = failing(broken.SameSeed)
        assert re.search(r"seeds 0 and \d+ show the same to the last bit", failed["seeds"])

    def test_an_autoreset_mode_that_loses_something(self):
        assert list(failing(broken.Autoreset)) == ["autoreset SameStep"]


class Fate:
    """A job whose child dies, hangs or raises at its second row."""

    def __init__(self, end):
        self.end = end

    def names(self, method, apart):
        return ["first", "second", "third"]

    def play(self, name):
        if name == "second":
            self.end()
        return Outcome(compared=1)


def fail():
    raise ArithmeticError("no more digits")


@pytest.mark.parametrize(
    ("end", "told", "after"),
    [
        (lambda: os._exit(3), "process fork: ended with exit code 3", "process fork: ended with exit code 3"),
        (lambda: time.sleep(300), "gave no answer within 1 s", "gave no answer within 1 s"),
        (fail, "second: ArithmeticError: no more digits", ""),
    ],
    ids=["dies", "hangs", "raises"],
)
@pytest.mark.skipif("fork" not in METHODS, reason="there is no fork here")
def test_a_child_that_fails_is_told_and_ended(end, told, after):
    jobs: Any = [Fate(end)]
    child = Child("fork", jobs, patience=1.0)
    child.start()
    outcomes = child.next()
    began = time.monotonic()
    child.close()
    assert time.monotonic() - began < 60
    assert outcomes["first"] == Outcome(compared=1)
    assert told in outcomes["second"].failure
    assert after in outcomes["third"].failure
    assert bool(after) == bool(outcomes["third"].failure)
    assert not multiprocessing.active_children()


def configured():
    """The rows of the matrix in the quick form."""
    return {
        f"batch {batch}, threads {threads}, lanes {lanes}"
        for batch, threads, lanes in configurations(QUICK, double(broken.Honest).widths())
    }


@pytest.mark.parametrize("widths", [[1], [1, 8], [1, 8, 16, 32]])
def test_both_forms_play_every_value_of_every_axis(widths):
    axes = {1, 3, 64, 4096}, {1, 2, 3, 16}, set(widths)
    for form in (QUICK, FULL):
        for axis, values in enumerate(axes):
            assert {played[axis] for played in configurations(form, widths)} == values
    assert len(configurations(FULL, widths)) == 16 * len(widths)


def test_a_difference_says_where_and_how_far():
    certificate = verified([double(broken.Threads)], QUICK, processes=[])
    row = next(row for row in certificate.failed if row.row.startswith("batch 64, threads 3"))
    found = row.difference
    assert found is not None
    assert (found["field"], found["meaning"], found["ulps"]) == ("observation[7]", "beacon_nearness", 1)
    # The first decision of the first episode: the first observation is not nudged.
    assert (found["episode"], found["decision"], found["row"]) == (0, 1, 1)
    bits = [int(re.findall(r"0x([0-9a-f]{8})", found[side])[0], 16) for side in ("got", "expected")]
    got, expected = np.array(bits, np.uint32).view(np.float32)
    assert got == np.nextafter(expected, np.float32(8.0))
    assert found["text"] == row.reason


def test_distances_in_ulps_are_those_of_nextafter():
    rng = np.random.default_rng(0)
    for kind in (np.float32, np.float64):
        for start in rng.normal(size=20).astype(kind):
            number = start
            for steps in range(1, 5):
                number = np.nextafter(number, kind(-9))
                assert ulps(start, number) == steps
    # Across zero: 0.0 and -0.0 are one place.
    smallest = np.nextafter(np.float64(0), np.float64(1))
    assert ulps(smallest, -smallest) == 2
    assert ulps(np.float32(np.nan), np.float32(1)) is None
    assert ulps(np.int32(1), np.int32(2)) is None


@pytest.fixture(scope="module")
def certificate():
    """Of one id, one tier and one scene, with a forked and a spawned child."""
    return verify(tiers=["fast"], scene_names=["disc_jump"], quick=True, processes=["fork", "spawn"])


def test_ours_pass(certificate):
    assert certificate.failed == []
    rows = {row.row for row in certificate.rows}
    assert {"process fork", "process spawn", "autoreset Disabled", "way gymnasium.make", "seeds"} <= rows
    assert certificate.counts["compared"] > 200_000
    for name in ids():
        ends = certificate.digests[name]["fast"].ends
        assert min(ends["terminated"], ends["truncated"]) > 2, name


def test_certificates_survive_the_disk(certificate, tmp_path):
    certificate.save(tmp_path / "one.json")
    assert Certificate.load(tmp_path / "one.json") == certificate
    verdicts = [one.verdict for one in compare(certificate, Certificate.load(GOLDEN)) if one.tier == "fast"]
    assert verdicts.count("equal") == len(ids()) + 1
    assert set(verdicts) == {"equal", "gone"}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{", "expected a certificate in JSON"),
        ('{"schema": "discjump-certificate/0"}', "expected the schema discjump-certificate/1, got disc"),
        ("[]", "expected the schema discjump-certificate/1, got None"),
        ('{"schema": "discjump-certificate/1"}', "expected a whole certificate, got one without 'digests'"),
    ],
)
def test_what_is_no_certificate_is_refused(tmp_path, text, told):
    path = tmp_path / "bad.json"
    path.write_text(text)
    with pytest.raises(BadCertificate, match=re.escape(told)):
        Certificate.load(path)
    result = CliRunner().invoke(cli.main, ["verify", "--quick", "--against", str(path)])
    assert result.exit_code == 1
    assert told in result.output


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"ids": ["discjump/Sky-v0"]}, "ids: expected some of discjump/DiscJump-v0, discjump/Fl"),
        ({"tiers": ["quick"]}, "tiers: expected some of reference"),
        ({"scene_names": ["moon"]}, "scene_names: expected some of"),
        ({"processes": ["thread"]}, "processes: expected some of"),
    ],
)
def test_unknown_names_are_refused(arguments, told):
    with pytest.raises(ValueError, match=told):
        verify(**arguments)


class TestCommand:
    """The command as one types it."""

    ASKED = ("verify", "--quick", "--tiers", "fast", "--scenes", "none", "--processes", "none")

    def invoke(self, *arguments):
        return CliRunner().invoke(cli.main, [*self.ASKED, *map(str, arguments)])

    def test_against_the_golden_certificate(self, tmp_path):
        out = tmp_path / "made.json"
        result = self.invoke("--against", GOLDEN, "--out", out)
        assert result.exit_code == 0, result.output
        assert "equal     discjump/Ski-v0, fast" in result.output
        made = Certificate.load(out)
        assert made.versions["numpy"] == np.__version__
        assert made.machine["lane_widths"][0] == 1
        assert {"crate", "architecture", "cpu_features"} <= made.machine["native"].keys()

    @pytest.fixture
    def played(self, certificate, monkeypatch):
        """The command takes what was played already."""
        monkeypatch.setattr("discjump.verify.command.verified", lambda *_: certificate)

    @pytest.mark.usefixtures("played")
    def test_other_bits_fail_and_ask_for_a_new_id(self, tmp_path):
        golden = Certificate.load(GOLDEN)
        one = golden.digests["discjump/Ski-v0"]["fast"]
        other = {"discjump/Ski-v0": {"fast": replace(one, digest="0" * 64)}}
        replace(golden, digests=other, versions={"discjump": "0.0.9"}).save(tmp_path / "other.json")
        result = self.invoke("--against", tmp_path / "other.json", "--out", tmp_path / "made.json")
        assert result.exit_code == 1
        assert "different discjump/Ski-v0, fast" in result.output
        assert "needs a new id, discjump/Ski-v1" in result.output
        assert "there: discjump 0.0.9" in result.output

    @pytest.mark.usefixtures("played")
    def test_what_the_other_lacks_fails(self, tmp_path):
        replace(Certificate.load(GOLDEN), digests={}).save(tmp_path / "other.json")
        result = self.invoke("--against", tmp_path / "other.json", "--out", tmp_path / "made.json")
        assert result.exit_code == 1
        assert "missing   discjump/Ski-v0, fast" in result.output

    def test_a_failed_row_is_told_and_fails(self, tmp_path, monkeypatch):
        monkeypatch.setattr("discjump.verify.command.subjects", lambda *_: [double(broken.Position)])
        result = self.invoke("--out", tmp_path / "made.json")
        assert result.exit_code == 1
        assert "FAIL discjump/Ski-v0, fast, row position: 31 places on" in result.output
        rows = json.loads((tmp_path / "made.json").read_text())["rows"]
        assert any(row["result"] == "fail" and row["difference"]["ulps"] == 1 for row in rows)

    def test_ctrl_c_ends_it_cleanly(self, tmp_path):
        out = tmp_path / "never.json"
        words = ["verify", "--tiers", "fast", "--out", str(out)]
        # In a process that a shell put into the background nobody hears SIGINT.
        code = (
            "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
            f"from discjump.cli import main; print('up', flush=True); main({words!r})"
        )
        with subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == "up\n"
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
        assert process.returncode == 1
        assert "Aborted!" in errors
        assert "Traceback" not in errors
        assert not out.exists()


def test_the_golden_certificate_is_whole():
    golden = Certificate.load(GOLDEN)
    assert golden.failed == []
    assert golden.counts["skipped"] == 0
    names = [*ids(), *(f"scene {name}" for name in SCENES), "scene mission, worlds of 3"]
    played = {(name, tier) for name, tiers in golden.digests.items() for tier in tiers}
    assert played == {(name, tier) for name in names for tier in FIDELITIES}
    every = [one.digest for tiers in golden.digests.values() for one in tiers.values()]
    assert len(set(every)) == len(every)
