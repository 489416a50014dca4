"""What checks found: outcomes, the report of one environment, the error that lists its failures."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, Literal

Verdict = Literal["pass", "fail", "skip"]

SOURCES = {
    "gymnasium": "gymnasium's documentation of `VectorEnv` or of its autoreset modes",
    "sync": "what gymnasium's `SyncVectorEnv` and `AsyncVectorEnv` do, in whose place one uses one's own",
    "determinism": "what a rollout must not depend on, if it is to be repeated",
    "robustness": "what a caller may do without harm",
}
"""Where a check's rule comes from."""


class ConformanceError(AssertionError):
    """An environment failed checks. `report` holds all outcomes; the message lists the failures."""

    def __init__(self, report: "Report") -> None:
        super().__init__(str(report))
        self.report = report


@dataclass(frozen=True)
class Outcome:
    """Of one check: its name, verdict, the source of its rule (a key of `SOURCES`) and what was seen."""

    name: str
    verdict: Verdict
    source: str
    detail: str

    def __str__(self) -> str:
        return f"{self.verdict}  {self.name} ({self.source}): {self.detail}"


@dataclass(frozen=True)
class Report:
    """Outcomes of all checks of one environment, in their order."""

    environment: str
    autoreset_mode: str
    num_envs: int
    outcomes: tuple[Outcome, ...]

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    @property
    def failures(self) -> tuple[Outcome, ...]:
        """The outcomes that failed."""
        return self._with("fail")

    @property
    def skipped(self) -> tuple[Outcome, ...]:
        """The outcomes of checks that could not be made, each with its reason."""
        return self._with("skip")

    def __iter__(self) -> Iterator[Outcome]:
        return iter(self.outcomes)

    def __getitem__(self, name: str) -> Outcome:
        """The outcome of the check of this name; KeyError if there is none."""
        for outcome in self.outcomes:
            if outcome.name == name:
                return outcome
        raise KeyError(f"no check of name {name!r}; there are {', '.join(o.name for o in self.outcomes)}")

    def raise_on_failure(self) -> None:
        """Raise `ConformanceError` if any check failed."""
        if not self.passed:
            raise ConformanceError(self)

    def to_dict(self) -> dict[str, Any]:
        """The report in types that JSON knows."""
        return {**asdict(self), "outcomes": [asdict(outcome) for outcome in self.outcomes]}

    def __str__(self) -> str:
        """The failures and skips line by line, with the count of what passed."""
        passed = len(self._with("pass"))
        counts = f"{passed} passed, {len(self.failures)} failed, {len(self.skipped)} skipped"
        head = f"{self.environment} (autoreset {self.autoreset_mode}, {self.num_envs} environments): {counts}"
        return "\n".join([head, *(f"  {outcome}" for outcome in (*self.failures, *self.skipped))])

    def _with(self, verdict: Verdict) -> tuple[Outcome, ...]:
        return tuple(outcome for outcome in self.outcomes if outcome.verdict == verdict)
