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
from discjump.envs.ski import SkiEnv

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
    # A pool of 16 takes 13 MB; environments made one by one (SyncVectorEnv, DummyVecEnv) must not each have it.
    def resident():
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

    first = SkiEnv()
    before = resident()
    more = [SkiEnv() for _ in range(20)]
    assert resident() - before < 40
    same_bits(first.reset(seed=1)[0], more[-1].reset(seed=1)[0])
