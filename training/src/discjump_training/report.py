"""An evaluation as tables: for the terminal and as Markdown."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from discjump_training.courses import Course
from discjump_training.evaluate import FIDELITY, FIGURES, FRAME_SKIP, Comparison, Judged
from discjump_training.intervals import Estimate

#: Fewer episodes than this are too few to publish.
ENOUGH_EPISODES = 200


def rows(judged: list[Judged]) -> tuple[list[str], list[list[str]]]:
    """Heading and rows of the table of policies."""
    heading = ["policy", "actions", *(f"{title}, {unit}" if unit else title for _, title, unit, _ in FIGURES)]
    return heading, [
        [
            one.name,
            one.actions,
            *(_with_interval(one.figures[key], unit, digits) for key, _, unit, digits in FIGURES),
        ]
        for one in judged
    ]


def comparison_rows(compared: list[Comparison]) -> tuple[list[str], list[list[str]]]:
    """Heading and rows of the table of comparisons."""
    heading = ["policy", "against", "time difference, s", "time ratio", "faster in", "faster on terrains"]
    return heading, [
        [
            one.policy,
            one.against,
            _with_interval(one.difference, "s", 2, sign=True),
            _with_interval(one.ratio, "", 3),
            f"{one.faster_share:.0%}",
            f"{one.faster_terrains} of {one.terrains}",
        ]
        for one in compared
    ]


def caption(course: Course, episodes: int) -> str:
    """What the figures mean."""
    few = (
        "" if episodes >= ENOUGH_EPISODES else f" Fewer than {ENOUGH_EPISODES} episodes: too few to publish."
    )
    return (
        f"{course.name}: {episodes} fixed episodes, the same for every policy (start distance, terrain and "
        f"beacon are equal bit for bit), fidelity {FIDELITY}, frame_skip {FRAME_SKIP} unless another is "
        "named, in brackets 95% intervals. "
        f"Time-outs and deaths count as 60 s.{few}"
    )


def markdown(course: Course, episodes: int, judged: list[Judged], compared: list[Comparison]) -> str:
    """Both tables and the caption as Markdown."""
    parts = [_markdown_table(*rows(judged))]
    if compared:
        parts.append(_markdown_table(*comparison_rows(compared)))
    return "\n".join([*parts, caption(course, episodes), ""])


def show(
    console: Console, course: Course, episodes: int, judged: list[Judged], compared: list[Comparison]
) -> None:
    """Print both tables and the caption."""
    console.print(_rich_table(*rows(judged)))
    if compared:
        console.print(_rich_table(*comparison_rows(compared)))
    console.print(caption(course, episodes))


def _with_interval(estimate: Estimate, unit: str, digits: int, *, sign: bool = False) -> str:
    factor = 100.0 if unit == "%" else 1.0
    form = f"{'+' if sign else ''}.{digits}f"
    value, low, high = (
        format(number * factor, form) for number in (estimate.value, estimate.low, estimate.high)
    )
    return f"{value} [{low}, {high}]"


def _rich_table(heading: Sequence[str], body: Sequence[Sequence[str]]) -> Table:
    table = Table()
    for index, title in enumerate(heading):
        table.add_column(title, justify="left" if index < 2 else "right", overflow="fold")
    for row in body:
        table.add_row(*row)
    return table


def _markdown_table(heading: Sequence[str], body: Sequence[Sequence[str]]) -> str:
    lines = [heading, ["---"] * len(heading), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
