"""The list of checks, in the order in which they run."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from gymnasium.vector import AutoresetMode

from discjump.testing.subject import Subject

Run = Callable[[Subject], str]
Source = Literal["gymnasium", "sync", "determinism", "robustness"]

ALL_MODES = frozenset(AutoresetMode)


@dataclass(frozen=True)
class Check:
    """One rule: `run` returns what it saw, or raises `Broken` or `Untested`.

    `source` says where the rule comes from (`report.SOURCES`). A check is skipped if one of `needs` failed
    (of `when_disabled` too, where episodes go on by reset masks), or if the autoreset mode is not among
    `modes`.
    """

    name: str
    run: Run
    source: Source
    needs: tuple[str, ...]
    when_disabled: tuple[str, ...]
    modes: frozenset[AutoresetMode]
    strict: bool

    @property
    def rule(self) -> str:
        """The rule in words."""
        return (self.run.__doc__ or "").strip()


CHECKS: dict[str, Check] = {}
"""All checks by name."""


def check(
    source: Source,
    *,
    needs: Sequence[str] = (),
    when_disabled: Sequence[str] = (),
    modes: frozenset[AutoresetMode] = ALL_MODES,
    strict: bool = False,
) -> Callable[[Run], Run]:
    """Register a function as the check of its name."""

    def register(run: Run) -> Run:
        name = run.__name__
        CHECKS[name] = Check(name, run, source, tuple(needs), tuple(when_disabled), modes, strict)
        return run

    return register
