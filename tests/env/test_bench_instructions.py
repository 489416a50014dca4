"""`discjump.bench.instructions`: exact counts of the right order, and clear words where there can be none."""

import json
from pathlib import Path

import pytest

from discjump.bench import instructions
from discjump.bench.clock import Case, Unavailable
from discjump.bench.ways import Agents, Players

COMMITTED = Path(__file__).parents[2] / ".ci" / "instructions.json"
PLAIN = Players(64, threads=1, lanes=1, calls=16)

needs_valgrind = pytest.mark.skipif(not instructions.available(), reason="valgrind is not installed")


@needs_valgrind
def test_counts_are_exact_and_agree_with_the_committed_ones() -> None:
    """The committed counts are of other players, by another way in: of the same order, and no closer."""
    eight = Players(256, threads=1, lanes=8, calls=16)
    slow = Players(64, threads=1, lanes=1, calls=16, precision="float64", tick_ms=64, armor="heavy")
    agent = Agents(64, threads=1, lanes=1, terrains=1)
    done: list[int] = []
    cases: list[Case] = [PLAIN, eight, slow, PLAIN, agent]
    counts = instructions.count(cases, progress=done.append)
    assert done == [1] * 5
    assert counts[3] == pytest.approx(counts[0], rel=1e-4)
    # Twice as long a tick has more slices: more work than one tick, less than two.
    assert counts[0] < counts[2] < 2.0 * counts[0]
    committed = json.loads(COMMITTED.read_text())["counts"]
    assert counts[0] == pytest.approx(committed["player-tick, plain"], rel=0.2)
    assert counts[1] == pytest.approx(committed["player-tick, AVX2"], rel=0.4)
    assert counts[4] == pytest.approx(committed["agent step of one tick, plain"], rel=0.2)


@needs_valgrind
def test_a_case_that_fails_says_so() -> None:
    with pytest.raises(RuntimeError, match=r"(?s)counted.*Error"):
        instructions.count([Players(2, threads=1, lanes=1, scene="race")])


def test_without_valgrind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert not instructions.available()
    with pytest.raises(Unavailable, match="apt-get install valgrind"):
        instructions.count([PLAIN])


@needs_valgrind
@pytest.mark.parametrize(
    "case", [Players(2, threads=2, lanes=1), Players(2, threads=1, lanes=16), Players(2, 1)]
)
def test_what_cannot_be_counted(case: Players) -> None:
    with pytest.raises(ValueError, match=r"cases: expected (lanes of 1 or 8|threads of 1), got (2|16|None)"):
        instructions.count([case])
