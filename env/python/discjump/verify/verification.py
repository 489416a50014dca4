"""The whole matrix: every subject, then every process."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack

import numpy as np

from discjump._results import versions
from discjump.simulator import FIDELITIES, SCENES
from discjump.verify import children, environments, matrix, scenes
from discjump.verify.certificate import Certificate, Digests, RowResult
from discjump.verify.form import FULL, QUICK, Form
from discjump.verify.interface import Subject
from discjump.verify.machine import described
from discjump.verify.reference import record

PACKAGES = ("discjump", "numpy", "gymnasium", "stable-baselines3")

Done = Callable[[str], None]
"""Told after each row what is being played."""


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

    >>> certificate = verify(["discjump/Ski-v0"], ["fast"], [], quick=True, processes=[])
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
    tables = [table(subject, form) for subject in chosen]
    digests: dict[str, dict[str, Digests]] = {}
    for one in tables:
        digests.setdefault(one.subject.name, {})[one.subject.tier] = _digests(one)
    jobs = [children.job(one) for one in tables] if processes else []
    results: list[RowResult] = []
    with ExitStack() as stack:
        # They play beside this process: most of their time is their start.
        families = [children.Child(method, jobs, method == processes[-1]) for method in processes]
        for child in families:
            stack.callback(child.close)
            child.start()
        for one in tables:
            results += played(one, bool(processes))
            done(f"{one.subject.name}, {one.subject.tier}")
        for method, child in zip(processes, families, strict=True):
            for one in tables:
                clock = time.perf_counter()
                for name, outcome in child.next().items():
                    results.append(_result(one.subject, name, outcome, time.perf_counter() - clock))
                done(f"process {method}: {one.subject.name}, {one.subject.tier}")
    return Certificate(
        form.name,
        command,
        versions(*PACKAGES),
        described(),
        digests,
        results,
        round(time.perf_counter() - began, 2),
    )


def table(subject: Subject, form: Form) -> matrix.Table:
    """The reference of a subject, and what is played beside it."""
    count = form.environments if subject.steps is None else form.scene_worlds
    return matrix.Table(subject, record(subject, np.arange(count)), form)


def played(one: matrix.Table, apart: bool) -> list[RowResult]:
    """The rows of a subject in this process."""
    results = []
    for name, row in matrix.rows(one, apart):
        clock = time.perf_counter()
        outcome = row()
        results.append(_result(one.subject, name, outcome, time.perf_counter() - clock))
    return results


def _digests(one: matrix.Table) -> Digests:
    reference = one.reference
    return Digests(
        reference.digest(),
        reference.actions_digest(),
        len(reference.seeds),
        reference.length,
        dict(reference.ends),
        one.widths,
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
