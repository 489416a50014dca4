"""Where action sequences come from.

All that is drawn for an episode comes from a generator of its own, so that its plan depends neither on the
episodes beside it nor on how many there are.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from discjump_training.planner.settings import Settings
from discjump_training.policy import Floats, Mask

Sequences = NDArray[np.int8]
"""Action sequences, (candidates, decisions, components): bins of a MultiDiscrete space."""


@dataclass
class Draft:
    """Sequences that are to be simulated.

    Attributes:
        actions: (candidates, decisions, components); what the guide is to decide is filled in while they are
            simulated.
        guided: where the guide decides, (guided, decisions, components), of the first `guided` sequences.
    """

    actions: Sequences
    guided: Mask


@dataclass
class Elites:
    """The best sequences so far, best first.

    Attributes:
        actions: (elites, decisions, components).
        scores: (elites,).
    """

    actions: Sequences
    scores: Floats


class Proposal(Protocol):
    """Draws sequences from what the last ones taught."""

    def draw(self, rng: np.random.Generator, elites: Elites, count: int, guided: int, fresh: bool) -> Draft:
        """`count` sequences, the guide completing `guided` of them; `fresh`: the first ones of a plan."""


def windows(
    rng: np.random.Generator, count: int, length: int, bins: NDArray[np.int64], most: int = 3
) -> tuple[Sequences, Mask, NDArray[np.int64]]:
    """Stretches of time in which some components are held at a drawn value.

    Returns:
        Values and where they hold, (count, length, components), and where the last stretch of each ends,
        (count,).
    """
    values = np.zeros((count, length, bins.size), np.int8)
    where = np.zeros(values.shape, np.bool_)
    last = np.zeros(count, np.int64)
    time = np.arange(length)
    for nth in range(most):
        # Log-uniform: a single decision as often as all of them.
        size = np.exp(rng.uniform(0.0, np.log(length + 1.0), count)).astype(np.int64)
        start = np.floor(rng.uniform(1 - size, length)).astype(np.int64)
        used = rng.random(count) < 0.5**nth
        end = np.where(used, np.clip(start + size, 0, length), 0)
        one = rng.integers(0, bins.size, count)[:, None] == np.arange(bins.size)
        some = np.where((rng.random(count) < 0.5)[:, None], one, rng.random((count, bins.size)) < 0.5)
        inside = (time >= start[:, None]) & (time < end[:, None])
        held = inside[:, :, None] & some[:, None, :]
        drawn = rng.integers(0, bins, (count, bins.size), dtype=np.int8)
        np.copyto(values, drawn[:, None, :], where=held)
        where |= held
        last = np.maximum(last, end)
    return values, where, last


class Evolve:
    """Changes windows of good sequences.

    After its last window a sequence goes on as the one it was made of, or as the guide decides. Of a plan's
    first ones a third is the guide's from the beginning but for the windows.
    """

    def __init__(self, settings: Settings, bins: NDArray[np.int64], length: int) -> None:
        self._bins = bins
        self._length = length

    def draw(self, rng: np.random.Generator, elites: Elites, count: int, guided: int, fresh: bool) -> Draft:
        """Sequences made of the elites, of better ones more often."""
        ranks = (len(elites.actions) * rng.random(count) ** 2).astype(np.int64)
        actions = elites.actions[ranks]
        values, where, last = windows(rng, count, self._length, self._bins)
        np.copyto(actions, values, where=where)
        begin = last[:guided].copy()
        if fresh:
            begin[: guided // 3] = 0
        handed = np.arange(self._length) >= begin[:, None]
        return Draft(actions, handed[:, :, None] & ~where[:guided])


class Categorical:
    """Draws each component of each decision from a categorical distribution that is fitted to good sequences.

    What is held for a while is the quantile that is drawn, not the value: so draws are smooth in time even
    where the distribution changes.

    Args:
        settings: `cem` weighs all elites the same, `mppi` by the exponential of their score.
        bins: of each component.
        length: of the sequences.
        stay: probability that a quantile is held for one more decision.
    """

    def __init__(self, settings: Settings, bins: NDArray[np.int64], length: int, stay: float) -> None:
        self._settings = settings
        self._bins = bins
        self._length = length
        self._stay = stay

    def draw(self, rng: np.random.Generator, elites: Elites, count: int, guided: int, fresh: bool) -> Draft:
        """Sequences from the distribution of the elites."""
        shape = (count, self._length, self._bins.size)
        step = np.where(rng.random(shape) < self._stay, 0, np.arange(self._length)[:, None])
        quantiles = np.take_along_axis(rng.random(shape), np.maximum.accumulate(step, axis=1), axis=1)
        cumulative = np.cumsum(self._distribution(elites), axis=2)
        actions = np.zeros(shape, np.int8)
        for edge in range(int(self._bins.max()) - 1):
            actions += quantiles >= cumulative[None, :, :, edge]
        np.minimum(actions, (self._bins - 1).astype(np.int8), out=actions)
        begin = rng.integers(0, self._length + 1, guided)
        handed = np.arange(self._length) >= begin[:, None]
        return Draft(actions, np.broadcast_to(handed[:, :, None], (guided, *shape[1:])).copy())

    def _distribution(self, elites: Elites) -> Floats:
        """(decisions, components, largest number of bins)."""
        s = self._settings
        weights = np.full(len(elites.actions), 1.0 / len(elites.actions))
        if s.proposal == "mppi" and np.isfinite(elites.scores).all():
            weights = np.exp((elites.scores - elites.scores.max()) / s.temperature)
            weights /= weights.sum()
        values = np.arange(self._bins.max())
        hits = elites.actions[..., None] == values
        fitted = np.einsum("m,mhcb->hcb", weights, hits)
        uniform = (values < self._bins[:, None]) / self._bins[:, None]
        mixed: Floats = (1.0 - s.explore) * fitted + s.explore * uniform
        return mixed


def make(settings: Settings, bins: NDArray[np.int64], length: int, decision_seconds: float) -> Proposal:
    """The proposal that the settings name."""
    if settings.proposal == "evolve":
        return Evolve(settings, bins, length)
    return Categorical(settings, bins, length, stay=max(0.0, 1.0 - decision_seconds / settings.hold))
