"""The command `discjump evaluate`."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click
from rich.console import Console

from discjump.envs.tasks import TASKS
from discjump_training.courses import COURSES, Course, course_of
from discjump_training.errors import clean_errors

if TYPE_CHECKING:
    from discjump_training.curves import Curves
    from discjump_training.judge import Evaluation

#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130
#: Learning curve of a run.
CURVE = "curve.csv"
#: Episodes of the first so many rows are drawn.
DRAWN = 3

FOLDER = click.Path(file_okay=False, path_type=Path)


@click.command()
@click.argument("policies", nargs=-1, required=True, metavar="POLICY...")
@click.option(
    "--task", type=click.Choice(list(TASKS)), help="What to judge them in.  [default: the course's, or ski]"
)
@click.option(
    "--course",
    metavar="NAME",
    help="held-out, validation, train or public, or a full name with its version.  [default: held-out]",
)
@click.option("--episodes", type=click.IntRange(min=1), help="The course's first so many.  [default: all]")
@click.option("--out", type=FOLDER, help="Folder for the results.")
@click.option(
    "--sampled", is_flag=True, help="Models draw their actions instead of taking the likeliest (greedy)."
)
@click.option("--baselines/--no-baselines", default=True, show_default=True, help="Judge all baselines too.")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
@click.option(
    "--replays",
    type=FOLDER,
    metavar="FOLDER",
    help="Save a replay of every episode there: COURSE-EPISODE-POLICY.replay, for `discjump replay`. "
    "By default only those of episodes that fail are saved, in the folder of the results.",
)
@click.option(
    "--set",
    "changes",
    multiple=True,
    metavar="OPTION=VALUE",
    help="Change an option of the environment: armor=heavy, fidelity=reference, terrain_seeds=[90, 91].",
)
@click.option(
    "--terrain",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Play on this ground in place of the course's: .npy, heights[row y][column x] in m.",
)
@click.option(
    "--square-size",
    type=click.FloatRange(min=0, min_open=True),
    default=8.0,
    show_default=True,
    help="Distance between the heights of --terrain, m.",
)
@click.option(
    "--noise", type=click.FloatRange(min=0), default=0.0, help="Standard deviation of noise on observations."
)
@click.option(
    "--planner",
    type=click.Path(path_type=Path),
    help="Results of `discjump plan` on the same course: scores are also given as percent of the planner's.",
)
@click.option("--page/--no-page", default=True, show_default=True, help="Write evaluation.html, too.")
@click.option(
    "--resume", is_flag=True, help="Go on with an evaluation that was broken off, in the same --out."
)
def evaluate(
    policies: tuple[str, ...],
    task: str | None,
    course: str | None,
    episodes: int | None,
    out: Path | None,
    sampled: bool,
    baselines: bool,
    threads: int | None,
    replays: Path | None,
    changes: tuple[str, ...],
    terrain: Path | None,
    square_size: float,
    noise: float,
    planner: Path | None,
    page: bool,
    resume: bool,
) -> None:
    """Judge policies on terrain that none was trained on.

    POLICY is a model file of stable-baselines3, the folder of a run (its best model), an ONNX file, a Python
    callable as package.module:function (observation -> action, or a factory of one), a replay or a folder of
    them, a baseline by its name, or `ppo`, the trained policy that comes with the package.
    NAME=POLICY,POLICY,... is a group: training seeds of one algorithm. All play the same episodes. Results go
    to evaluation.json, .md, .png and .html in the folder of the first run named, else in runs/evaluation.
    After Ctrl-C they hold what was played, marked as partial.

    Opening a model file or a callable runs code it contains: open only what you trust.
    """
    with clean_errors():
        run_evaluation(
            policies,
            chosen_course(task, course),
            episodes,
            out,
            sampled=sampled,
            with_baselines=baselines,
            threads=threads,
            replays=replays,
            changes=changes,
            terrain=terrain,
            square_size=square_size,
            noise=noise,
            planner=planner,
            page=page,
            resume=resume,
        )


def chosen_course(task: str | None, name: str | None) -> Course:
    """The course that the options mean.

    Raises:
        TrainingError: there is none.
    """
    if task is None:
        task = COURSES[name].task if name in COURSES else "ski"
    return course_of(task, name)


def run_evaluation(
    names: tuple[str, ...],
    course: Course,
    episodes: int | None,
    out: Path | None = None,
    *,
    sampled: bool = False,
    with_baselines: bool = True,
    threads: int | None = None,
    replays: Path | None = None,
    changes: tuple[str, ...] = (),
    terrain: Path | None = None,
    square_size: float = 8.0,
    noise: float = 0.0,
    planner: Path | None = None,
    page: bool = True,
    resume: bool = False,
) -> None:
    """Judge, and write the results.

    Raises:
        TrainingError: something that the user can mend.
        SystemExit: the user broke it off; the results hold what was played.
    """
    # Imported late: torch takes seconds, and --help should not.
    from discjump_training.judge import BrokenOff, Conditions, Keep, entrants, evaluation, judge
    from discjump_training.judge import planner as planning
    from discjump_training.judge.conditions import parse_changes
    from discjump_training.judge.pieces import Pieces

    count = len(course.seeds(episodes))
    options = parse_changes(changes, course.task)
    conditions = Conditions(course, count, options, terrain, noise, sampled, threads, square_size)
    beside = None if planner is None else planning.load(planner, conditions)
    entered = entrants(names, course, with_baselines=with_baselines, sampled=sampled)

    runs = [Path(name) for name in names if Path(name).is_dir() and (Path(name) / "best.zip").exists()]
    folder = out or (runs[0] / "evaluation" if runs else Path("runs") / "evaluation")
    folder.mkdir(parents=True, exist_ok=True)
    pieces = Pieces(folder, resume=resume)
    keep = Keep(pieces, replays, folder / "failures", tuple(range(min(DRAWN, count))))
    partial = False
    try:
        judged = judge(entered, conditions, keep, telling(count))
    except BrokenOff as stopped:
        judged, partial = stopped.judged, True
    if judged:
        made = evaluation(conditions, judged, beside, partial=partial)
        write(folder, made, threads, page=page)
    if partial:
        played = f"{sum(len(one.episodes) for one in judged)} episodes were played"
        kept = f", {folder} holds them, marked as partial" if judged else ""
        click.echo(f"Broken off: {played}{kept}. Go on with: the same command and --resume", err=True)
        sys.exit(INTERRUPTED)
    pieces.clear()
    if replays is not None:
        click.echo(f"Replays: {replays} ({sum(len(one.members) for one in judged) * count} episodes)")


def telling(count: int) -> Callable[[str, int], None]:
    """What tells the user who is playing."""

    def tell(name: str, done: int) -> None:
        if done == 0:
            click.echo(f"{name} plays {count} episodes ...", err=True)
        elif sys.stderr.isatty():
            click.echo(f"  {done} of {count}\r", nl=False, err=True)

    return tell


def write(folder: Path, made: "Evaluation", threads: int | None, *, page: bool) -> None:
    """Files of the results, and the tables on the terminal."""
    from discjump_training import picture
    from discjump_training.files import write_atomically
    from discjump_training.judge import results, tables

    data = json.dumps(results.as_json(made), indent=1) + "\n"
    write_atomically(folder / "evaluation.json", data.encode())
    write_atomically(folder / "evaluation.md", tables.markdown(made).encode())
    curves = learning(made, threads)
    drawn = [one for one in made.judged if one.name != "random"] or made.judged
    if any(one.episodes.paths for one in drawn):
        picture.draw(folder / "evaluation.png", made.conditions, drawn, curves)
    kinds = [("Figures", "json"), ("Table", "md"), ("Picture", "png")]
    if page:
        from discjump_training.judge.page import render

        write_atomically(folder / "evaluation.html", render(made, curves).encode())
        kinds.append(("Page", "html"))
    tables.show(Console(width=None if sys.stdout.isatty() else 160), made)
    for kind, suffix in kinds:
        if (path := folder / f"evaluation.{suffix}").exists():
            click.echo(f"{kind + ':':9}{path}")
    if saved := sum(each.replay is not None for found in made.failures for each in found):
        click.echo(f"Failures: {saved} replays, listed in evaluation.json")


def learning(made: "Evaluation", threads: int | None) -> "Curves | None":
    """Learning curves of the runs that the judged models came out of, and the scripts' scores beside them."""
    from discjump_training import baselines
    from discjump_training import evaluate as models
    from discjump_training.curves import Curves

    found = {
        one.name: [path for run in one.runs.values() if (path := run / CURVE).is_file()]
        for one in made.judged
    }
    runs = {name: paths for name, paths in found.items() if paths}
    task = made.conditions.task
    scripts = baselines.scripts(task.name) if runs else ()
    return Curves(task, runs, {name: models.level(name, threads, task) for name in scripts}) if runs else None
