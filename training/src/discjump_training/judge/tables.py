"""An evaluation as tables: for the terminal, as Markdown, and for the page."""

from dataclasses import dataclass

from rich.console import Console
from rich.table import Table as RichTable

from discjump_training.courses import row
from discjump_training.judge.compare import Comparison
from discjump_training.judge.evaluation import ENOUGH_EPISODES, Evaluation
from discjump_training.judge.failures import CAUSES, MEANING, counted
from discjump_training.markdown import cell, table


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        title: what it shows.
        heading: of its columns.
        rows: their cells.
        words: columns of words, from the left; the others hold numbers.
    """

    title: str
    heading: list[str]
    rows: list[list[str]]
    words: int = 2

    def markdown(self) -> str:
        """As Markdown, without the title."""
        return table(self.heading, self.rows)

    def rich(self) -> RichTable:
        """For the terminal."""
        table = RichTable()
        for index, title in enumerate(self.heading):
            table.add_column(title, justify="left" if index < self.words else "right", overflow="fold")
        for cells in self.rows:
            table.add_row(*cells)
        return table


def policies(made: Evaluation) -> Table:
    """A row per policy."""
    heading = ["policy", "actions"]
    heading += [f"{one.title}, {one.unit}" if one.unit else one.title for one in made.columns]
    heading += ["of the planner's, %"] if made.percent else []
    heading += ["of the reachable, %"] if made.reachable else []
    heading += ["episodes"] if made.partial else []
    rows = []
    for index, one in enumerate(made.judged):
        cells = [one.name, one.actions]
        cells += [cell(made.figures[index][of.key], of.unit, of.digits) for of in made.columns]
        if made.percent:
            percent = made.percent[index]
            cells.append("" if percent is None else f"{cell(percent[0], '', 1)}, {percent[1]} episodes")
        if made.reachable:
            reached = made.reachable[index]
            cells.append("" if reached is None else f"{cell(reached[0], '%', 1)}, {reached[1]} episodes")
        cells += [f"{len(one.episodes)} of {made.conditions.episodes}"] if made.partial else []
        rows.append(cells)
    return Table("Policies", heading, rows)


def comparisons(compared: list[Comparison]) -> Table:
    """A row per pair."""
    heading = ["policy", "against", "time difference, s", "time ratio", "success difference, %"]
    heading += ["probability of improvement, %", "p: rank, success", "faster in", "faster on terrains"]
    return Table(
        "Pair by pair",
        heading,
        [
            [
                one.policy,
                one.against,
                cell(one.difference, "s", 2, sign=True),
                cell(one.ratio, "", 3),
                cell(one.success, "%", 1, sign=True),
                cell(one.improvement, "%", 1),
                ", ".join(f"{test.p:.2g}" for test in one.tests),
                f"{one.faster_share:.0%}",
                f"{one.faster_terrains} of {one.terrains}",
            ]
            for one in compared
        ],
    )


def causes(made: Evaluation) -> Table:
    """Failures of each policy, by cause."""
    rows = []
    for one, found in zip(made.judged, made.failures, strict=True):
        played = len(one.members) * len(one.episodes)
        rows.append([one.name, str(played), *(str(count) for count in counted(found).values())])
    return Table("Failures", ["policy", "episodes", *CAUSES], rows, words=1)


def bands(made: Evaluation) -> Table | None:
    """Scores by difficulty, where the task has one: a row per policy, a column per band."""
    band = row(made.conditions.task.name).band
    if band is None or not made.bands:
        return None
    seconds = made.conditions.task.score == "seconds"
    known = sorted({(one.low, one.high) for one in made.bands})
    cells = {
        (one.policy, one.low): cell(one.seconds, "s", 2) if seconds else cell(one.success, "%", 1)
        for one in made.bands
    }
    what = f"time to {made.conditions.task.goal}, s" if seconds else "success, %"
    return Table(
        f"{what} by {band.title}",
        ["policy", *(f"{low:g} to {high:g}" for low, high in known)],
        [[one.name, *(cells.get((one.name, low), "") for low, _ in known)] for one in made.judged],
        words=1,
    )


def caption(made: Evaluation) -> str:
    """What the figures mean."""
    conditions = made.conditions
    course, count = conditions.course, conditions.episodes
    usual = conditions.task.options.frame_skip
    changes = "".join(f", {name}={value}" for name, value in conditions.told().items())
    words = [
        f"{course.name}: {count} fixed episodes, the same for every policy (start distance, terrain and "
        f"{conditions.task.goal} are equal bit for bit), fidelity {conditions.environment({})['fidelity']}"
        f"{changes}, frame_skip {usual} unless another is named, in brackets 95% intervals. "
        f"Time-outs and deaths count as {conditions.time_limit:g} s."
    ]
    if made.search is not None:
        within = made.search.reached[:count]
        words.append(
            f"Reachable: the {within.sum()} of the course's first {len(within)} episodes in which an "
            "exhaustive search of open-loop schedules reaches the goal."
        )
    if made.partial:
        words.append("PARTIAL: it was broken off before every policy had played every episode.")
    if count < ENOUGH_EPISODES:
        words.append(f"Fewer than {ENOUGH_EPISODES} episodes: too few to publish.")
    return " ".join(words)


def markdown(made: Evaluation) -> str:
    """All tables and the caption as Markdown."""
    parts = ["**Partial.**\n"] if made.partial else []
    parts.append(policies(made).markdown())
    if made.comparisons:
        parts.append(comparisons(made.comparisons).markdown())
    parts += [causes(made).markdown(), f"{MEANING}\n"]
    if (split := bands(made)) is not None:
        parts += [f"{split.title[0].upper()}{split.title[1:]}:\n", split.markdown()]
    return "\n".join([*parts, caption(made), ""])


def show(console: Console, made: Evaluation) -> None:
    """Print the tables of policies, pairs and causes, and the caption."""
    console.print(policies(made).rich())
    if made.comparisons:
        console.print(comparisons(made.comparisons).rich())
    if any(made.failures):
        console.print(causes(made).rich())
    console.print(caption(made))
