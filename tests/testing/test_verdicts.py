"""The page of verdicts says what the checks say, of which a small part is made anew here."""

from pathlib import Path

import pytest
from gymnasium.vector import AutoresetMode

from discjump.testing import verdicts

PAGE = Path(__file__).parents[2] / "env" / "docs" / "testing.md"

AGAIN = [
    "SyncVectorEnv, CartPole-v1",
    "SyncVectorEnv, FrozenLake-v1",
    "SyncVectorEnv(copy=False), CartPole-v1",
    "CartPoleVectorEnv",
    "RecordEpisodeStatistics over SyncVectorEnv, CartPole-v1",
]


@pytest.mark.parametrize("name", AGAIN)
def test_a_row_of_the_page_is_what_the_checks_say(name):
    row = next(row for row in verdicts.rows() if row.name == name)
    assert verdicts.line(row) in PAGE.read_text(encoding="utf-8").splitlines()


def test_a_cell_of_processes_is_what_the_checks_say():
    row = next(row for row in verdicts.rows() if row.name.startswith("AsyncVectorEnv(shared_memory=False)"))
    said = verdicts.cell(row.report(AutoresetMode.NEXT_STEP))
    assert "`reset_forgets`" in said
    assert f"| {row.name} | {said} |" in PAGE.read_text(encoding="utf-8")


def test_the_page_has_every_row_and_every_rule():
    page = PAGE.read_text(encoding="utf-8")
    assert verdicts.placed(page, "checks", f"{verdicts.RULES}\n{verdicts.rules()}") == page
    lines = page.split("<!-- verdicts -->")[1].split("<!-- end of verdicts -->")[0].strip().splitlines()
    assert [line.split(" | ")[0] for line in lines[2:]] == [f"| {row.name}" for row in verdicts.rows()]


def test_our_environments_pass_everything_and_equal_single_ones():
    row = next(row for row in verdicts.rows() if row.name == "discjump's SkiVectorEnv")
    reports = [row.report(mode) for mode in row.modes]
    for report in reports:
        assert (report.failures, report.skipped) == ((), ())
        assert report["equals_reference"].verdict == "pass"
    cells = " | ".join(map(verdicts.cell, reports))
    assert f"| {row.name} | {cells} |" in PAGE.read_text(encoding="utf-8").splitlines()
