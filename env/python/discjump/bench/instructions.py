"""Instructions of an agent step or player-tick: exact, and the same on a busy machine as on an idle one.

valgrind's callgrind runs the cases one after the other in a process of their own (`counted`), which marks
both ends of every stretch. A case is played twice, for no calls and for some: the difference is the calls.
"""

import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from discjump.bench.clock import Case, Unavailable

CALLS = 16
"""Calls of a case that fixes no number of its own."""
LANES = (1, 8)
"""Players side by side that can be counted, by name: callgrind knows AVX2 and no AVX-512."""
MARKER = "getppid"
"""A function of the C library that Python calls only when it is asked to."""
PARTS = 3
"""Parts of a case: what came before it, no calls, its calls."""


def available() -> bool:
    """Whether valgrind is installed."""
    return shutil.which("valgrind") is not None


def count(
    cases: Sequence[Case],
    *,
    calls: int | None = None,
    progress: Callable[[int], object] | None = None,
) -> list[float]:
    """Instructions per unit (agent step or player-tick) of each case, in their order.

    A few hundred million instructions take a minute, and starting takes some ten seconds: give all cases at
    once. Equal arguments give equal numbers, but for some hundred instructions of Python's.

    Args:
        cases: `ways.Players` or others, on one thread (`threads=1`), with 1 or 8 `lanes`.
        calls: how many calls are counted; None: the case's own number, or 16.
        progress: is called with 1 when a case is done, as `click.progressbar(...).update`.

    Raises:
        Unavailable: valgrind is not installed.
        ValueError: a case has other lanes or several threads.
        RuntimeError: a case failed, with what it said.
    """
    if not available():
        raise Unavailable("valgrind is needed and not installed: apt-get install valgrind")
    for case in cases:
        for name, allowed in (("lanes", LANES), ("threads", (1,))):
            given = getattr(case, name, allowed[0])
            if given not in allowed:
                raise ValueError(f"cases: expected {name} of {' or '.join(map(str, allowed))}, got {given}")
    work = [(case, _calls(case, calls)) for case in cases]
    parts = _run(work, progress or (lambda done: None))
    if len(parts) < PARTS * len(cases):
        raise RuntimeError(
            f"callgrind marked {len(parts)} parts of {len(cases)} cases, {PARTS} each expected"
        )
    return [
        (parts[PARTS * k + 2] - parts[PARTS * k + 1]) / (case.units * many)
        for k, (case, many) in enumerate(work)
    ]


def _calls(case: Case, asked: int | None) -> int:
    return asked or case.calls or CALLS


def _run(work: Sequence[tuple[Case, int]], progress: Callable[[int], object]) -> list[int]:
    """Instructions from each mark to the next."""
    with tempfile.NamedTemporaryFile(prefix="discjump-") as cases:
        pickle.dump(work, cases)
        cases.flush()
        words = [sys.executable, "-m", "discjump.bench.counted", cases.name]
        return marked(words, lambda line: progress(1))


def marked(words: Sequence[str], said: Callable[[str], object]) -> list[int]:
    """Instructions of a command from its beginning to its first call of `getppid`, and from each to the next.

    Args:
        words: the command.
        said: is called with each line that it prints.

    Raises:
        RuntimeError: the command failed, with its errors.
    """
    environment = {**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory(prefix="discjump-") as name:
        directory = Path(name)
        callgrind = ["valgrind", "--tool=callgrind", f"--dump-before={MARKER}"]
        callgrind.append(f"--callgrind-out-file={directory / 'part'}")
        with (directory / "errors").open("w+") as errors:
            with subprocess.Popen(
                [*callgrind, *words],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
            ) as process:
                assert process.stdout is not None, "it is a pipe"
                for line in process.stdout:
                    said(line.rstrip("\n"))
            if process.returncode != 0:
                errors.seek(0)
                raise RuntimeError(f"{' '.join([*callgrind, *words])} failed:\n{errors.read()[-4000:]}")
        return _totals(directory)


def _totals(directory: Path) -> list[int]:
    """The totals of callgrind's numbered files, which end at a mark each."""
    numbered = {int(path.suffix[1:]): path for path in directory.glob("part.*")}
    totals = []
    for number in sorted(numbered):
        found = re.search(r"^totals: (\d+)$", numbered[number].read_text(), re.MULTILINE)
        if found is None:
            raise RuntimeError(f"callgrind wrote no total in part {number}")
        totals.append(int(found[1]))
    return totals
