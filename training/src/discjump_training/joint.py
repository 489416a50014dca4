"""One choice of all keys in place of one choice per key, as a policy for stable-baselines3's PPO.

A policy that draws each component of its action by itself cannot want (forward, left) as much as
(back, right) without wanting (forward, right) as well. Which way is pressed and whether the jets burn belong
together: skiers tack, and jet towards one side or the other.
"""

from typing import Any

import numpy as np
import torch
from stable_baselines3.common.distributions import MultiCategoricalDistribution
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.type_aliases import Schedule
from torch import Tensor

#: Components of an action that are keys: forward, strafe, jump, jet. They come first.
KEYS = 4


class JointKeys(MultiCategoricalDistribution):
    """Actions in bins, of which the first `KEYS` components are drawn as one.

    Args:
        bins: of the action space's components.

    >>> JointKeys([3, 3, 2, 2, 7]).action_dims
    [36, 7]
    """

    def __init__(self, bins: list[int]) -> None:
        self.bins = list(bins[:KEYS])
        super().__init__([int(np.prod(self.bins)), *bins[KEYS:]])

    def encode(self, actions: Tensor) -> Tensor:
        """Choices (n, components - KEYS + 1) of actions (n, components).

        >>> one = JointKeys([3, 3, 2, 2, 7])
        >>> one.encode(torch.tensor([[2, 0, 1, 0, 6]]))
        tensor([[26,  6]])
        """
        keys = actions[:, 0]
        for nth, count in enumerate(self.bins[1:], 1):
            keys = keys * count + actions[:, nth]
        return torch.cat([keys[:, None], actions[:, KEYS:]], dim=1)

    def decode(self, choices: Tensor) -> Tensor:
        """Actions (n, components) of choices (n, components - KEYS + 1).

        >>> one = JointKeys([3, 3, 2, 2, 7])
        >>> one.decode(torch.tensor([[26, 6]]))
        tensor([[2, 0, 1, 0, 6]])
        """
        left, keys = choices[:, 0], []
        for count in reversed(self.bins):
            keys.append(left % count)
            left = left // count
        return torch.cat([torch.stack(keys[::-1], dim=1), choices[:, 1:]], dim=1)

    def log_prob(self, actions: Tensor) -> Tensor:
        """Logarithms of the actions' probabilities, (n,)."""
        return super().log_prob(self.encode(actions))

    def sample(self) -> Tensor:
        """Drawn actions (n, components)."""
        return self.decode(super().sample())

    def mode(self) -> Tensor:
        """Likeliest actions (n, components)."""
        return self.decode(super().mode())


class JointPolicy(ActorCriticPolicy):
    """`MlpPolicy` for actions in bins that begin with the keys, which it chooses as one."""

    def _build(self, lr_schedule: Schedule) -> None:
        space: Any = self.action_space
        self.action_dist = JointKeys([int(count) for count in space.nvec])
        super()._build(lr_schedule)


def likeliest(dist: MultiCategoricalDistribution, logits: Tensor) -> Tensor:
    """Likeliest actions (n, components) by logits (n, sum of the choices) of a distribution over bins."""
    parts = torch.split(logits, list(dist.action_dims), dim=1)
    choices = torch.stack([part.argmax(dim=1) for part in parts], dim=1)
    return dist.decode(choices) if isinstance(dist, JointKeys) else choices
