"""Scores of an environment id stay comparable for ever: its bits are those committed here.

Whoever changes a digest changes what every published score of that id meant. `regenerate.py` rewrites the
file; `CHANGELOG.md` says when that is allowed.
"""

import json

import pytest

import discjump

from .regenerate import FILE, OTHERS, TERRAIN_SEEDS, TIERS, rollout, scene, shooting

GOLDEN = json.loads(FILE.read_text())


@pytest.mark.parametrize("fidelity", TIERS)
def test_rollouts_have_their_golden_bits(fidelity: str) -> None:
    assert rollout(fidelity) == GOLDEN["discjump/Ski-v0"][fidelity], (
        "the bits of discjump/Ski-v0 changed: this needs a new id (see the version policy in CHANGELOG.md)"
    )


@pytest.mark.parametrize("fidelity", TIERS)
@pytest.mark.parametrize("id", [task.id for task in OTHERS])
def test_rollouts_of_shooting_tasks_have_their_golden_bits(id: str, fidelity: str) -> None:
    assert shooting(id, fidelity) == GOLDEN[id][fidelity], (
        f"the bits of {id} changed: this needs a new id (see the version policy in CHANGELOG.md)"
    )


@pytest.mark.parametrize("fidelity", TIERS)
def test_bilinear_ground_has_its_golden_bits(fidelity: str) -> None:
    assert rollout(fidelity, "bilinear") == GOLDEN["discjump/Ski-v0, bilinear"][fidelity]
    assert scene("mission", fidelity, "bilinear") == GOLDEN["scene mission, bilinear"][fidelity]


@pytest.mark.parametrize("fidelity", TIERS)
@pytest.mark.parametrize("name", ["sandbox", "disc_jump", "mission"])
def test_scenes_have_their_golden_bits(name: str, fidelity: str) -> None:
    assert scene(name, fidelity) == GOLDEN[f"scene {name}"][fidelity], (
        "bodies move otherwise than they did: CHANGELOG.md must say so, and no id may rest on it"
    )


def test_missions_have_their_golden_solids() -> None:
    assert discjump.Terrain.raindance(0).solids_digest() == GOLDEN["solids"]["0"]


@pytest.mark.parametrize("seed", TERRAIN_SEEDS)
def test_terrains_have_their_golden_bits(seed: int) -> None:
    assert discjump.Terrain.raindance(seed).digest() == GOLDEN["terrain"][str(seed)]


def test_a_bilinear_terrain_has_its_golden_name() -> None:
    assert discjump.Terrain.raindance(0, surface="bilinear").digest() == GOLDEN["bilinear terrain"]["0"]
