"""Players side by side in a register.

Contract: how many never changes a bit, and a width that the processor lacks is refused by name, whether it
came as an argument or through the environment variable.
"""

import gymnasium
import numpy as np
import pytest

from discjump import Simulator, Terrain
from discjump.envs.named import SkiEnv, SkiVectorEnv

from .play import SHORT, random_actions, same_bits

HERE = Terrain.raindance(0)


def widths():
    """Those that this processor has: a refusal lists them."""
    with pytest.raises(ValueError, match="lanes") as refusal:
        Simulator(HERE, lanes=3)
    listed = str(refusal.value).partition("one of ")[2].partition(", the")[0]
    return sorted(int(width) for width in listed.split(", "))


WIDTHS = widths()


def test_one_player_at_a_time_is_always_there():
    assert WIDTHS[0] == 1
    assert set(WIDTHS) <= {1, 8, 16, 32}


@pytest.mark.parametrize("fidelity", ["authentic", "swept", "fast", "reference", "engine"])
def test_episodes_have_the_same_bits(fidelity):
    # 21: neither a multiple of any width nor less than one.
    def play(lanes):
        envs = gymnasium.make_vec(
            "discjump/Ski-v0", num_envs=21, lanes=lanes, fidelity=fidelity, threads=1, **SHORT
        )
        yield envs.reset(seed=0)
        for action in random_actions(0, 150, 21):
            yield envs.step(action)

    ends = 0
    for results in zip(*(play(lanes) for lanes in WIDTHS), strict=True):
        for result in results[1:]:
            same_bits(result, results[0])
        ends += "_return" in results[0][-1] and results[0][-1]["_return"].sum()
    assert ends > 40


def test_one_environment_has_the_same_bits():
    envs = [gymnasium.make("discjump/Ski-v0", lanes=lanes, terrain_seeds=[0]) for lanes in WIDTHS]
    for results in zip(*(env.reset(seed=3) for env in envs), strict=True):
        for result in results[1:]:
            same_bits(result, results[0])
    for action in random_actions(1, 100, 1)[:, 0]:
        steps = [env.step(action) for env in envs]
        for step in steps[1:]:
            same_bits(step, steps[0])


def test_stable_baselines3_has_the_same_bits():
    sb3 = pytest.importorskip("discjump.sb3")
    batches = [
        sb3.make_vec_env("discjump/Ski-v0", n_envs=21, seed=0, lanes=lanes, threads=1, **SHORT)
        for lanes in WIDTHS
    ]
    first = [envs.reset() for envs in batches]
    assert len({observations.tobytes() for observations in first}) == 1
    for action in random_actions(2, 60, 21):
        steps = [envs.step(action)[:3] for envs in batches]
        for step in steps[1:]:
            same_bits(step, steps[0])


@pytest.mark.parametrize("fidelity", ["authentic", "swept", "fast"])
def test_players_have_the_same_bits(fidelity):
    rng = np.random.default_rng(4)
    sims = [Simulator(HERE, 21, "ski", fidelity=fidelity, lanes=lanes, threads=1) for lanes in WIDTHS]
    # Two registers side by side exist for the authentic tier only.
    most = 32 if fidelity == "authentic" else 16
    assert [sim.lanes for sim in sims] == [min(width, most) for width in WIDTHS]
    inputs = sims[0].inputs()
    for _ in range(40):
        inputs["forward"], inputs["strafe"] = rng.integers(-1, 2, (2, 21))
        inputs["jump"], inputs["jet"] = rng.random((2, 21)) < 0.7
        inputs["turn"] = rng.uniform(-2, 2, 21)
        for sim in sims:
            sim.step(inputs, 4)
    assert len({sim.state().tobytes() for sim in sims}) == 1
    assert np.ptp(sims[0].state()["position"][:, 0]) > 10


@pytest.mark.parametrize(
    "make",
    [
        lambda **lanes: Simulator(HERE, 21, **lanes),
        lambda **lanes: SkiVectorEnv(21, terrains=[HERE], **lanes),
        lambda **lanes: SkiEnv(terrains=[HERE], **lanes),
    ],
    ids=["Simulator", "vector", "single"],
)
class TestRefusals:
    """Whoever is asked."""

    def test_widths_that_are_not_there(self, make):
        with pytest.raises(ValueError, match=r"^lanes: expected one of .*1, .*got 3$"):
            make(lanes=3)
        with pytest.raises(ValueError, match=r"^lanes: expected an integer from 1 to 32, got 0$"):
            make(lanes=0)
        with pytest.raises(TypeError, match=r"^lanes: expected an integer.*'8' of type str"):
            make(lanes="8")

    def test_the_environment_variable(self, make, monkeypatch):
        monkeypatch.setenv("DISCJUMP_LANES", "junk")
        with pytest.raises(ValueError, match=r"^DISCJUMP_LANES: expected one of .*got junk$"):
            make()
        # An argument goes before it.
        make(lanes=1)


@pytest.mark.parametrize("fidelity", ["reference", "engine"])
def test_widths_are_checked_where_a_tier_has_no_lanes(fidelity, monkeypatch):
    """A width that no processor has was taken without a word by the tiers that have no lanes."""
    with pytest.raises(ValueError, match=r"^lanes: expected one of .*got 3$"):
        SkiVectorEnv(2, fidelity=fidelity, terrain_seeds=[0], lanes=3)
    monkeypatch.setenv("DISCJUMP_LANES", "junk")
    with pytest.raises(ValueError, match=r"^DISCJUMP_LANES: expected one of .*got junk$"):
        SkiVectorEnv(2, fidelity=fidelity, terrain_seeds=[0])


def test_the_environment_variable_stands_for_an_absent_argument(monkeypatch):
    for width in WIDTHS:
        monkeypatch.setenv("DISCJUMP_LANES", str(width))
        assert Simulator(HERE, 64, "ski").lanes == width
        assert Simulator(HERE, 64, lanes=1).lanes == 1
