"""`discjump bench --scenes`: the lists, the sizes and one cost for every scene and tier."""

import json
from pathlib import Path

import numpy as np
from click.testing import CliRunner

import discjump
from discjump.bench import instructions, scenes
from discjump.cli import main
from discjump.simulator import SIMULATOR_FIDELITIES


def test_every_scene_and_tier_is_listed_and_timed(tmp_path: Path) -> None:
    out = tmp_path / "scenes.json"
    result = CliRunner().invoke(main, ["bench", "--scenes", "--quick", "--out", str(out)])
    assert result.exit_code == 0, result.output
    rows = json.loads(out.read_text())["rows"]
    timed = {(row["scene"], row["fidelity"]) for row in rows if row["case"] == "scene"}
    assert timed == {(scene, fidelity) for scene in discjump.SCENES for fidelity in SIMULATOR_FIDELITIES}
    assert all(row["ns_per_player_tick"] > 0 for row in rows)
    for row in rows:
        wide = row["fidelity"] in ("authentic", "swept", "fast") and row["case"] != "float64"
        lanes = ["1", "8"] if wide else ["1"]
        assert list(row["instructions"]) == (lanes if instructions.available() else [])
        assert all(10 < taken < 1e5 for taken in row["instructions"].values())
    double = [row["fidelity"] for row in rows if row["case"] == "float64"]
    assert double == list(SIMULATOR_FIDELITIES)
    counts = [row["solids"] for row in rows if row["case"].endswith("far from them")]
    assert counts == [10, 1000]
    for scene in discjump.SCENES.values():
        assert f"| {scene.name} | {', '.join(scene.models)} |" in result.output


def test_the_page_lists_the_scenes_as_they_are() -> None:
    page = Path(__file__).parents[2] / "core" / "docs" / "scenes.md"
    assert scenes.lists() in page.read_text()


def test_a_scene_stores_nothing_of_what_it_leaves_out() -> None:
    terrain = discjump.Terrain.from_heights(np.zeros((3, 3)))
    fields = {"discs": "ammo", "bump_limits": "bump_limits", "energy": "energy", "landing_damage": "damage"}
    sizes = {}
    for scene in discjump.SCENES.values():
        sim = discjump.Simulator(terrain, scene=scene.name, threads=1)
        sizes[scene.name] = sim.player_bytes
        assert set(scene.models) & set(scene.leaves_out) == set()
        for feature, field in fields.items():
            assert (field in (sim.state_dtype.names or ())) == (feature in scene.models)
    assert sizes["ski"] < sizes["sandbox"] < sizes["disc_jump"] == sizes["mission"]
