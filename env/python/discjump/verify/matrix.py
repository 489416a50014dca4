"""The rows of one subject: what is played beside its reference, and must give its bits."""

import pickle
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from discjump.verify.draws import mix, shuffled
from discjump.verify.form import Form, configurations, whole
from discjump.verify.interface import DISABLED, NEXT_STEP, Movable, Subject
from discjump.verify.reference import Reference
from discjump.verify.run import Difference, Run
from discjump.verify.ways import SLOW


@dataclass(frozen=True)
class Outcome:
    """How a row went."""

    compared: int = 0
    """Rows of environments that were compared."""
    difference: Difference | None = None
    skipped: str = ""
    """Why it was not played; empty: it was."""
    failure: str = ""
    """What is wrong, where it is no difference between two numbers."""


Play = Callable[[], Outcome]


@dataclass(frozen=True)
class Paused:
    """A batch in mid-episode."""

    snapshot: bytes
    environments: NDArray[np.int64]
    rows: NDArray[np.int64]
    difference: Difference | None


def rows(table: "Table", apart: bool = False) -> Iterator[tuple[str, Play]]:
    """Names of rows and how they are played; those of other processes are elsewhere (`children`).

    With `apart` the ways in that are slow to import are left to another process as well.
    """
    subject, form = table.subject, table.form
    yield "seeds", table.seeds
    yield "again", table.again
    for batch, threads, lanes in configurations(form, table.widths):
        name = f"batch {batch}, threads {threads}, lanes {lanes}"
        yield name, lambda where=(batch, threads, lanes): table.matrix(*where)  # type: ignore[misc]
    for shift in form.shifts:
        yield f"position: {shift} places on", lambda shift=shift: table.position(shift)  # type: ignore[misc]
    for number in range(form.snapshots):
        for name, play in (("back", table.back), ("another object", table.elsewhere)):
            yield f"snapshot {number}: {name}", lambda play=play, number=number: play(number)  # type: ignore[misc]
    yield "snapshot: pickled", table.pickled
    if len(subject.modes) > 1:
        yield "snapshot: one by one into another batch", table.settled
        yield "reset order: one by one", table.one_by_one
        yield "reset order: halves, after others", table.halves
        yield "reset order: some in mid-episode", table.midway
        for mode in subject.modes:
            yield f"autoreset {mode}", lambda mode=mode: table.autoreset(mode)  # type: ignore[misc]
    for way in subject.ways():
        if not (apart and way in SLOW):
            yield f"way {way}", lambda way=way: table.way(way)  # type: ignore[misc]


