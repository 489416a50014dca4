"""Cases against the clock: within a repeat they take turns, so that a busy machine slows all alike."""

import itertools
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import click
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Unavailable(Exception):
    """A case that cannot be measured here; the message says why, or what to install."""


class Ready(NamedTuple):
    """A case that was set up."""

    time: Callable[[int], float]
    """Seconds of so many calls."""
    observation: int = 0
    """Numbers in an observation; 0: there is none."""
    lanes: int = 0
    """How many players are stepped side by side; 0: not ours."""


class Case(Protocol):
    """Something to measure. Equal cases are measured once."""

    @property
    def units(self) -> int:
        """Agent steps, player-ticks or resets of a call."""

    @property
    def calls(self) -> int | None:
        """Calls of a repeat; None: as many as fill it."""

    def make(self) -> Ready:
        """Set up; raises `Unavailable`."""


class Effort(NamedTuple):
    """How long to measure."""

    repeats: int
    seconds: float
    """Of one repeat of one case."""
    quick: bool = False
    """Whether it runs, not how fast: two calls where a case fixes their number."""


class Timed(NamedTuple):
    """What the clock said of a case."""

    seconds: Floats
    """(repeats,), of one call."""
    units: int
    observation: int
    lanes: int

    @property
    def rate(self) -> Floats:
        """(repeats,), units a second."""
        return self.units / self.seconds


Times = dict[Case, Timed | Unavailable]


class Spread(NamedTuple):
    """Median and quartiles."""

    median: float
    low: float
    high: float


def spread(values: Floats) -> Spread:
    """Median and quartiles of the repeats.

    >>> spread(np.array([4.0, 1.0, 2.0, 3.0, 5.0]))
    Spread(median=3.0, low=2.0, high=4.0)
    """
    low, median, high = np.quantile(values, [0.25, 0.5, 0.75]).tolist()
    return Spread(median, low, high)


class Prepared(NamedTuple):
    """A case that was set up and warmed up."""

    ready: Ready
    calls: int
    """Of a repeat."""


def prepare(cases: Iterable[Case], effort: Effort) -> dict[Case, Prepared | Unavailable]:
    """Set every case up once, in the order given; what cannot be measured says why."""
    made: dict[Case, Prepared | Unavailable] = {}
    for case in dict.fromkeys(cases):
        try:
            ready = case.make()
        except Unavailable as why:
            made[case] = why
        else:
            made[case] = Prepared(ready, _calls(case, ready, effort))
    return made


def repeat(
    prepared: Mapping[Case, Prepared | Unavailable], done: Callable[[int], object]
) -> dict[Case, float]:
    """Seconds of one call of each case that can be measured, one after the other; `done` is told each."""
    seconds = {}
    for case, made in prepared.items():
        if isinstance(made, Prepared):
            seconds[case] = made.ready.time(made.calls) / made.calls
            done(1)
    return seconds


def interleave(cases: Iterable[Case], effort: Effort, label: str) -> Times:
    """Measure every case once a repeat, in the order given; what cannot be measured says why."""
    prepared = prepare(cases, effort)
    measured = sum(isinstance(made, Prepared) for made in prepared.values())
    with click.progressbar(length=effort.repeats * measured, label=label) as bar:
        taken = [repeat(prepared, bar.update) for _ in range(effort.repeats)]
    times: Times = {}
    for case, made in prepared.items():
        if isinstance(made, Prepared):
            seconds = np.array([one[case] for one in taken])
            times[case] = Timed(seconds, case.units, made.ready.observation, made.ready.lanes)
        else:
            times[case] = made
    return times


def loop(step: Callable[[Any], object], arguments: Sequence[Any]) -> Callable[[int], float]:
    """A clock on a Python loop over `step`, with the arguments in turn."""

    def timed(calls: int) -> float:
        begin = time.perf_counter()
        for argument in itertools.islice(itertools.cycle(arguments), calls):
            step(argument)
        return time.perf_counter() - begin

    return timed


def _calls(case: Case, made: Ready, effort: Effort) -> int:
    """Also warms up."""
    calls, taken = 1, made.time(1)
    if case.calls is not None:
        return min(case.calls, 2) if effort.quick else case.calls
    while taken < effort.seconds / 4:
        calls *= 4
        taken = made.time(calls)
    return max(1, round(calls * effort.seconds / taken))
