"""`discjump theory`: what it writes and what it refuses. Its figures are judged in tests/physics."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import discjump
from discjump import cli
from discjump.theory import blasts, bumps, convergence, figures, hops, report
from discjump.theory.lab import TIERS

COMMITTED = Path(__file__).parents[2] / "core" / "docs" / "theory"


def run(*arguments):
    return CliRunner().invoke(cli.main, ["theory", *map(str, arguments)])


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """The directory and the JSON of a quick run, with the committed account of energy."""
    pytest.importorskip("matplotlib")
    out = tmp_path_factory.mktemp("theory")
    result = run("--quick", "--ledger", COMMITTED / "ledger.json", "--out", out)
    assert result.exit_code == 0, result.output
    return out, json.loads((out / "theory.json").read_text())


def test_quick_form_measures_every_part_in_every_tier(quick):
    out, made = quick
    assert made["command"] == f"discjump theory --quick --ledger {COMMITTED / 'ledger.json'} --out {out}"
    assert made["versions"]["discjump"] == discjump.__version__
    names = {tier.name for tier in TIERS}
    for part in ("convergence", "blasts", "hops", "bumps"):
        assert {row["tier"] for row in made[part]} == names
    assert {row["case"] for row in made["convergence"]} == set(convergence.CASES)
    assert [row["name"] for row in made["figures"]] == [figure.name for figure in figures.figures()]
    assert all(set(row["measured"]) == names for row in made["figures"])
    assert {(row["armor"], row["formula"]) for row in made["blasts"]} == {
        (armor, formula) for armor in ("light", "medium", "heavy") for formula in blasts.FORMULAS
    }
    assert {row["keys"] for row in made["hops"]} == set(hops.KEYS)
    assert {(row["surface"], row["ground"]) for row in made["bumps"]} == {
        (surface, ground) for surface in bumps.SURFACES for ground in bumps.GROUNDS
    }


def test_the_page_is_that_of_the_json(quick):
    out, made = quick
    page = (out / "theory.md").read_text()
    assert page == report.render(made)
    # Each part's table has its rows, and a figure or two stands where it should.
    sections = re.split(r"^## ", page, flags=re.MULTILINE)[1:]
    assert len(sections) == 7
    rows = [section.count("\n|") - 2 for section in sections]
    pairs = [len({tuple(row[key] for key in keys) for row in made[part]}) for part, *keys in PARTS]
    assert rows == [*pairs[:1], len(made["figures"]), *pairs[1:], len(made["ledger"]["rows"])]
    fall = made["figures"][0]
    assert f"| {fall['smooth']:g} | {fall['article']:g} | {fall['engine']:g} |" in sections[1]


PARTS = (
    ("convergence", "case", "tier"),
    ("blasts", "armor", "formula"),
    ("hops", "slope", "keys"),
    ("limit", "tick_ms", "keys"),
    ("bumps", "surface", "ground", "tier"),
)


def test_the_picture_is_drawn(quick):
    image = pytest.importorskip("PIL.Image").open(quick[0] / "theory.png")
    colours = {tuple(pixel) for pixel in np.asarray(image.convert("RGB")).reshape(-1, 3)}
    assert (0xD5, 0x5E, 0x00) in colours
    assert image.size[0] > 1000


@pytest.mark.parametrize("text", ["", "[]", '{"rows": []}', '{"rows": [{"run": "ski"}]}', '{"rows": 3}'])
def test_another_file_is_no_ledger(tmp_path, text):
    pytest.importorskip("matplotlib")
    other = tmp_path / "other.json"
    other.write_text(text)
    result = run("--quick", "--ledger", other, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "--ledger" in result.output
    assert not (tmp_path / "out").exists()


def test_no_file_is_no_ledger(tmp_path):
    result = run("--ledger", tmp_path / "none.json")
    assert result.exit_code == 2
    assert "none.json" in result.output


def test_committed_results_are_the_commands():
    """The page is the JSON's; the JSON's figures come out again. If not, run its command again."""
    made = json.loads((COMMITTED / "theory.json").read_text())
    assert made["command"] == "discjump theory --ledger core/docs/theory/ledger.json --out core/docs/theory"
    assert (COMMITTED / "theory.md").read_text() == report.render(made)
    assert made["ledger"] == json.loads((COMMITTED / "ledger.json").read_text())
    assert (COMMITTED / "theory.png").stat().st_size < 400_000

    for old in [row for row in made["hops"] if row["slope"] in (5.0, 45.0)]:
        tier = next(tier for tier in TIERS if tier.name == old["tier"])
        new = hops.measure(tier, old["slope"], old["keys"])
        for name in ("period", "acceleration"):
            assert new[name] == pytest.approx(old[name], rel=1e-9)
    for old in [row for row in made["bumps"] if row["square"] == 8.0 and row["surface"] == "cone"]:
        tier = next(tier for tier in TIERS if tier.name == old["tier"])
        new = bumps.measure(tier, "cone", 8.0, ground=old["ground"])
        assert new["hung"] == old["hung"]
        assert new["mean"] == pytest.approx(old["mean"], rel=1e-6)
