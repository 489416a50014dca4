"""Keys chosen as one, against numpy's softmax over every action there is."""

import numpy as np
import pytest
import torch
from scipy import special, stats
from stable_baselines3 import PPO

from discjump.sb3 import make_vec_env
from discjump_training.joint import JointKeys, JointPolicy, likeliest
from discjump_training.policy import ARMED_BINS, BINS

EACH = pytest.mark.parametrize("bins", [BINS, ARMED_BINS])


def every(bins):
    """All actions, (n, components)."""
    return np.stack(np.unravel_index(np.arange(np.prod(bins)), bins), axis=1)


def drawn_logits(bins, seed=0):
    """Logits (1, choices) of one observation, and the probability of each action of `every`."""
    rng = np.random.default_rng(seed)
    sizes = [36, *bins[4:]]
    logits = [rng.normal(scale=1.5, size=size) for size in sizes]
    parts = [special.softmax(one) for one in logits]
    chance = parts[0]
    for part in parts[1:]:
        chance = np.multiply.outer(chance, part)
    return torch.tensor(np.concatenate(logits))[None], chance.ravel()


@EACH
def test_choices_count_the_keys_as_numpy_does(bins):
    actions = every(bins)
    one = JointKeys(list(bins))
    choices = one.encode(torch.tensor(actions))
    assert (choices[:, 0].numpy() == np.ravel_multi_index(tuple(actions[:, :4].T), bins[:4])).all()
    assert (one.decode(choices).numpy() == actions).all()


@EACH
def test_probabilities_are_those_of_a_softmax_over_all_keys(bins):
    logits, chance = drawn_logits(bins)
    actions = torch.tensor(every(bins))
    rows = JointKeys(list(bins)).proba_distribution(logits.expand(len(actions), -1))
    np.testing.assert_allclose(rows.log_prob(actions).exp().numpy(), chance, rtol=1e-9)
    np.testing.assert_allclose(rows.entropy()[0].item(), stats.entropy(chance), rtol=1e-9)
    best = every(bins)[chance.argmax()]
    assert (rows.mode()[0].numpy() == best).all()
    assert (likeliest(rows, logits)[0].numpy() == best).all()


def test_actions_are_drawn_as_often_as_they_are_likely():
    logits, chance = drawn_logits(BINS)
    torch.manual_seed(0)
    drawn = JointKeys(list(BINS)).proba_distribution(logits.expand(200_000, -1)).sample().numpy()
    counts = np.bincount(np.ravel_multi_index(tuple(drawn.T), BINS), minlength=chance.size)
    assert stats.chisquare(counts, chance * counts.sum()).pvalue > 1e-3


def test_keys_may_depend_on_each_other():
    """Forward and left, or back and right, each half of the time: no product of two choices can."""
    logits = torch.full((1, 36 + 7), -50.0)
    logits[0, [24, 8]] = 0.0
    made = JointKeys(list(BINS)).proba_distribution(logits.expand(1_000, -1))
    torch.manual_seed(0)
    ways = made.sample()[:, :2].numpy()
    assert set(map(tuple, ways)) == {(2, 0), (0, 2)}
    assert 400 < (ways[:, 0] == 2).sum() < 600


def test_a_model_saved_and_loaded_says_the_same(tmp_path):
    env = make_vec_env("discjump/DiscJump-v0", n_envs=8, seed=0, threads=1)
    ppo = PPO(JointPolicy, env, n_steps=8, batch_size=32, seed=0, device="cpu").learn(64)
    ppo.save(tmp_path / "joint")
    seen = env.reset()
    loaded = PPO.load(tmp_path / "joint", device="cpu")
    assert isinstance(loaded.policy, JointPolicy)
    said, _ = ppo.predict(seen, deterministic=True)
    assert said.shape == (8, len(ARMED_BINS))
    np.testing.assert_array_equal(loaded.predict(seen, deterministic=True)[0], said)
    env.close()
