"""The rows of other processes: forked, spawned and from a fork server, whole episodes and snapshots."""

import multiprocessing
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.verify.matrix import Outcome, Table, done
from discjump.verify.run import Run

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

    def play(self, method: str) -> Outcome:
        """Play it here."""
        table, widest, where = self.table, self.table.widths[-1], f"process {method}"
        runs = []
        if table.form.processes:
            runs.append(table.run(table.crowd(64), where, 2, widest).start().advance())
        runs.append(
            table.run(table.crowd(POOLED), f"{where}, {POOLED}", 2, widest).start().advance(DECISIONS)
        )
        batch = table.subject.batch(len(self.environments), threads=2, lanes=table.widths[0], mode=table.mode)
        batch.restore(self.snapshot)
        after = Run(
            table.subject,
            table.reference,
            batch,
            self.environments,
            f"{where}, from its parent's snapshot",
            self.rows,
        )
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
        patience: time without an answer after which it is given up, s.
    """

    def __init__(self, method: str, jobs: list[Job], patience: float = PATIENCE) -> None:
        context: Any = multiprocessing.get_context(method)
        self._answers, self._theirs = context.Pipe(duplex=False)
        self._process = context.Process(target=_child, args=(self._theirs, method, jobs), daemon=True)
        self._name, self._patience = f"process {method}", patience
        self._failure = ""

    def start(self) -> None:
        """Start it."""
        self._process.start()
        self._theirs.close()

    def next(self) -> Outcome:
        """What became of the next job."""
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


def _child(pipe: Connection, method: str, jobs: list[Job]) -> None:
    try:
        for one in jobs:
            try:
                outcome = one.play(method)
            except Exception as error:
                outcome = Outcome(failure=f"process {method}: {type(error).__name__}: {error}")
            pipe.send(outcome)
    except KeyboardInterrupt:
        pass
    finally:
        pipe.close()