class Table:
    """How the rows of one subject are played."""

    def __init__(self, subject: Subject, reference: Reference, form: Form) -> None:
        self.subject, self.reference, self.form = subject, reference, form
        self.count = len(reference.seeds)
        self.widths = subject.widths()
        self._paused: dict[int, Paused] = {}
        # Episodes' ends by the caller's hand are another row's matter.
        self.mode = NEXT_STEP if NEXT_STEP in subject.modes else subject.modes[0]

    def run(
        self,
        environments: NDArray[np.int64],
        where: str,
        threads: int = 1,
        lanes: int = 1,
        mode: str | None = None,
    ) -> Run:
        """A batch of these environments, before its first reset."""
        batch = self.subject.batch(
            len(environments), threads=threads, lanes=lanes, mode=self.mode if mode is None else mode
        )
        return Run(self.subject, self.reference, batch, environments, where)

    def crowd(self, size: int) -> NDArray[np.int64]:
        """(size,): every environment as often as another, in no order."""
        return shuffled(size, size) % self.count

    def seeds(self) -> Outcome:
        """Environments with other seeds must do other things, and are told to do others."""
        digests = [self.reference.environment_digest(i) for i in range(self.count)]
        told = [self.reference.told_digest(i) for i in range(self.count)]
        for what, found in (("show the same", digests), ("are told the same", told)):
            for place, digest in enumerate(found):
                if (first := found.index(digest)) != place:
                    pair = f"{self.reference.seeds[first]} and {self.reference.seeds[place]}"
                    return Outcome(failure=f"seeds: environments with seeds {pair} {what} to the last bit")
        return Outcome(self.count * self.reference.length)

    def again(self) -> Outcome:
        """Alone again, as the reference was; the process-wide generators stand elsewhere."""
        saved = random.getstate(), np.random.get_state()  # noqa: NPY002
        random.seed(mix(1))
        np.random.seed(2)  # noqa: NPY002
        try:
            return self._each(self._picked(1), "alone, again", mode=self.subject.modes[0])
        finally:
            random.setstate(saved[0])
            np.random.set_state(saved[1])  # noqa: NPY002

    def matrix(self, batch: int, threads: int, lanes: int) -> Outcome:
        """A batch of this size, on so many threads, in lanes of this width."""
        where = f"batch {batch}, threads {threads}, lanes {lanes}"
        if batch < 64:
            return self._each(self._picked(batch), where, threads, lanes)
        short = self.form.crowd_decisions[self.subject.steps is not None]
        decisions = None if whole(self.form, batch, threads, lanes, self.widths) else short
        return done([self.run(self.crowd(batch), where, threads, lanes).start().advance(decisions)])

    def position(self, shift: int) -> Outcome:
        """Everybody at another index."""
        where = f"position: {shift} places on"
        run = self.run(np.roll(self.crowd(64), shift), where, 1, 1).start()
        return done([run.advance(self.form.decisions)])

    def paused(self, number: int) -> "Paused":
        """A batch in mid-episode."""
        if number not in self._paused:
            run = self.run(self.crowd(64), f"snapshot {number}", 2, self.widths[-1]).start()
            run.advance(self.moment(number))
            self._paused[number] = Paused(run.batch.snapshot(), run.environments, run.rows, run.difference)
        return self._paused[number]

    def resumed(self, paused: "Paused", where: str, threads: int, lanes: int) -> Run:
        """Another object that goes on where a batch was."""
        run = self.run(paused.environments, where, threads, lanes)
        run.batch.restore(paused.snapshot)
        run.rows, run.difference = paused.rows.copy(), paused.difference
        return run

    def back(self, number: int) -> Outcome:
        """Restored, some decisions played, and back to where it was."""
        paused = self.paused(number)
        run = self.resumed(paused, f"snapshot {number}: back", 2, self.widths[-1])
        run.advance(40)
        run.batch.restore(paused.snapshot)
        run.rows = paused.rows.copy()
        return done([run.advance()])

    def elsewhere(self, number: int) -> Outcome:
        """A snapshot goes on in another object: on other threads, in other lanes."""
        where = f"snapshot {number}: another object"
        return done([self.resumed(self.paused(number), where, 3, self.widths[0]).advance()])

    def pickled(self) -> Outcome:
        """A copy by pickle, in mid-episode."""
        run = self.resumed(self.paused(0), "snapshot: pickled", 2, self.widths[-1])
        run.batch = pickle.loads(pickle.dumps(run.batch))
        return done([run.advance()])

    def settled(self) -> Outcome:
        """Each environment moves alone, to another index, into a batch of other threads and lanes."""
        where = "snapshot: one by one into another batch"
        first = self.resumed(self.paused(0), where, 1, self.widths[-1])
        order = shuffled(64, 11)[:19]
        second = self.run(first.environments[order], where, 2, self.widths[0])
        second.batch.reset([seed + 1000 for seed in second.seeds])
        for index, source in enumerate(order.tolist()):
            cast(Movable, second.batch).settle(cast(Movable, first.batch).moved(source), index)
        second.rows = first.rows[order]
        return done([first, second.advance()])

    def moment(self, number: int) -> int:
        """The decision at which a snapshot is taken: within the episodes, the last one late enough that some
        have ended.
        """
        length = self.reference.length
        return 2 * length // 3 if number == 0 else 1 + mix(number) % (length - 2)

    def one_by_one(self) -> Outcome:
        """Every environment reset by a call of its own, in no order."""
        run = self.run(self.crowd(16), "reset order: one by one", 2, self.widths[-1], DISABLED)
        for index in shuffled(16, 7):
            mask = np.arange(16) == index
            run.again(mask, [seed if chosen else None for seed, chosen in zip(run.seeds, mask, strict=True)])
        return done([run.advance(self.form.decisions)])

    def halves(self) -> Outcome:
        """Other episodes first; then the seeds, in two halves of no order."""
        run = self.run(self.crowd(64), "reset order: halves, after others", 2, self.widths[-1], DISABLED)
        run.batch.reset([seed + 1000 for seed in run.seeds])
        for _ in range(20):
            run.batch.step(self.reference.actions[run.environments[::-1], 1])
        half = shuffled(64, 8) < 32
        run.again(~half)
        run.again(half)
        return done([run.advance(self.form.decisions)])

    def midway(self) -> Outcome:
        """Some begin again while others go on."""
        run = self.run(self.crowd(64), "reset order: some in mid-episode", 3, self.widths[-1]).start()
        run.advance(100)
        some = shuffled(64, 9) < 20
        if run.difference is None:
            run.again(some, [seed if chosen else None for seed, chosen in zip(run.seeds, some, strict=True)])
        return done([run.advance(self.form.decisions)])

    def autoreset(self, mode: str) -> Outcome:
        """The episodes in this autoreset mode."""
        where = f"autoreset {mode}"
        if not self.form.crossed:
            return done([self.run(self.crowd(64), where, 2, self.widths[-1], mode).start().advance()])
        few = self.run(self._picked(3)[0], where, mode=mode)
        many = self.run(self.crowd(64), where, 2, self.widths[-1], mode)
        return done([few.start().advance(), many.start().advance()])

    def way(self, name: str) -> Outcome:
        """The episodes through another way in."""
        environments = self.crowd(self.form.ways)
        try:
            batch = self.subject.way(name, len(environments))
        except ImportError as error:
            return Outcome(skipped=str(error))
        return done(
            [
                Run(self.subject, self.reference, batch, environments, f"way {name}")
                .start()
                .advance(self.form.decisions)
            ]
        )

    def _each(
        self,
        picked: list[NDArray[np.int64]],
        where: str,
        threads: int = 1,
        lanes: int = 1,
        mode: str | None = None,
    ) -> Outcome:
        runs = []
        for environments in picked:
            runs.append(
                self.run(environments, where, threads, lanes, mode).start().advance(self.form.decisions)
            )
            if runs[-1].difference is not None:
                break
        return done(runs)

    def _picked(self, size: int) -> list[NDArray[np.int64]]:
        """Small batches of environments."""
        order = shuffled(self.count, size)
        return [np.roll(order, size * number)[:size] for number in range(self.form.alone)]


def done(runs: list[Run]) -> Outcome:
    """How a row of these runs went."""
    differences = [run.difference for run in runs if run.difference is not None]
    return Outcome(sum(run.compared for run in runs), differences[0] if differences else None)
