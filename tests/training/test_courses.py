from itertools import combinations

import numpy as np
import pytest

from discjump_training.courses import COURSES, MAX_RUN_SEED, SEED_SPACING, course, run_seed
from discjump_training.errors import TrainingError
from discjump_training.recipe import Recipe

#: Frozen: a change of a course needs a new name.
PUBLISHED = {
    "ski-train-v1": (range(16), 4_500_000_000, 4_096),
    "ski-validation-v1": (range(5_000, 5_008), 5_000_000_000, 512),
    "ski-held-out-v1": (range(10_000, 10_016), 10_000_000_000, 512),
}


def test_courses_are_the_published_ones():
    assert {
        name: (range(one.terrain_seeds[0], one.terrain_seeds[-1] + 1), one.base_seed, one.episodes)
        for name, one in COURSES.items()
    } == PUBLISHED


def test_courses_share_no_terrain_and_no_episode():
    for a, b in combinations(COURSES.values(), 2):
        assert not set(a.terrain_seeds) & set(b.terrain_seeds), (a.name, b.name)
        assert not set(a.seeds().tolist()) & set(b.seeds().tolist()), (a.name, b.name)


def test_training_runs_share_no_environment_seed_with_each_other_or_a_course():
    widest = 100_000
    assert Recipe.load("ski").rollout.num_envs <= widest <= SEED_SPACING
    last = run_seed(MAX_RUN_SEED) + widest
    assert all(last < one.base_seed for one in COURSES.values())
    # numpy's global generator, which stable-baselines3 seeds with the same number, takes 32 bits.
    assert run_seed(MAX_RUN_SEED) < 2**32


def test_seeds_are_consecutive_and_unsigned():
    seeds = course("ski-held-out-v1").seeds(3)
    assert seeds.dtype == np.uint64
    assert seeds.tolist() == [10_000_000_000, 10_000_000_001, 10_000_000_002]


def test_what_there_is_not_is_refused():
    with pytest.raises(TrainingError, match=r"no course is named 'ski-v0'; there are ski-train-v1"):
        course("ski-v0")
    with pytest.raises(TrainingError, match=r"has 1 to 512 episodes to offer, not 513"):
        course("ski-held-out-v1").seeds(513)
    for seed in (-1, MAX_RUN_SEED + 1):
        with pytest.raises(TrainingError, match=r"seed must be in 0\.\.4000"):
            run_seed(seed)
