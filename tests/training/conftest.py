"""What the tests of training share: a recipe small enough for seconds."""

import pytest

from discjump_training.recipe import Recipe

TINY = (
    "ppo.steps=1_024",
    "ppo.batch_size=128",
    "ppo.n_epochs=2",
    "ppo.hidden=[8]",
    "rollout.num_envs=16",
    "rollout.n_steps=16",
    "watch.evaluate_every=512",
    "watch.evaluate_episodes=4",
    "watch.checkpoint_every=256",
    "watch.keep_checkpoints=2",
)


@pytest.fixture
def tiny() -> Recipe:
    return Recipe.load("ski", TINY)
