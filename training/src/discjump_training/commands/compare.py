"""The command `discjump compare`."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.console import Console

from discjump.envs.tasks import TASKS
from discjump_training.commands.evaluate import chosen_course, telling
from discjump_training.errors import TrainingError, clean_errors

if TYPE_CHECKING:
    from discjump_training.judge.judged import Judged


@click.command()
@click.argument("a")
@click.argument("b")
@click.option(
    "--task", type=click.Choice(list(TASKS)), help="What they play.  [default: the course's, or ski]"
)
@click.option("--course", metavar="NAME", help="As for `discjump evaluate`.  [default: held-out]")
@click.option("--episodes", type=click.IntRange(min=1), help="The course's first so many.  [default: all]")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
@click.option("--sampled", is_flag=True, help="Models draw their actions.")
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Write the figures there, as JSON.",
)
def compare(
    a: str,
    b: str,
    task: str | None,
    course: str | None,
    episodes: int | None,
    threads: int | None,
    sampled: bool,
    out: Path | None,
) -> None:
    """Two policies on the same episodes, pair by pair.

    A and B are policies as `discjump evaluate` takes them, groups included, or both are earlier results:
    evaluation.json, or evaluation.json:NAME for another than the first policy in it. Shown are the difference
    and the ratio of the mean times, the probability that A does better in an episode, each with a stratified
    bootstrap interval; Wilcoxon's signed-rank test and (of successes) McNemar's; and the terrains one by one.
    """
    with clean_errors():
        earlier = [_earlier(name) for name in (a, b)]
        if all(one is not None for one in earlier):
            given = {"--task": task, "--course": course, "--episodes": episodes, "--sampled": sampled or None}
            for name, value in given.items():
                if value is not None:
                    raise click.UsageError(
                        f"{name} does not fit with earlier results: they were played already"
                    )
            _show(*_loaded([one for one in earlier if one is not None]), out)
        elif any(one is not None for one in earlier):
            raise TrainingError("expected two policies, or two files of earlier results, got one of each")
        else:
            from discjump_training.judge import BrokenOff, Conditions, entrants, judge

            chosen = chosen_course(task, course)
            count = len(chosen.seeds(episodes))
            conditions = Conditions(chosen, count, threads=threads, sampled=sampled)
            entered = entrants((a, b), chosen, with_baselines=False, sampled=sampled)
            if len(entered) < 2:
                raise TrainingError(f"expected two policies, got {a} twice")
            try:
                judged = judge(entered, conditions, tell=telling(count))
            except BrokenOff:
                click.echo("Broken off: nothing was compared", err=True)
                sys.exit(130)
            names = {i: conditions.terrain_name(i) for i in set(judged[0].terrain.tolist())}
            _show(judged, conditions.task.score, chosen.name, names, out)


def _earlier(name: str) -> tuple[Path, str | None] | None:
    """File and policy, where a name means an earlier result."""
    whole = Path(name)
    if whole.suffix == ".json":
        return whole, None
    file, found, policy = name.partition(".json:")
    return (Path(f"{file}.json"), policy) if found and policy else None


def _loaded(earlier: list[tuple[Path, str | None]]) -> tuple[list["Judged"], str, str, dict[int, str]]:
    from dataclasses import replace

    from discjump_training.judge import results

    (a, first), (b, second) = (results.load(*one) for one in earlier)
    for key in ("task", "course", "course_digest"):
        if first.get(key) != second.get(key):
            raise TrainingError(
                f"{earlier[0][0]} and {earlier[1][0]} cannot be compared: their {key} is {first.get(key)} "
                f"and {second.get(key)}"
            )
    if a.name == b.name:
        a, b = (
            replace(one, name=f"{file}:{one.name}") for one, (file, _) in zip((a, b), earlier, strict=True)
        )
    for one, data in ((a, first), (b, second)):
        if data["changes"]:
            click.echo(f"{one.name} played with {data['changes']}", err=True)
        if data["partial"]:
            click.echo(
                f"{one.name}: its evaluation is partial, {len(one.episodes)} episodes were played", err=True
            )
    seeds = first["changes"].get("terrain_seeds", first["terrain_seeds"])
    return [a, b], first["score"], first["course"], {i: str(seed) for i, seed in enumerate(seeds)}


def _show(
    judged: list["Judged"], score: Any, course: str, terrains: dict[int, str], out: Path | None
) -> None:
    from dataclasses import asdict

    from discjump_training.files import write_atomically
    from discjump_training.judge import tables
    from discjump_training.judge.compare import compare as compared

    found = compared(judged[0], judged[1], score)
    if out is not None:
        data = {
            "schema_version": 1,
            "course": course,
            **asdict(found),
            "by_terrain": {
                terrains.get(index, str(index)): apart for index, apart in found.by_terrain.items()
            },
        }
        out.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(out, (json.dumps(data, indent=1) + "\n").encode())
    console = Console(width=None if sys.stdout.isatty() else 160)
    console.print(tables.comparisons([found]).rich())
    by_terrain = [
        [terrains.get(index, str(index)), f"{apart:+.2f}"]
        for index, apart in sorted(found.by_terrain.items())
    ]
    console.print(tables.Table("", ["terrain", "time difference, s"], by_terrain, words=1).rich())
    better = found.difference if score == "seconds" else found.success
    sure = better.low > 0 or better.high < 0
    ahead = (better.value < 0) == (score == "seconds")
    verdict = (
        f"{found.policy} does {'better' if ahead else 'worse'} than {found.against}"
        if sure
        else f"no difference between {found.policy} and {found.against} can be told"
    )
    click.echo(f"{course}, {found.episodes} episodes: {verdict} (95% interval of the difference).")
    if out is not None:
        click.echo(f"Figures: {out}")
