"""Terrains as environments use them: cached, copied, pickled."""

import copy
import os
import pickle
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import discjump
from discjump import terrains
from discjump.envs.named import SkiEnv

from .play import same_bits

HEIGHTS = np.random.default_rng(0).uniform(0, 30, (5, 7))


def test_pools_share_their_terrains():
    assert terrains.pool([3, 1])[0] is terrains.pool([3])[0]
    assert [terrain.seed for terrain in terrains.pool([3, 1])] == [3, 1]
    assert terrains.generated(3, True).digest() != terrains.generated(3, False).digest()
    assert terrains.generated(3).digest() == discjump.Terrain.raindance(3).digest()


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize(
    "make",
    [
        lambda: discjump.Terrain.raindance(5),
        lambda: discjump.Terrain.raindance(5, repeating=True),
        lambda: discjump.Terrain.from_heights(HEIGHTS, 4.0, (-3.0, 2.0), "void"),
    ],
    ids=["raindance", "repeating", "own"],
)
def test_copies_and_pickles_have_the_same_bits(make, again):
    one = make()
    other = again(one)
    assert other.digest() == one.digest()
    assert (other.seed, other.edge, other.origin, other.square_size) == (
        one.seed,
        one.edge,
        one.origin,
        one.square_size,
    )
    same_bits(other.heights, one.heights)
    same_bits(other.mission, one.mission)


def test_an_environment_on_own_terrain_is_made_again_from_its_spec():
    own = discjump.Terrain.from_heights(np.zeros((129, 129)), edge="clamp")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("discjump/Ski-v0", terrains=[own])
        assert env.spec is not None
        again = gymnasium.make(env.spec)
        gymnasium.make_vec("discjump/Ski-v0", num_envs=2, terrains=[own])
    same_bits(env.reset(seed=1), again.reset(seed=1))


def test_terrains_of_different_sizes_are_refused():
    small = discjump.Terrain.from_heights(np.zeros((65, 65)))
    with pytest.raises(ValueError, match="terrains"):
        gymnasium.make("discjump/Ski-v0", terrains=[small, discjump.Terrain.raindance(0)])


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs Linux's /proc")
def test_environments_share_the_heights_of_their_pool():
    # A pool of 16 takes 13 MB; environments made one by one must not each have it.
    def resident():
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

    first = SkiEnv()
    before = resident()
    more = [SkiEnv() for _ in range(20)]
    assert resident() - before < 40
    same_bits(first.reset(seed=1)[0], more[-1].reset(seed=1)[0])


BAD_HEIGHTS = [
    ({"heights": np.full((4, 4), np.nan)}, ValueError, "heights"),
    ({"heights": np.where(np.eye(4) > 0, np.inf, 0.0)}, ValueError, "heights"),
    ({"heights": np.zeros((1, 5))}, ValueError, "heights"),
    ({"heights": np.zeros((5, 1))}, ValueError, "heights"),
    ({"heights": np.zeros(5)}, ValueError, "heights"),
    ({"heights": np.zeros((2, 2, 2))}, ValueError, "heights"),
    ({"heights": np.full((4, 4), 10_001.0)}, ValueError, "heights"),
    ({"heights": "hills"}, (TypeError, ValueError), "heights"),
    ({"heights": np.zeros((4, 4), complex)}, (TypeError, ValueError), "heights"),
    ({"square_size": 0.0}, ValueError, "square_size"),
    ({"square_size": -8.0}, ValueError, "square_size"),
    ({"square_size": np.nan}, ValueError, "square_size"),
    ({"origin": (np.nan, 0.0)}, ValueError, "origin"),
    ({"edge": "mirror"}, ValueError, "edge"),
    ({"surface": "cubic"}, ValueError, "surface"),
    ({"surface": 1}, TypeError, "surface"),
    ({"heights": np.arange(16.0).reshape(4, 4), "edge": "tile"}, ValueError, "tile"),
]


@pytest.mark.parametrize(("arguments", "kind", "message"), BAD_HEIGHTS)
def test_bad_heights(arguments, kind, message):
    with pytest.raises(kind, match=message):
        discjump.Terrain.from_heights(**({"heights": np.zeros((4, 4))} | arguments))


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5, "one"])
def test_bad_seeds(seed):
    with pytest.raises((TypeError, ValueError, OverflowError)):
        discjump.Terrain.raindance(seed)
