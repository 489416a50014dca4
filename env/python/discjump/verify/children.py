"""The rows of other processes: forked, spawned and from a fork server, whole episodes and snapshots."""

import multiprocessing
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.verify.matrix import Outcome, Table, done
from discjump.verify.run import Run
from discjump.verify.ways import SLOW

METHODS = tuple(
    method for method in ("fork", "spawn", "forkserver") if method in multiprocessing.get_all_start_methods()
)
"""How a process can be started here."""
POOLED, DECISIONS = 640, 6
"""So many environments, for so many decisions, are stepped by threads."""
PATIENCE = 120.0
"""A child that says nothing for so long hangs, s."""


@dataclass(frozen=True)
class Job:
    """What a child plays: whole episodes, and what goes on from a snapshot of its parent."""

    table: Table
    snapshot: bytes
    environments: NDArray[np.int64]
    rows: NDArray[np.int64]

    def names(self, method: str, apart: bool) -> list[str]:
        """The rows that a child plays."""
        ways = [way for way in self.table.subject.ways() if way in SLOW] if apart else []
        return [f"process {method}", *(f"way {way}" for way in ways)]

    def play(self, name: str) -> Outcome:
        """Play a row here."""
        if name.startswith("way "):
            return self.table.way(name.removeprefix("way "))
        table, widest = self.table, self.table.widths[-1]
        runs = []
        if table.form.processes:
            runs.append(table.run(table.crowd(64), name, 2, widest).start().advance())
        runs.append(table.run(table.crowd(POOLED), f"{name}, {POOLED}", 2, widest).start().advance(DECISIONS))
        batch = table.subject.batch(len(self.environments), threads=2, lanes=table.widths[0], mode=table.mode)
        batch.restore(self.snapshot)
        where = f"{name}, from its parent's snapshot"
        after = Run(table.subject, table.reference, batch, self.environments, where, self.rows)
        return done([*runs, after.advance()])


def job(table: Table) -> Job:
    """The job of a subject; the parent's threads are at work before it forks."""
    table.run(table.crowd(POOLED), "parent", 2, table.widths[-1]).start().advance(2)
    paused = table.paused(0)
    return Job(table, paused.snapshot, paused.environments, paused.rows)


class Child:
    """A process that plays jobs one after the other; one that dies or hangs fails what it had not played yet.

    Args:
        method: how it is started.
        jobs: what it plays.
        apart: whether it plays the ways in that are slow to import as well.
        patience: time without an answer after which it is given up, s.
    """

    def __init__(self, method: str, jobs: list[Job], apart: bool = False, patience: float = PATIENCE) -> None:
        context: Any = multiprocessing.get_context(method)
        played = [(job, job.names(method, apart)) for job in jobs]
        self._names = iter([names for _, names in played])
        self._answers, self._theirs = context.Pipe(duplex=False)
        self._process = context.Process(target=_child, args=(self._theirs, played), daemon=True)
        self._name, self._patience = f"process {method}", patience
        self._failure = ""

    def start(self) -> None:
        """Start it."""
        self._process.start()
        self._theirs.close()

    def next(self) -> dict[str, Outcome]:
        """What became of the rows of the next job."""
        return {name: self._outcome() for name in next(self._names)}

    def _outcome(self) -> Outcome:
        if not self._failure:
            try:
                if self._answers.poll(self._patience):
                    outcome: Outcome = self._answers.recv()
                    return outcome
                self._failure = f"{self._name}: gave no answer within {self._patience:g} s"
            except EOFError:
                self._process.join(5)
                self._failure = f"{self._name}: ended with exit code {self._process.exitcode}"
        return Outcome(failure=self._failure)

    def close(self) -> None:
        """End it, if it does not end by itself."""
        if self._process.pid is not None:
            self._process.join(1)
            if self._process.is_alive():
                self._process.kill()
                self._process.join(5)
        self._answers.close()


def _child(pipe: Connection, played: list[tuple[Job, list[str]]]) -> None:
    try:
        for one, names in played:
            for name in names:
                try:
                    outcome = one.play(name)
                except Exception as error:
                    outcome = Outcome(failure=f"{name}: {type(error).__name__}: {error}")
                pipe.send(outcome)
    except KeyboardInterrupt:
        pass
    finally:
        pipe.close()
