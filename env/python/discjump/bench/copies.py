"""What a tree search and a busy process ask: snapshots, copies, two threads, and the answer to Ctrl-C."""

import copy
import pickle
import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from discjump.bench.clock import Effort, Ready, interleave, loop, spread
from discjump.bench.figure import Figure, call, ratio, row
from discjump.bench.ways import SEED, random_actions
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.simulator import Simulator
from discjump.terrains import generated

ANSWER = 100.0
"""Longest time to an answer to Ctrl-C that is asked for, ms."""
INTERRUPTS = 20


@dataclass(frozen=True)
class Copies:
    """A call on environments in the middle of their episodes."""

    what: str
    num_envs: int
    """0: `gymnasium.make`'s environment."""
    one: bool = False
    """Of one environment among them, else of all."""
    units: ClassVar[int] = 1
    calls: ClassVar[int | None] = None

    def make(self) -> Ready:
        """The environments, 50 decisions after their reset."""
        options: dict[str, Any] = {"terrain_seeds": [SEED]}
        envs: Any = SkiVectorEnv(self.num_envs, **options) if self.num_envs else SkiEnv(**options)
        envs.reset(seed=0)
        for action in np.resize(
            random_actions(max(1, self.num_envs), np.int64), (50, max(1, self.num_envs), 5)
        ):
            envs.step(action if self.num_envs else action[0])
        index = () if not self.num_envs else (self.num_envs // 2 if self.one else None,)
        saved = envs.snapshot(*index)

        def back_and_on(action: Any) -> None:
            envs.restore(saved, *index)
            envs.step(action)

        calls: dict[str, Callable[[Any], object]] = {
            "snapshot": lambda _: envs.snapshot(*index),
            "restore": lambda _: envs.restore(saved, *index),
            "restore and step": back_and_on,
            "deepcopy": lambda _: copy.deepcopy(envs),
            "pickle and back": lambda _: pickle.loads(pickle.dumps(envs)),
        }
        actions = random_actions(max(1, self.num_envs), np.int64)
        return Ready(loop(calls[self.what], list(actions if self.num_envs else actions[:, 0])))


@dataclass(frozen=True)
class Threads:
    """Two simulators of one thread each, stepped by two Python threads at once, or one after the other."""

    at_once: bool
    units: ClassVar[int] = 2 * 4096 * 25
    calls: ClassVar[int | None] = None

    def make(self) -> Ready:
        """Both."""
        sims = [Simulator(generated(SEED), 4096, threads=1) for _ in range(2)]

        def step(sim: Simulator, calls: int) -> None:
            inputs = sim.inputs()
            inputs["forward"] = 1
            for _ in range(calls):
                sim.step(inputs, 25)

        def timed(calls: int) -> float:
            begin = time.perf_counter()
            if self.at_once:
                workers = [threading.Thread(target=step, args=(sim, calls)) for sim in sims]
                for worker in workers:
                    worker.start()
                for worker in workers:
                    worker.join()
            else:
                for sim in sims:
                    step(sim, calls)
            return time.perf_counter() - begin

        return Ready(timed)


def measure(effort: Effort) -> list[dict[str, Any]]:
    """All figures, for `figure.table` and JSON."""
    figures = list(_figures())
    times = interleave((case for figure in figures for case in figure.cases), effort, "copies")
    return [*(row(figure, times) for figure in figures), *_answers(2 if effort.quick else INTERRUPTS)]


def _figures() -> Iterator[Figure]:
    for what in ("snapshot", "restore", "restore and step", "deepcopy", "pickle and back"):
        yield call(f"one environment, {what}", Copies(what, 0))
    for what in ("snapshot", "restore"):
        yield call(f"one of 4,096 environments, {what}", Copies(what, 4096, one=True))
    for what in ("snapshot", "restore", "restore and step", "pickle and back"):
        yield call(f"4,096 environments, {what}", Copies(what, 4096))
    what = "two simulators stepped by two Python threads at once over one after the other"
    yield ratio(what, (Threads(False), Threads(True)), 1.8, at_least=True)


class Interrupted(Exception):
    """Raised by the signal's handler."""


def _answers(times: int) -> Iterator[dict[str, Any]]:
    """Milliseconds from a signal to the exception that its handler raises, out of the middle of a call."""
    terrain = generated(SEED)
    for fidelity in ("authentic", "reference", "engine"):
        for players in (1, 4096):
            sim = Simulator(terrain, players, fidelity=fidelity)
            keys = sim.inputs()
            keys["forward"] = 1

            def ticks(sim: Simulator = sim, keys: Any = keys) -> None:
                sim.step(keys, 2**32 - 1)

            yield _answer(f"{players:,} players, {fidelity}, ticks without end", ticks, times)
    count = 200_000
    envs = SkiVectorEnv(count, threads=1, fidelity="reference", frame_skip=64, terrain_seeds=[SEED])
    envs.reset(seed=0)
    saved, actions = envs.snapshot(), np.tile([2, 1, 1, 1, 3], (count, 1))

    def decide() -> None:
        envs.restore(saved)
        while True:
            envs.step(actions)

    yield _answer(f"{count:,} environments, reference, a decision of 64 ticks", decide, times)


def _answer(what: str, call: Callable[[], None], times: int) -> dict[str, Any]:
    def handler(*_: object) -> None:
        raise Interrupted

    rng = np.random.default_rng(0)
    taken: list[float] = []
    previous = signal.signal(signal.SIGALRM, handler)
    try:
        while len(taken) < times:
            delay = rng.uniform(0.2, 0.4)
            due = time.perf_counter() + delay
            signal.setitimer(signal.ITIMER_REAL, delay)
            try:
                call()
            except Interrupted:
                taken.append((time.perf_counter() - due) * 1e3)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)
    middle = spread(np.array(taken))
    return {
        "what": f"answer to Ctrl-C, {what}, worst of {times}",
        "unit": "ms",
        "asked": ANSWER,
        "at_least": False,
        "median": max(taken),
        "low": middle.low,
        "high": max(taken),
        "met": max(taken) <= ANSWER,
        "values": taken,
    }
