"""A policy that sees less well."""

import numpy as np

from discjump_training.draws import RowDraws
from discjump_training.policy import Actions, Floats, Mask, Observations, Policy


class Noisy:
    """A policy with Gaussian noise on its observations. The same episode has the same noise for every policy
    that observes as much.

    Args:
        policy: the one that decides.
        sigma: standard deviation, in the observation's own numbers (most lie in [-1, 1]).
        size: numbers in an observation.
        seed: of the noise.
    """

    def __init__(self, policy: Policy, sigma: float, size: int, seed: int = 1) -> None:
        def draw(generator: np.random.Generator, count: int) -> Floats:
            return generator.normal(0.0, sigma, size=(count, size))

        self._policy = policy
        self._draws = RowDraws(seed, draw)
        self.name, self.note = policy.name, policy.note

    def begin(self, rows: range) -> None:
        """The episodes of these rows are played next."""
        self._draws.begin(rows)
        if hasattr(self._policy, "begin"):
            self._policy.begin(rows)

    def reset(self, done: Mask) -> None:
        """Episodes begin in `done`."""
        self._policy.reset(done)

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        noise = self._draws.next(len(observations))
        return self._policy((observations + noise).astype(np.float32))
