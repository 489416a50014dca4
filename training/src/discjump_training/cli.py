"""The command `discjump train`, and those that judge."""

import sys
from datetime import datetime
from pathlib import Path

import click

from discjump.envs.tasks import TASKS
from discjump_training.commands.compare import compare
from discjump_training.commands.evaluate import evaluate, run_evaluation
from discjump_training.commands.leaderboard import leaderboard
from discjump_training.courses import COURSES, MAX_RUN_SEED
from discjump_training.errors import RecipeError, clean_errors
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

__all__ = ["clean_errors", "compare", "evaluate", "leaderboard", "train"]


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
            run_evaluation((str(folder),), held_out, SMOKE_EPISODES if smoke else held_out.episodes)


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
