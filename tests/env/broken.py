"""Vector environments that break determinism on purpose, each in one way; `discjump verify` must catch each.

They are ours with one thing made wrong, at the interface that is verified.
"""

import numpy as np

from discjump.envs.named import SkiVectorEnv

GENERATOR = np.random.default_rng()
"""A process-wide generator, as a careless environment uses one."""


class Honest(SkiVectorEnv):
    """Ours; `nudge` changes the observations of the others."""

    def __init__(self, num_envs=1, *, threads=None, **options):
        super().__init__(num_envs, threads=threads, **options)
        self.threads = threads

    def step(self, actions):
        observations, *rest = super().step(actions)
        observations = observations.copy()
        self.nudge(observations)
        return observations, *rest

    def nudge(self, observations):
        """Nothing."""


class GlobalGenerator(Honest):
    """Noise from a generator that all environments of the process share."""

    def nudge(self, observations):
        observations[:, 3] += GENERATOR.normal(0.0, 1e-6, len(observations)).astype(np.float32)


class Padding(Honest):
    """The last register is filled up with lanes that nobody wrote, and the last player reads one.

    What memory holds there is emulated by a pattern that is another in every buffer.
    """

    buffers = 0

    def __init__(self, num_envs=1, *, lanes=None, **options):
        super().__init__(num_envs, lanes=lanes, **options)
        self.register = lanes or 1

    def nudge(self, observations):
        num = len(observations)
        registers = -(-num // self.register)
        memory = np.empty((registers * self.register, 1), np.float32)
        Padding.buffers += 1
        memory.view(np.uint32)[:] = 0x3F000000 + Padding.buffers
        memory[:num, 0] = observations[:, 4]
        if num % self.register:
            observations[-1, 4] = memory[num, 0]


class Position(Honest):
    """A number that depends on the index in the batch, in its last bit."""

    def nudge(self, observations):
        observations[5:, 6] = np.nextafter(observations[5:, 6], np.float32(8.0))


class Threads(Honest):
    """A sum whose order depends on the number of threads."""

    def nudge(self, observations):
        if self.threads is not None and self.threads > 2:
            observations[:, 7] = np.nextafter(observations[:, 7], np.float32(8.0))


class BatchSize(Honest):
    """Normalised by statistics of the batch."""

    def nudge(self, observations):
        observations[:, 0] -= np.float32(1e-7) * (len(observations) - 1)


class Lanes(Honest):
    """Another product where players are stepped side by side: contracted to one rounding, say."""

    def __init__(self, num_envs=1, *, lanes=None, **options):
        super().__init__(num_envs, lanes=lanes, **options)
        self.side_by_side = lanes is not None and lanes > 1

    def nudge(self, observations):
        if self.side_by_side:
            observations[:, 8] = np.nextafter(observations[:, 8], np.float32(8.0))


class Forgetful(Honest):
    """A counter that rewards depend on, and that a snapshot forgets."""

    def __init__(self, num_envs=1, **options):
        super().__init__(num_envs, **options)
        self.counts = np.zeros(num_envs, np.int64)
        self.over = np.zeros(num_envs, np.bool_)

    def reset(self, *, seed=None, options=None):
        mask = (options or {}).get("reset_mask")
        self.counts[... if mask is None else mask] = 0
        self.over[... if mask is None else mask] = False
        return super().reset(seed=seed, options=options)

    def step(self, actions):
        observations, rewards, terminated, truncated, info = super().step(actions)
        begun = self.over if self.autoreset_mode.value == "NextStep" else np.zeros_like(self.over)
        self.counts = np.where(begun, 0, self.counts + 1)
        rewards = rewards + 2.0**-20 * self.counts
        self.over = terminated | truncated
        if self.autoreset_mode.value == "SameStep":
            self.counts[self.over] = 0
        return observations, rewards, terminated, truncated, info


class SameSeed(Honest):
    """Forgets the seed that it was given."""

    def reset(self, *, seed=None, options=None):
        return super().reset(seed=None if seed is None else [0] * self.num_envs, options=options)


class Autoreset(Honest):
    """The reward of an episode's last decision is lost in one autoreset mode."""

    def step(self, actions):
        observations, rewards, terminated, truncated, info = super().step(actions)
        if self.autoreset_mode.value == "SameStep":
            rewards = np.where(terminated | truncated, 0.0, rewards)
        return observations, rewards, terminated, truncated, info
