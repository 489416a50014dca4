"""The command line."""

import json
from importlib.metadata import EntryPoint

import click
import numpy as np
import pytest
from click.testing import CliRunner

import discjump
from discjump import cli, terrain_command
from discjump.terrain_command import Row


def run(*arguments):
    return CliRunner().invoke(cli.main, [str(argument) for argument in arguments])


@pytest.fixture
def entries(monkeypatch):
    """The installed entry points, replaced by those that a test adds."""
    listed: dict[str, EntryPoint] = {}
    monkeypatch.setattr(cli, "_entries", lambda: listed)
    return listed


def entry(name, value):
    return EntryPoint(name=name, value=value, group=cli.GROUP)


@pytest.mark.parametrize("command", ["train", "evaluate"])
def test_without_the_training_package_its_name_is_told(entries, command):
    result = run(command, "ski", "--steps", 5)
    assert result.exit_code != 0
    assert "pip install discjump-training" in result.output
    assert command in run("--help").output


@click.command()
@click.argument("word")
def echo(word):
    """Says a word."""
    click.echo(f"echo {word}")


def test_commands_of_other_packages_are_loaded(entries, monkeypatch):
    monkeypatch.setattr(cli, "echo", echo, raising=False)
    entries["train"] = entry("train", "discjump.cli:echo")
    result = run("train", "hello")
    assert (result.exit_code, result.output) == (0, "echo hello\n")
    assert "Says a word." in run("--help").output


@pytest.mark.parametrize(
    "value", ["no_such_package:train", "discjump.cli:no_such_name", "discjump.cli:GROUP"]
)
def test_a_broken_command_spoils_no_other(entries, value):
    entries["ghost"] = entry("ghost", value)
    assert run("--help").exit_code == 0
    result = run("ghost")
    assert result.exit_code != 0
    assert value in result.output


def test_unknown_command():
    result = run("terain")
    assert result.exit_code != 0
    assert "terain" in result.output


def test_version():
    assert discjump.__version__ in run("--version").output


def test_terrain_table_and_files(tmp_path):
    result = run("terrain", "--seed", 3, "--out", tmp_path, "--size", 128)
    assert result.exit_code == 0, result.output
    figures = json.loads((tmp_path / "terrain-3.json").read_text())
    made = discjump.Terrain.raindance(3)
    assert figures["digest"] == made.digest()
    assert figures["accepted"] is True
    assert [row["name"] for row in figures["acceptance"]] == [row[0] for row in made.acceptance()]
    for name in ("sigma_m", "flag_dist_m"):
        assert name in result.output
    image = pytest.importorskip("PIL.Image").open(tmp_path / "terrain-3.png")
    assert image.size == (128, 128)
    assert len(np.unique(np.asarray(image))) > 50


def test_terrain_check_over_seeds(tmp_path):
    result = run("terrain", "--check", 3, 6, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    assert "4 of 4 terrains pass" in result.output
    assert json.loads((tmp_path / "check-3-6.json").read_text())["missed"] == {}


@pytest.mark.parametrize("arguments", [["--check", 6, 3], ["--seed", -1], ["--size", 1], ["--check", 1]])
def test_bad_arguments(tmp_path, arguments):
    result = run("terrain", *arguments, "--out", tmp_path)
    assert result.exit_code == 2
    assert arguments[0] in result.output


def test_table_marks_what_is_outside():
    rows = [Row("steep", "core", 5.0, 0.0, 1.0, False), Row("flat", "supporting", 0.5, 0.0, 1.0, True)]
    text = terrain_command.table(rows, {"extra": 1.5})
    marked = [line for line in text.splitlines() if "outside" in line]
    assert len(marked) == 1
    assert marked[0].startswith("steep")
    assert "extra" in text
    assert terrain_command.verdict(rows, False) == "FAILS: core 0 of 1 inside, supporting 1 of 1 inside"


def test_a_terrain_that_misses_makes_the_command_fail(tmp_path, monkeypatch):
    class Flat:
        """Of the generator's interface, but level."""

        raindance = staticmethod(lambda seed, repeating: discjump.Terrain.from_heights(np.zeros((257, 257))))

    monkeypatch.setattr(terrain_command, "Terrain", Flat)
    result = run("terrain", "--seed", 3, "--out", tmp_path, "--size", 64)
    assert result.exit_code == 1
    assert "FAILS" in result.output
    result = run("terrain", "--check", 1, 2, "--out", tmp_path)
    assert result.exit_code == 1
    assert "0 of 2 terrains pass" in result.output
