"""A figure: how it comes from which cases, what is asked of it, and its line in the table."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discjump.bench.clock import Case, Floats, Timed, Times, Unavailable, spread


@dataclass(frozen=True)
class Figure:
    """A line of the table."""

    what: str
    unit: str
    cases: tuple[Case, ...]
    value: Callable[..., Floats]
    """From what was `Timed` of each case to (repeats,) numbers in `unit`."""
    asked: float | None = None
    at_least: bool = True

    def met(self, value: float) -> bool | None:
        """Whether a value is what was asked for; None: nothing was.

        >>> Figure("reset", "us", (), lambda: np.zeros(1), 2.0, at_least=False).met(2.5)
        False
        """
        if self.asked is None:
            return None
        return value >= self.asked if self.at_least else value <= self.asked


def rate(what: str, case: Case, asked: float | None = None) -> Figure:
    """Millions of agent steps or player-ticks a second."""
    return Figure(what, "M/s", (case,), lambda timed: timed.rate / 1e6, asked)


def ratio(what: str, pair: tuple[Case, Case], asked: float, *, at_least: bool) -> Figure:
    """How many times as long a unit of the first takes as one of the second."""
    return Figure(what, "times", pair, lambda over, under: under.rate / over.rate, asked, at_least)


def call(what: str, case: Case, asked: float | None = None) -> Figure:
    """Microseconds of a call."""
    return Figure(what, "us", (case,), lambda timed: timed.seconds * 1e6, asked, at_least=False)


def beside(what: str, whole: Case, part: Case, *, per_unit: bool, asked: float | None = None) -> Figure:
    """Microseconds that a call of `whole` takes longer than one of `part`; or that one of its units does."""

    def difference(a: Timed, b: Timed) -> Floats:
        return (a.seconds - b.seconds) * 1e6 / (a.units if per_unit else 1)

    return Figure(what, "us", (whole, part), difference, asked, at_least=False)


def known(what: str, value: float, asked: float | None = None) -> Figure:
    """Bytes, which nothing need be timed for."""
    return Figure(what, "bytes", (), lambda: np.array([value]), asked, at_least=False)


def row(figure: Figure, times: Times) -> dict[str, Any]:
    """What was reached of a figure."""
    head = {"what": figure.what, "unit": figure.unit, "asked": figure.asked, "at_least": figure.at_least}
    given = [times[case] for case in figure.cases]
    missing = [str(one) for one in given if isinstance(one, Unavailable)]
    if missing:
        return {**head, "missing": missing[0]}
    values = figure.value(*given)
    middle = spread(values)
    return {
        **head,
        **middle._asdict(),
        "met": figure.met(middle.median),
        "cases": [repr(case) for case in figure.cases],
        "lanes": [one.lanes for one in given if isinstance(one, Timed)],
        "values": values.tolist(),
    }


def table(rows: Sequence[dict[str, Any]]) -> str:
    """The figures as Markdown.

    >>> reached = {"median": 17.25, "low": 17.0, "high": 17.5, "met": False}
    >>> print(table([{"what": "steps", "unit": "M/s", "asked": 18, "at_least": True, **reached}]))
    | what | asked | reached (quartiles) | met? |
    |---|---|---|---|
    | steps | >= 18 M/s | 17.2 (17.0 .. 17.5) M/s | **no** |
    """
    lines = ["| what | asked | reached (quartiles) | met? |", "|---|---|---|---|"]
    for one in rows:
        sign = ">=" if one["at_least"] else "<="
        asked = "" if one["asked"] is None else f"{sign} {one['asked']:g} {one['unit']}"
        if "missing" in one:
            lines.append(f"| {one['what']} | {asked} | {one['missing']} | |")
            continue
        low, median, high = (short(one[name]) for name in ("low", "median", "high"))
        around = "" if low == high else f" ({low} .. {high})"
        met = {None: "", True: "yes", False: "**no**"}[one["met"]]
        lines.append(f"| {one['what']} | {asked} | {median}{around} {one['unit']} | {met} |")
    return "\n".join(lines)


def short(value: float) -> str:
    """Three digits, or all before the point.

    >>> [short(x) for x in (0.01234, 1.0, 12.34, 76.0, 1234.5)]
    ['0.0123', '1.00', '12.3', '76.0', '1,234']
    """
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:#.3g}"
