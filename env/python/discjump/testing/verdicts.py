"""The verdicts on gymnasium's own vector environments and on discjump's: the table of env/docs/testing.md.

python -m discjump.testing.verdicts                             # prints the table
python -m discjump.testing.verdicts --write env/docs/testing.md # and puts it into the page
"""

import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import click
import gymnasium
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import NormalizeObservation, RecordEpisodeStatistics

from discjump.testing.conformance import check_vector_env
from discjump.testing.registry import CHECKS
from discjump.testing.report import Report
from discjump.testing.subject import Env

RULES = "| check | modes | source of the rule | what must hold |\n|---|---|---|---|"
TOY = ("Taxi-v4", "FrozenLake-v1", "CliffWalking-v1", "Blackjack-v1")
CLASSIC = ("CartPole-v1", "Acrobot-v1", "MountainCar-v0", "MountainCarContinuous-v0", "Pendulum-v1")


@dataclass(frozen=True)
class Row:
    """One environment: what makes it in a mode, and in which modes there is one."""

    name: str
    make: Callable[[AutoresetMode, int], Env]
    modes: tuple[AutoresetMode, ...] = tuple(AutoresetMode)
    reference: Callable[[AutoresetMode, int], Env] | None = None
    options: dict[str, Any] = field(default_factory=dict)

    def report(self, mode: AutoresetMode) -> Report:
        """The strict report in this mode."""
        reference = self.reference
        return check_vector_env(
            lambda n: self.make(mode, n),
            reference=None if reference is None else lambda n: reference(mode, n),
            strict=True,
            raise_on_failure=False,
            **self.options,
        )


def rows() -> list[Row]:
    """Every row of the table."""
    found = [Row(f"SyncVectorEnv, {name}", _made(name, "sync")) for name in (*CLASSIC, *TOY)]
    found += [Row("SyncVectorEnv(copy=False), CartPole-v1", _made("CartPole-v1", "sync", copy=False))]
    found += [
        Row(f"AsyncVectorEnv, {name}", _made(name, "async")) for name in ("CartPole-v1", "FrozenLake-v1")
    ]
    found += [
        Row(
            "AsyncVectorEnv(shared_memory=False), CartPole-v1",
            _made("CartPole-v1", "async", shared_memory=False),
        ),
        Row("CartPoleVectorEnv", _cart_pole, (AutoresetMode.NEXT_STEP,)),
        Row(
            "RecordEpisodeStatistics over SyncVectorEnv, CartPole-v1",
            lambda mode, n: RecordEpisodeStatistics(_made("CartPole-v1", "sync")(mode, n)),
            options={"ignore_info": ["episode.t"]},
        ),
        Row(
            "NormalizeObservation over SyncVectorEnv, CartPole-v1",
            lambda mode, n: NormalizeObservation(_made("CartPole-v1", "sync")(mode, n)),
            (AutoresetMode.NEXT_STEP,),
        ),
        Row("discjump's SkiVectorEnv", _ski, reference=_skiers),
    ]
    return found


def cell(report: Report) -> str:
    """What a cell of the table says: how many passed of those made, which failed, which could not be made."""
    made = [outcome for outcome in report if outcome.verdict != "skip"]
    text = f"{len(made) - len(report.failures)} of {len(made)}"
    if report.failures:
        text += f"; fails {', '.join(f'`{outcome.name}`' for outcome in report.failures)}"
    if report.skipped:
        text += f"; skips {len(report.skipped)}"
    return text


def line(row: Row) -> str:
    """A line of the table."""
    cells = [cell(row.report(mode)) if mode in row.modes else "-" for mode in AutoresetMode]
    return f"| {row.name} | {' | '.join(cells)} |"


def table(lines: Iterable[str]) -> str:
    """The table around its lines."""
    head = f"| environment | {' | '.join(mode.name for mode in AutoresetMode)} |"
    return "\n".join([head, "|---|---|---|---|", *lines])


def rules() -> str:
    """The table of checks: name, modes, source, first sentence of the rule."""
    lines = []
    for check in CHECKS.values():
        modes = (
            "all"
            if len(check.modes) == len(AutoresetMode)
            else ", ".join(sorted(m.name for m in check.modes))
        )
        source = f"{check.source}, strict" if check.strict else check.source
        rule = " ".join(check.rule.split("\n\n")[0].split())
        rule = re.sub(r"^[A-Z_, ]+: ", "", rule).replace("|", "\\|")
        lines.append(f"| `{check.name}` | {modes} | {source} | {rule} |")
    return "\n".join(lines)


def placed(page: str, mark: str, text: str) -> str:
    """`page` with `text` between the comments `mark` and `end of mark`."""
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    if begin not in page or end not in page:
        raise ValueError(f"page: expected the comments {begin} and {end}")
    return re.sub(f"{begin}.*{end}", lambda _: f"{begin}\n{text}\n{end}", page, flags=re.DOTALL)


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--write", type=click.Path(path_type=Path, exists=True, dir_okay=False), help="Page to put it into."
)
@click.option("--only", default="", help="Rows whose name contains this text, with every failure in full.")
def main(write: Path | None, only: str) -> None:
    """Check gymnasium's own vector environments and discjump's, and print the table (about two minutes)."""
    lines = []
    for row in rows():
        if only not in row.name:
            continue
        lines.append(line(row))
        click.echo(lines[-1])
        for mode in row.modes if only else ():
            click.echo(f"{row.report(mode)}\n")
    if write is not None:
        if only:
            sys.exit("--write wants the whole table: leave --only out")
        page = placed(write.read_text(encoding="utf-8"), "checks", f"{RULES}\n{rules()}")
        write.write_text(placed(page, "verdicts", table(lines)), encoding="utf-8")


def _made(name: str, vectorization_mode: str, **options: Any) -> Callable[[AutoresetMode, int], Env]:
    def make(mode: AutoresetMode, num_envs: int) -> Env:
        return gymnasium.make_vec(
            name,
            num_envs,
            vectorization_mode=vectorization_mode,
            vector_kwargs={"autoreset_mode": mode, **options},
        )

    return make


def _cart_pole(mode: AutoresetMode, num_envs: int) -> Env:
    return gymnasium.make_vec("CartPole-v1", num_envs, vectorization_mode="vector_entry_point")


def _ski(mode: AutoresetMode, num_envs: int) -> Env:
    return gymnasium.make_vec("discjump/Ski-v0", num_envs, autoreset_mode=mode)


def _skiers(mode: AutoresetMode, num_envs: int) -> Env:
    """As many single environments side by side."""
    one = [lambda: gymnasium.make("discjump/Ski-v0")] * num_envs
    return SyncVectorEnv(one, autoreset_mode=mode)


if __name__ == "__main__":
    main()
