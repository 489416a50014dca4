"""Test items for `pytest --discjump-verify`: one for each check of each declared environment.

`discjump_pytest`, which pytest loads at its start, registers this only if it is asked for.
"""

from collections.abc import Iterator
from typing import Any

import pytest

from discjump.testing import declared
from discjump.testing.conformance import Conformance
from discjump.testing.registry import CHECKS
from discjump.testing.report import SOURCES, Outcome


class Failed(Exception):
    """A check failed; carries its outcome."""

    def __init__(self, outcome: Outcome) -> None:
        super().__init__(outcome.detail)
        self.outcome = outcome


class Verification:
    """Adds the items to what was collected."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(
        self, session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
    ) -> None:
        """Before others deselect by name or marker."""
        for environment in declared.of(config).values():
            node = EnvironmentNode.from_parent(
                session, name=environment.name, nodeid=f"discjump::{environment.name}", declared=environment
            )
            collected: list[pytest.Item | pytest.Collector] = list(node.collect())
            # Reporters count what is collected by these reports.
            report = pytest.CollectReport(node.nodeid, "passed", None, collected)
            config.hook.pytest_collectreport(report=report)
            items.extend(item for item in collected if isinstance(item, pytest.Item))


class EnvironmentNode(pytest.Collector):
    """A declared environment: makes it when its first item runs, closes it after the last."""

    def __init__(self, *, declared: declared.Declared, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.declared = declared
        self._conformance: Conformance | None = None
        self._error: Exception | None = None

    def collect(self) -> Iterator["CheckItem"]:
        """An item for each check; those of another autoreset mode will be skipped."""
        options = self.options
        for name, check in CHECKS.items():
            if name != "equals_reference" and (options.get("strict") or not check.strict):
                yield CheckItem.from_parent(self, name=name)

    @property
    def options(self) -> dict[str, Any]:
        """Settings of the project, and over them those of this environment."""
        return {**declared.settings(self.config), **self.declared.settings}

    @property
    def conformance(self) -> Conformance:
        """The checks; what making the environment raises meets the first item, the others are skipped."""
        if self._error is not None:
            pytest.skip(f"the environment could not be made: {type(self._error).__name__}")
        if self._conformance is None:
            try:
                self._conformance = Conformance(self.declared.factory(), **self.options)
            except Exception as error:
                self._error = error
                raise
        return self._conformance

    def teardown(self) -> None:
        """Close what was made."""
        if self._conformance is not None:
            self._conformance.close()
            self._conformance = None


class CheckItem(pytest.Item):
    """One check of one environment."""

    parent: EnvironmentNode

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.add_marker("discjump")

    def setup(self) -> None:
        """Make the environment if this is its first item: what that raises is an error, no failure."""
        self.parent.conformance  # noqa: B018

    def runtest(self) -> None:
        """Make the check."""
        outcome = self.parent.conformance.outcome(self.name)
        if outcome.verdict == "skip":
            pytest.skip(outcome.detail)
        if outcome.verdict == "fail":
            raise Failed(outcome)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """What was seen, the rule, and where it comes from, instead of a trace through the checks."""
        if not isinstance(excinfo.value, Failed):
            return super().repr_failure(excinfo, style)
        outcome = excinfo.value.outcome
        rule = "\n".join(line.strip() for line in CHECKS[outcome.name].rule.splitlines())
        return f"{outcome.detail}\n\nThe rule ({SOURCES[outcome.source]}):\n{rule}"

    def reportinfo(self) -> tuple[str, int | None, str]:
        """How pytest names the item."""
        return "discjump", None, f"{self.parent.name}: {self.name}"
