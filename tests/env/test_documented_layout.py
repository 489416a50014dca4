"""The table of the observation in core/docs/ski.md is the layout that the environment has."""

from pathlib import Path

from discjump.envs.named import SkiEnv

PAGE = Path(__file__).parents[2] / "core" / "docs" / "ski.md"


def test_the_documented_table_is_the_layout():
    lines = PAGE.read_text().split("## Observation")[1].split("## Reward")[0].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    documented = [(name, int(count), unit, float(scale)) for name, count, unit, scale, _ in cells[2:]]
    layout = SkiEnv(terrain_seeds=[0]).observation_layout
    actual = [(f.name, f.slice.stop - f.slice.start, f.unit, round(float(f.scale), 6)) for f in layout]
    assert documented == actual
