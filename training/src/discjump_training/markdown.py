"""Tables and their cells as Markdown."""

from collections.abc import Iterable, Sequence

from discjump_training.intervals import Estimate


def table(heading: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """A table, one line each.

    >>> print(table(["a", "b"], [["1", "2"]]), end="")
    | a | b |
    | --- | --- |
    | 1 | 2 |
    """
    lines = [heading, ["---"] * len(heading), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def cell(estimate: Estimate, unit: str, digits: int, *, sign: bool = False) -> str:
    """A value with its interval; shares in percent.

    >>> cell(Estimate(0.5, 0.25, 0.75), "%", 1)
    '50.0 [25.0, 75.0]'
    """
    factor = 100.0 if unit == "%" else 1.0
    form = f"{'+' if sign else ''}.{digits}f"
    value, low, high = (
        format(number * factor, form) for number in (estimate.value, estimate.low, estimate.high)
    )
    return f"{value} [{low}, {high}]"
