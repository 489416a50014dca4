"""Plays extremes in columns, and says of each cell how it went."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from discjump._native import Terrain
from discjump.stress import repeats
from discjump.stress.blasts import blasts
from discjump.stress.cases import Case, Column, Setting
from discjump.stress.checks import Finding, judge
from discjump.stress.expected import certain, expected
from discjump.stress.floor import Floor
from discjump.stress.play import Record, play, prepared
from discjump.stress.refusals import refusals

PASS, EXPECTED, FAIL, UNEXPECTED_PASS = "pass", "expected failure", "FAIL", "unexpectedly passes"
NOT_NUMBERS = "not numbers"
"""The row of what must be refused: nothing is played in it."""


@dataclass
class Cell:
    """An extreme in a column."""

    column: Column
    extreme: str
    status: str = PASS
    #: Cases that were played.
    cases: int = 0
    player_ticks: int = 0
    #: Of every case and check that found something: case, check, worst, count, tick, player, reason.
    findings: list[dict[str, Any]] = field(default_factory=list)

    def add(self, case: str, findings: Sequence[Finding]) -> None:
        """Note what was found in a case."""
        self.cases += 1
        for finding in findings:
            label = f"{self.extreme}/{case}"
            meets = expected(self.column, label, finding)
            self.findings.append(
                {"case": case, **asdict(finding), "reason": None if meets is None else meets.reason}
            )

    def settle(self, strict: bool) -> None:
        """Say how it went, once all cases are in; `strict`: failures that must be there are asked for."""
        if any(finding["reason"] is None for finding in self.findings):
            self.status = FAIL
            return
        seen = {(finding["check"], finding["reason"]) for finding in self.findings}
        missing = strict and any((e.check, e.reason) not in seen for e in certain(self.column, self.extreme))
        self.status = UNEXPECTED_PASS if missing else EXPECTED if seen else PASS


def examined(case: Case, column: Column, ground: Terrain | None, crowd: bool) -> tuple[Record, list[Finding]]:
    """Play a case in a column, and everything that is found in it."""
    terrain, start = prepared(case, column, ground)
    if case.far is not None:
        start = repeats.representable(start, Floor(terrain))
    record = play(terrain, start, column, case.setting)
    return record, [*judge(record), *others(case, record, crowd)]


def others(case: Case, record: Record, crowd: bool) -> list[Finding]:
    """What is found of a record beside its ticks: explosions, and the same again."""
    found = [blasts(record), repeats.repeat(record, crowd), repeats.far(case, record)]
    if record.start.inputs.shape[1] >= repeats.CROWD:
        found.append(repeats.digest(record))
    return [finding for finding in found if finding is not None]


def run(
    cases: Sequence[Case],
    columns: Sequence[Column],
    *,
    crowd: bool,
    strict: bool,
    setting: Setting,
    done: Callable[[str], object],
) -> list[Cell]:
    """Every case in every column.

    Args:
        cases: what is played.
        columns: in what.
        crowd: whether all but the heaviest cases are repeated in copies as well, on two threads.
        strict: whether expected failures must be there.
        setting: of the row of what is refused.
        done: is told each case in each column.
    """
    cells: dict[tuple[str, Column], Cell] = {}
    for case in cases:
        ground = case.ground()
        for column in columns:
            cell = cells.setdefault((case.extreme, column), Cell(column, case.extreme))
            record, found = examined(case, column, ground, crowd and not case.heavy)
            cell.player_ticks += record.start.inputs.size
            cell.add(case.name, found)
            done(case.label)
    for column in columns:
        cell = cells.setdefault((NOT_NUMBERS, column), Cell(column, NOT_NUMBERS))
        wrong = refusals(column, cases[0].ground().with_surface(column.surface), setting)
        for sentence in wrong:
            cell.add(sentence, [Finding("refusal", 1.0, 1, 0, 0)])
        cell.cases = 1
        done(NOT_NUMBERS)
    for cell in cells.values():
        cell.settle(strict)
    return list(cells.values())


def work(cases: Sequence[Case], columns: Sequence[Column]) -> int:
    """How often `run` will call `done`."""
    return (len(cases) + 1) * len(columns)
