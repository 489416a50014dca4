"""The commands `discjump train` and `discjump evaluate`."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import click
from rich.console import Console

from discjump.envs.tasks import TASKS
from discjump_training.courses import COURSES, HELD_OUT, MAX_RUN_SEED
from discjump_training.errors import RecipeError, TrainingError
from discjump_training.recipe import Recipe

#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130
#: What `--smoke` changes in a recipe: the whole job in half a minute.
SMOKE = (
    "ppo.steps=262_144",
    "watch.evaluate_every=131_072",
    "watch.evaluate_episodes=32",
    "watch.checkpoint_every=131_072",
)
#: Episodes that `--smoke --evaluate` judges on.
SMOKE_EPISODES = 32
#: Learning curve of a run.
CURVE = "curve.csv"


@click.command()
@click.argument("task", type=click.Choice(list(TASKS)))
@click.option("--recipe", "source", help="TOML file, or a recipe by name.  [default: the task's]")
@click.option(
    "--set", "overrides", multiple=True, metavar="FIELD=VALUE", help="Change a field of the recipe."
)
@click.option("--seed", type=click.IntRange(0, MAX_RUN_SEED), help="Of the run.  [default: 0]")
@click.option("--steps", type=click.IntRange(min=1), help="Decisions in all, in place of the recipe's.")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator, in place of the recipe's.")
@click.option(
    "--out", type=click.Path(path_type=Path), help="Folder of the run.  [default: runs/TASK-DATE-TIME]"
)
@click.option(
    "--resume", type=click.Path(path_type=Path), metavar="FOLDER", help="Go on with the run in FOLDER."
)
@click.option("--smoke", is_flag=True, help="Half a minute instead of ten: only to see that all works.")
@click.option(
    "--evaluate", "judge", is_flag=True, help="Judge the best model afterwards (discjump evaluate)."
)
@click.option("--quiet", is_flag=True, help="No progress bar.")
@click.option("--show-recipe", is_flag=True, help="Print the recipe, every field explained, and do nothing.")
def train(
    task: str,
    source: str | None,
    overrides: tuple[str, ...],
    seed: int | None,
    steps: int | None,
    threads: int | None,
    out: Path | None,
    resume: Path | None,
    smoke: bool,
    judge: bool,
    quiet: bool,
    show_recipe: bool,
) -> None:
    """Train an agent for TASK with PPO.

    Ctrl-C stops after the update under way and says how to go on. One step is one decision of one
    environment.
    """
    with clean_errors():
        changes = [*overrides, *(SMOKE if smoke else ())]
        changes += [f"ppo.steps={steps}"] if steps else []
        changes += [f"rollout.threads={threads}"] if threads else []
        if resume is not None:
            _refuse_with_resume(
                {
                    "--recipe": source is not None,
                    "--set": bool(overrides),
                    "--out": out is not None,
                    "--seed": seed is not None,
                    "--smoke": smoke,
                }
            )
        recipe = Recipe.load(resume / "recipe.toml" if resume else source or task, tuple(changes))
        if recipe.task != task:
            raise RecipeError(f"{resume or source} is a recipe for the task {recipe.task}, not for {task}")
        if show_recipe:
            click.echo(recipe.to_toml(help=True), nl=False)
            return
        folder = resume or out or Path("runs") / f"{task}-{datetime.now():%Y%m%d-%H%M%S}"
        _train(recipe, seed or 0, folder, resume=resume is not None, quiet=quiet)
        if judge:
            held_out = COURSES[f"{task}-held-out-v1"]
            _evaluate((str(folder),), held_out.name, SMOKE_EPISODES if smoke else held_out.episodes)


def _train(recipe: Recipe, seed: int, folder: Path, *, resume: bool, quiet: bool) -> None:
    # Imported late: torch takes seconds, and --help should not.
    from discjump_training.runs import checkpoints
    from discjump_training.train import train as run

    try:
        result = run(recipe, seed, folder, resume=resume, quiet=quiet)
    except KeyboardInterrupt:
        click.echo(
            f"Stopped at once. Go on from the last checkpoint: discjump train {recipe.task} --resume {folder}"
            if checkpoints(folder)
            else f"Stopped at once, before the first checkpoint: a run in {folder} begins anew.",
            err=True,
        )
        sys.exit(INTERRUPTED)
    clock = result.progress.clock
    if not result.finished:
        click.echo(
            f"Stopped at {result.steps:,} of {recipe.ppo.steps:,} decisions, everything is saved.\n"
            f"Go on with: discjump train {recipe.task} --resume {folder}",
            err=True,
        )
        sys.exit(INTERRUPTED)
    best = result.progress.best
    assert best is not None
    click.echo(
        f"{result.steps:,} decisions in {clock.training:.0f} s of training "
        f"({result.steps / clock.training:,.0f} a second;"
        f" environment {clock.share('environment'):.0%}, policy {clock.share('policy'):.0%}, "
        f"update {clock.share('update'):.0%}) and {clock.evaluation:.0f} s of evaluation.\n"
        f"Best model: {folder / 'best.zip'}, {best.validation_success:.1%} succeed, "
        f"{best.validation_seconds:.2f} s on {recipe.watch.evaluate_course}."
    )


def _refuse_with_resume(given: dict[str, bool]) -> None:
    for name, is_given in given.items():
        if is_given:
            raise click.UsageError(
                f"--resume goes on with the run in its folder: {name} does not fit with it"
            )


@click.command()
@click.argument("policies", nargs=-1, required=True, metavar="POLICY...")
@click.option("--course", default=HELD_OUT.name, show_default=True, type=click.Choice(list(COURSES)))
@click.option("--episodes", type=click.IntRange(min=1), help="The course's first so many.  [default: all]")
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the results.")
@click.option(
    "--sampled", is_flag=True, help="Models draw their actions instead of taking the likeliest (greedy)."
)
@click.option("--baselines/--no-baselines", default=True, show_default=True, help="Judge all baselines too.")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
@click.option(
    "--replays",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="FOLDER",
    help="Save a replay of every episode there: COURSE-EPISODE-POLICY.replay, for `discjump replay`.",
)
def evaluate(
    policies: tuple[str, ...],
    course: str,
    episodes: int | None,
    out: Path | None,
    sampled: bool,
    baselines: bool,
    threads: int | None,
    replays: Path | None,
) -> None:
    """Judge policies on terrain that none was trained on.

    POLICY is a model file, the folder of a run (its best model), or a baseline: random, skier, tacker. All
    play the same episodes. Results go to evaluation.json, evaluation.md and evaluation.png in the folder of
    the first run named, else in runs/evaluation.

    Opening a model file runs code it contains: open only files you trust.
    """
    with clean_errors():
        _evaluate(
            policies,
            course,
            episodes,
            out,
            sampled=sampled,
            with_baselines=baselines,
            threads=threads,
            replays=replays,
        )


def _evaluate(
    policies: tuple[str, ...],
    course_name: str,
    episodes: int | None,
    out: Path | None = None,
    *,
    sampled: bool = False,
    with_baselines: bool = True,
    threads: int | None = None,
    replays: Path | None = None,
) -> None:
    from discjump_training import baselines, picture, report
    from discjump_training import evaluate as judging
    from discjump_training.files import write_atomically

    course = COURSES[course_name]
    count = len(course.seeds(episodes))
    judged = []
    for name in judging.entrants(policies, with_baselines):
        click.echo(f"{name} plays {count} episodes ...", err=True)
        judged.append(
            judging.judge(name, course, count, sampled=sampled, threads=threads, record=3, replays=replays)
        )
    compared = judging.compare(judged)

    runs = [Path(name) for name in policies if Path(name).is_dir()]
    folder = out or (runs[0] / "evaluation" if runs else Path("runs") / "evaluation")
    folder.mkdir(parents=True, exist_ok=True)
    result = judging.as_json(course, count, judged, compared)
    write_atomically(folder / "evaluation.json", (json.dumps(result, indent=1) + "\n").encode())
    write_atomically(folder / "evaluation.md", report.markdown(course, count, judged, compared).encode())
    curves = {name: curve for name in policies if (curve := _run_folder(name) / CURVE).is_file()}
    drawn = [one for one in judged if one.name != "random"] or judged
    levels = {name: judging.level(name, threads) for name in baselines.PARAMETERS} if curves else {}
    picture.draw(folder / "evaluation.png", course, drawn, curves, levels)

    report.show(Console(width=None if sys.stdout.isatty() else 160), course, count, judged, compared)
    for kind, suffix in (("Figures", "json"), ("Table", "md"), ("Picture", "png")):
        click.echo(f"{kind + ':':9}{folder / f'evaluation.{suffix}'}")
    if replays is not None:
        click.echo(f"Replays: {replays} ({count * len(judged)} episodes)")


def _run_folder(name: str) -> Path:
    path = Path(name)
    return path if path.is_dir() else path.parent


@contextmanager
def clean_errors() -> Iterator[None]:
    """Errors the user can mend are printed without a traceback; the exit code is 1."""
    try:
        yield
    except TrainingError as error:
        raise click.ClickException(str(error)) from error
