"""Measures sections, shows progress, and writes what came out: JSON, Markdown and picture."""

import json
from pathlib import Path
from typing import Any

import click

from discjump_training.files import write_atomically
from discjump_training.tradeoff import plot, report
from discjump_training.tradeoff.grid import Plan
from discjump_training.tradeoff.section import Made
from discjump_training.tradeoff.sections import SECTIONS, panels
from discjump_training.tradeoff.store import Missing, Store

NAME = "tradeoff"
"""Of the files."""


def measure(plan: Plan, wanted: tuple[str, ...], store: Store, *, anew: bool = False) -> dict[str, Made]:
    """What was made of each section.

    Args:
        plan: what is measured.
        wanted: sections to measure; of the others what the store has.
        store: finished pieces.
        anew: forget those of the sections wanted.
    """
    made: dict[str, Made] = {}
    for name, section in SECTIONS.items():
        if name in wanted:
            if anew:
                store.forget(name)
            with click.progressbar(length=section.work(plan), label=f"{name:<9}", show_pos=True) as bar:
                made[name] = section.run(plan, store, bar.update)
        else:
            try:
                made[name] = section.run(plan, Store(store.folder, frozen=True), lambda _: None)
            except Missing:
                continue
    return made


def write(record: dict[str, Any], out: Path) -> list[Path]:
    """Write all files, and say which. Without speeds, or without errors, there is no picture."""
    out.mkdir(parents=True, exist_ok=True)
    figures, page, picture = (out / f"{NAME}.{ending}" for ending in ("json", "md", "png"))
    write_atomically(figures, (as_text(record) + "\n").encode())
    write_atomically(page, report.render(record).encode())
    shown = panels(record["sections"])
    if not shown:
        picture.unlink(missing_ok=True)
        return [figures, page]
    plot.draw(shown, picture)
    return [figures, page, picture]


def as_text(value: Any, depth: int = 4, indent: str = "") -> str:
    """JSON with a line for each row: indented down to a depth, deeper values in a line.

    >>> print(as_text({"a": [1, 2], "b": {"c": {"d": [1, 2]}}}, depth=2))
    {
     "a": [
      1,
      2
     ],
     "b": {
      "c": {"d": [1, 2]}
     }
    }
    """
    if depth == 0 or not isinstance(value, dict | list | tuple) or not value:
        return json.dumps(value)
    inner = indent + " "
    if isinstance(value, dict):
        lines = [f"{inner}{json.dumps(key)}: {as_text(one, depth - 1, inner)}" for key, one in value.items()]
        opening, closing = "{", "}"
    else:
        lines = [inner + as_text(one, depth - 1, inner) for one in value]
        opening, closing = "[", "]"
    return opening + "\n" + ",\n".join(lines) + "\n" + indent + closing
