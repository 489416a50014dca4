"""The whole matrix: every subject, then every process."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np

from discjump._results import versions
from discjump.simulator import FIDELITIES, SCENES
from discjump.verify import children, environments, matrix, scenes
from discjump.verify.certificate import Certificate, Digests, RowResult
from discjump.verify.form import FULL, QUICK, Form
from discjump.verify.interface import Subject
from discjump.verify.machine import described
from discjump.verify.reference import Reference, record

PACKAGES = ("discjump", "numpy", "gymnasium", "stable-baselines3")

Done = Callable[[str], None]
"""Told after each row what is being played."""


@dataclass(frozen=True)
class Played:
    """What one subject gave."""

    table: matrix.Table
    digests: Digests
    results: list[RowResult]


def verify(
    ids: Sequence[str] | None = None,
    tiers: Sequence[str] = FIDELITIES,
    scene_names: Sequence[str] | None = None,
    *,
    quick: bool = False,
    processes: Sequence[str] = children.METHODS,
    command: str = "discjump.verify.verify",
    done: Done = lambda label: None,
) -> Certificate:
    """Play the matrix.

    Args:
        ids: environment ids; None: all that are registered.
        tiers: fidelity tiers.
        scene_names: scenes of `Simulator`; None: all.
        quick: the quick form.
        processes: start methods of child processes that play as well.
        command: what the certificate says was called.
        done: told after each row.

    Raises:
        ValueError: an unknown id, tier, scene or start method.

    >>> certificate = verify(tiers=["fast"], scene_names=[], quick=True, processes=[])
    >>> [row.row for row in certificate.failed], len(certificate.digests["discjump/Ski-v0"]["fast"].digest)
    ([], 64)
    """
    chosen = subjects(ids, tiers, scene_names)
    for method in processes:
        _known("processes", method, children.METHODS)
    return verified(chosen, QUICK if quick else FULL, processes, command, done)


def subjects(
    ids: Sequence[str] | None, tiers: Sequence[str], scene_names: Sequence[str] | None
) -> list[Subject]:
    """Ids and scenes in tiers."""
    names = environments.ids() if ids is None else list(ids)
    places = list(SCENES) if scene_names is None else list(scene_names)
    for argument, given, known in (
        ("ids", names, environments.ids()),
        ("tiers", tiers, FIDELITIES),
        ("scene_names", places, SCENES),
    ):
        for name in given:
            _known(argument, name, list(known))
    return [*environments.subjects(names, tiers), *scenes.subjects(places, tiers)]


def work(chosen: Sequence[Subject], processes: Sequence[str]) -> int:
    """How often `done` is told: once per subject and once per subject and process."""
    return len(chosen) * (1 + len(processes))


def verified(
    chosen: Sequence[Subject],
    form: Form,
    processes: Sequence[str] = children.METHODS,
    command: str = "discjump.verify.verified",
    done: Done = lambda label: None,
) -> Certificate:
    """Play the matrix of these subjects; doubles of our environments can be among them."""
    began = time.perf_counter()
    digests: dict[str, dict[str, Digests]] = {}
    results: list[RowResult] = []
    jobs = []
    for subject in chosen:
        played = play(subject, form)
        digests.setdefault(subject.name, {})[subject.tier] = played.digests
        results += played.results
        if processes:
            jobs.append(children.job(played.table))
        done(f"{subject.name}, {subject.tier}")
    # All at once: most of a child's time is its start.
    with ExitStack() as stack:
        families = [(method, children.Child(method, jobs)) for method in processes]
        for _, outcomes in families:
            stack.callback(outcomes.close)
            outcomes.start()
        for method, outcomes in families:
            for subject in chosen:
                clock = time.perf_counter()
                outcome = outcomes.next()
                results.append(_result(subject, f"process {method}", outcome, time.perf_counter() - clock))
                done(f"process {method}: {subject.name}, {subject.tier}")
    return Certificate(
        form.name,
        command,
        versions(*PACKAGES),
        described(),
        digests,
        results,
        round(time.perf_counter() - began, 2),
    )


def play(subject: Subject, form: Form) -> Played:
    """The reference of a subject, and its rows in this process."""
    count = form.environments if subject.steps is None else form.scene_worlds
    reference = record(subject, np.arange(count))
    table = matrix.Table(subject, reference, form)
    results = []
    for name, row in matrix.rows(table):
        clock = time.perf_counter()
        outcome = row()
        results.append(_result(subject, name, outcome, time.perf_counter() - clock))
    return Played(table, _digests(reference, table.widths), results)


def _digests(reference: Reference, widths: list[int]) -> Digests:
    return Digests(
        reference.digest(),
        reference.actions_digest(),
        len(reference.seeds),
        reference.length,
        dict(reference.ends),
        widths,
    )


def _result(subject: Subject, row: str, outcome: matrix.Outcome, seconds: float) -> RowResult:
    difference = outcome.difference
    reason = outcome.failure or outcome.skipped or ("" if difference is None else str(difference))
    result = "skipped" if outcome.skipped else "fail" if reason else "pass"
    return RowResult(
        subject.name,
        subject.tier,
        row,
        result,
        outcome.compared,
        round(seconds, 3),
        reason,
        None if difference is None else difference.record(),
    )


def _known(argument: str, name: str, known: Sequence[str]) -> None:
    if name not in known:
        raise ValueError(f"{argument}: expected some of {', '.join(known)}, got {name!r}")
