"""What a planner wants: a score for each simulated sequence, more is better.

An objective adds up what happens within the horizon and judges the state at its end, where the episode goes
on. `OBJECTIVES` has one for each task. With a value network
it is the discounted rewards and what the network expects after them, whatever the task.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from discjump_training.planner.flight import miss
from discjump_training.policy import Floats, Layout, Mask, Observations

Value = Callable[[Observations], Floats]


class Rewards:
    """Sum of rewards, and the value of the state at the end.

    Args:
        discount: of each decision's reward.
        value: of the last state; nothing where None.
    """

    def __init__(self, discount: float = 1.0, value: Value | None = None) -> None:
        self._discount = discount
        self._value = value

    def begin(self, count: int) -> None:
        """`count` sequences begin."""
        self._total = np.zeros(count)
        self._weight = 1.0

    def add(self, rewards: Floats, ended: Mask, running: Mask, info: dict[str, Any]) -> None:
        """A decision was simulated.

        Args:
            rewards: (count,).
            ended: whose episode it ended, (count,).
            running: whose episode had not ended before, (count,).
            info: of the step.
        """
        self._total += np.where(running, self._weight * rewards, 0.0)
        self._weight *= self._discount

    def scores(self, observations: Observations, running: Mask, block: int) -> Floats:
        """Scores (count,).

        Args:
            observations: the last ones, (count, size).
            running: whose episode goes on, (count,).
            block: observations that the value is asked about at once: one episode's.
        """
        if self._value is None:
            return self._total
        later = blockwise(self._value, observations, running, block)
        return np.where(running, self._total + self._weight * later, self._total)


class Seconds:
    """Negative time until success, s. Failures count as twice the time limit, the most that a living state
    counts: nobody dies because the way is long.

    Args:
        layout: of the observations.
        time_limit: of the episodes, s.
        to_go: seconds from a state to success, a guess.
    """

    def __init__(
        self, layout: Layout, time_limit: float, to_go: Callable[[Layout, Observations], Floats]
    ) -> None:
        self._layout = layout
        self._worst = 2.0 * time_limit
        self._to_go = to_go

    def begin(self, count: int) -> None:
        """`count` sequences begin."""
        self._score = np.zeros(count)
        self._time = np.zeros(count)

    def add(self, rewards: Floats, ended: Mask, running: Mask, info: dict[str, Any]) -> None:
        """A decision was simulated."""
        self._time = np.where(running, info["time"], self._time)
        if ended.any():
            reached = np.where(info["is_success"][ended], info["time"][ended], self._worst)
            self._score[ended] = -reached

    def scores(self, observations: Observations, running: Mask, block: int) -> Floats:
        """Scores (count,)."""
        later = blockwise(lambda some: self._to_go(self._layout, some), observations, running, block)
        return np.where(running, -np.minimum(self._time + later, self._worst), self._score)


class Flight:
    """Success, the sooner the better; without it the least miss of the flight that a state leads to.

    Args:
        layout: of the observations.
        options: of `discjump/DiscJump-v0`.
    """

    def __init__(self, layout: Layout, options: Any) -> None:
        self._layout = layout
        self._options = options

    def begin(self, count: int) -> None:
        """`count` sequences begin."""
        self._score = np.zeros(count)

    def add(self, rewards: Floats, ended: Mask, running: Mask, info: dict[str, Any]) -> None:
        """A decision was simulated."""
        if ended.any():
            limit = self._options.time_limit
            self._score[ended] = np.where(info["is_success"][ended], -info["time"][ended], -limit - FAR)

    def scores(self, observations: Observations, running: Mask, block: int) -> Floats:
        """Scores (count,)."""

        def left(some: Observations) -> Floats:
            return miss(self._layout, some, self._options.armor, self._options.arrival_radius)

        later = blockwise(left, observations, running, block)
        return np.where(running, -self._options.time_limit - np.minimum(later, FAR), self._score)


#: Miss of an episode that ended without success, m.
FAR = 1_000.0


def blockwise(value: Value, observations: Observations, running: Mask, block: int) -> Floats:
    """`value` of each block that has anybody running in it; 0 elsewhere."""
    found = np.zeros(len(observations))
    for start in range(0, len(observations), block):
        part = slice(start, start + block)
        if running[part].any():
            found[part] = value(observations[part])
    return found


def to_beacon(layout: Layout, observations: Observations) -> Floats:
    """Seconds from states of `discjump/Ski-v0` to the beacon, a guess.

    The distance over a cruising speed, less what speed towards the beacon, height above it and energy are
    worth. Chosen by how fast plans are that want it, not by how well it predicts: a least-squares fit to
    planned episodes of the training course predicts better (1.1 s rms in place of 2.0 s) and makes plans 2%
    slower.
    """
    return _run(layout, observations, "beacon")


#: Speed of a good skier over long ways, m/s.
CRUISE = 31.0


def _run(layout: Layout, observations: Observations, goal: str) -> Floats:
    distance = layout.read(observations, f"{goal}_distance")[:, 0]
    closing = layout.read(observations, "closing_speed")[:, 0]
    above = -layout.read(observations, f"{goal}_height")[:, 0]
    energy = layout.read(observations, "energy")[:, 0]
    # Far away all of it can be used; the nearer, the less.
    use = 1.0 - np.exp(-distance / 60.0)
    return np.maximum(
        distance / CRUISE - use * (0.1 * closing + 0.02 * above + 0.015 * energy), distance / 70.0
    )


#: What the last of a runner's health is worth, s, and from which share of deadly damage on it is. A disc at
#: the feet is quick and takes two thirds: who spends the rest dies of the next hard landing, out of sight.
HEALTH, HURT = 10.0, 0.5


def to_stand(layout: Layout, observations: Observations) -> Floats:
    """Seconds from states of `discjump/Route-v0` to the enemy flag, a guess: as `to_beacon`, and what damage
    costs.
    """
    hurt = layout.read(observations, "damage")[:, 0] / layout.scales["damage"]
    danger = np.clip((hurt - HURT) / (1.0 - HURT), 0.0, 1.0)
    return _run(layout, observations, "goal") + HEALTH * danger


#: The way home, s, for who has not taken the flag: more than the guess says right after the taking (some
#: 640 m, begun at full speed away from home). Were it less, plans would hover before the flag for ever.
HOMEWARD = 30.0


def to_capture(layout: Layout, observations: Observations) -> Floats:
    """Seconds from states of `discjump/FlagRun-v0` to the capture, a guess: to the next stand, and without
    the flag also the way home.
    """
    carrying = layout.read(observations, "carrying")[:, 0] > 0.5
    return to_stand(layout, observations) + np.where(carrying, 0.0, HOMEWARD)


OBJECTIVES: dict[str, Callable[[Layout, Any], Any]] = {
    "ski": lambda layout, options: Seconds(layout, options.time_limit, to_beacon),
    "disc-jump": Flight,
    "route": lambda layout, options: Seconds(layout, options.time_limit, to_stand),
    "flag-run": lambda layout, options: Seconds(layout, options.time_limit, to_capture),
}
"""By task's name, made of the layout of the observations and the task's options."""


def make(task: str, layout: Layout, options: Any) -> Any:
    """The task's objective without a value network."""
    return OBJECTIVES[task](layout, options)
