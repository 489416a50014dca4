"""The command `discjump plan`."""

import json
import sys
from pathlib import Path

import click
from rich.console import Console

from discjump.envs.tasks import TASKS
from discjump_training.cli import INTERRUPTED, clean_errors
from discjump_training.courses import course_of
from discjump_training.planner.settings import OBJECTIVES, PROPOSALS, Settings

#: Figures of a plan, beside `plan.json`.
FIGURES = "figures.json"
DEFAULTS = Settings()


@click.command()
@click.argument("task", type=click.Choice(list(TASKS)))
@click.option(
    "--course", metavar="NAME", help="Full name, or held-out, validation, train, public.  [default: held-out]"
)
@click.option("--episodes", type=click.IntRange(min=1), help="The course's first so many.  [default: all]")
@click.option(
    "--candidates",
    default=DEFAULTS.candidates,
    show_default=True,
    help="Sequences tried at once per episode.",
)
@click.option("--horizon", default=DEFAULTS.horizon, show_default=True, help="How far they reach, s.")
@click.option(
    "--iterations", default=DEFAULTS.iterations, show_default=True, help="Times they are drawn for each plan."
)
@click.option("--commit", default=DEFAULTS.commit, show_default=True, help="Decisions played of each plan.")
@click.option(
    "--proposal",
    default=DEFAULTS.proposal,
    show_default=True,
    type=click.Choice(PROPOSALS),
    help="How drawn.",
)
@click.option("--elites", default=DEFAULTS.elites, show_default=True, help="Best sequences that are kept.")
@click.option(
    "--model",
    "models",
    multiple=True,
    metavar="POLICY",
    help="A model (file or folder of a run; may be repeated), or a script by name, that completes sequences.",
)
@click.option(
    "--guided", default=DEFAULTS.guided, show_default=True, help="Share of the sequences that it completes."
)
@click.option(
    "--value",
    "values",
    multiple=True,
    metavar="MODEL",
    help="Model whose value network judges where sequences end (may be repeated); none: the task's own "
    "objective.  [default: the models of --model]",
)
@click.option(
    "--objective",
    default=DEFAULTS.objective,
    show_default=True,
    type=click.Choice(OBJECTIVES),
    help="What is wanted where no value network judges: the task's own objective, or the sum of rewards.",
)
@click.option("--seed", default=DEFAULTS.seed, show_default=True, help="Of all draws.")
@click.option(
    "--threads", type=click.IntRange(min=1), help="Of the simulator; changes no bit.  [default: all cores]"
)
@click.option("--group", type=click.IntRange(min=1), help="Episodes planned at once; changes no bit.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder.  [default: runs/plan-TASK-COURSE]",
)
@click.option("--resume", is_flag=True, help="Go on with what the folder holds.")
@click.option("--quiet", is_flag=True, help="No progress bar.")
def plan(
    task: str,
    course: str | None,
    episodes: int | None,
    candidates: int,
    horizon: float,
    iterations: int,
    commit: int,
    proposal: str,
    elites: int,
    models: tuple[str, ...],
    guided: float,
    values: tuple[str, ...],
    objective: str,
    seed: int,
    threads: int | None,
    group: int | None,
    out: Path | None,
    resume: bool,
    quiet: bool,
) -> None:
    """Plan every decision of a course's episodes by simulation: what is possible, at what cost.

    For each decision sequences of actions are drawn, simulated from a copy of the real state, and drawn again
    round the best ones; of the best the first decision is played. Results go to plan.json and figures.json in
    the folder, and each episode to a replay in replays/ (`discjump replay --verify`). Ctrl-C keeps finished
    episodes; --resume goes on with the others. The same arguments give the same bits.

    Opening a model file runs code it contains: open only files you trust.
    """
    # Imported late: torch takes seconds, and --help should not.
    from discjump_training.planner import report
    from discjump_training.planner.play import plan as run
    from discjump_training.planner.store import RESULTS
    from discjump_training.planner.team import NO_VALUE

    with clean_errors():
        where = course_of(task, course).name
        folder = out or Path("runs") / f"plan-{task}-{where}"
        settings = Settings(
            candidates=candidates,
            horizon=horizon,
            iterations=iterations,
            commit=commit,
            proposal=proposal,
            elites=elites,
            guided=guided,
            objective=objective,
            seed=seed,
        )
        try:
            planned = run(
                task,
                where,
                episodes=episodes,
                settings=settings,
                guides=models,
                values=_values(values, NO_VALUE),
                threads=threads,
                group=group,
                out=folder,
                resume=resume,
                quiet=quiet,
            )
        except KeyboardInterrupt:
            results = folder / RESULTS
            stored = json.loads(results.read_text())["episodes"] if results.exists() else []
            click.echo(
                f"Stopped after {len(stored)} episodes, which are kept in {results}, marked partial.\n"
                "Go on with the same command and --resume.",
                err=True,
            )
            sys.exit(INTERRUPTED)
        from discjump_training.files import write_atomically

        text = json.dumps(report.figures(planned), indent=1) + "\n"
        write_atomically(folder / FIGURES, text.encode())
        report.show(Console(width=None if sys.stdout.isatty() else 160), planned)
    click.echo(f"Results: {folder / RESULTS}, {folder / FIGURES}\nReplays: {folder / 'replays'}")


def _values(names: tuple[str, ...], nothing: str) -> tuple[str, ...] | None:
    """What `--value` means: not given, nothing, or models."""
    if not names:
        return None
    return () if names == (nothing,) else names
