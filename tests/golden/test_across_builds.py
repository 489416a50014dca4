"""The wheel's bits are those of the core's own tests, which are compiled otherwise.

Contract: optimisation, debug assertions, link-time optimisation and target do not change a bit. The digests
are in `core/tests/golden/episodes.txt`; `core/tests/golden.rs` plays the same in the profile, and for the
target, of `cargo test`, and checks what was returned as well.
"""

from pathlib import Path

import pytest

import discjump
from discjump.envs.named import SkiVectorEnv

from .regenerate import NUM_ENVS, actions

FILE = Path(__file__).parents[2] / "core" / "tests" / "golden" / "episodes.txt"
GOLDEN = {(what, tier): digest for what, tier, digest in map(str.split, FILE.read_text().splitlines())}
DECISIONS = 480
TIERS = sorted({tier for _, tier in GOLDEN})


def test_every_tier_is_there():
    assert set(TIERS) == {"reference", "authentic", "swept", "fast", "engine"}


@pytest.mark.parametrize("fidelity", TIERS)
def test_environments_end_alike(fidelity):
    envs = SkiVectorEnv(NUM_ENVS, fidelity=fidelity, terrain_seeds=[0])
    envs.reset(seed=0)
    for decision in range(DECISIONS):
        envs.step(actions(decision))
    assert envs._task.batch.digest() == GOLDEN["ski", fidelity]


@pytest.mark.parametrize("fidelity", TIERS)
def test_players_who_shoot_end_alike(fidelity):
    sim = discjump.Simulator(discjump.Terrain.raindance(0), NUM_ENVS, "disc_jump", fidelity=fidelity)
    inputs = sim.inputs()
    for decision in range(DECISIONS // 4):
        forward, strafe, jump, jet, turn = actions(decision).T
        inputs["forward"], inputs["strafe"] = forward - 1, strafe - 1
        inputs["jump"], inputs["jet"], inputs["fire"] = jump, jet, turn > 2
        inputs["turn"] = 0.25 * (turn - 3)
        inputs["pitch"] = [0.25 * (player % 5) - 0.75 for player in range(NUM_ENVS)]
        sim.step(inputs, 4)
    assert sim.digest() == GOLDEN["disc_jump", fidelity]
