"""Tunes a scripted baseline on the training course: `python -m discjump_training.tune skier`.

Differential evolution over all parameters of the script, started from a Sobol sequence. The search is
seeded and the episodes are fixed, so the same command gives the same constants on the same simulator.
"""

import sys
from typing import Any

import click
import numpy as np
from scipy.optimize import Bounds, differential_evolution
from scipy.stats import qmc
from tqdm import tqdm

from discjump.envs.tasks import TASKS
from discjump_training import baselines
from discjump_training.baselines import Parameters
from discjump_training.baselines.script import bounds
from discjump_training.courses import TRAIN, course_of
from discjump_training.episodes import Stage

#: What each is tuned on.
TASK = {"skier": "ski", "tacker": "ski", "jumper": "disc-jump", "runner": "route"}


def cost(stage: Stage, name: str, values: Any) -> float:
    """What a script with these parameter values is to have little of: mean seconds, a failure counting as the
    time limit; where the score is the share of episodes that succeed, the share that fails.
    """
    parameters = baselines.PARAMETERS[name](*map(float, values))
    played = stage.play(baselines.make(name, stage, parameters))
    if TASKS[stage.course.task].score == "share":
        return 1.0 - float(played.success.mean())
    return float(played.seconds.mean())


def search(
    name: str, *, generations: int, population: int, episodes: int, seed: int, threads: int | None
) -> Parameters:
    """The best parameters found, rounded to the digits that are printed.

    Args:
        name: of a script.
        generations: of the evolution after the first.
        population: candidates per generation; at the start as many points of a Sobol sequence.
        episodes: of the training course that each candidate plays.
        seed: of the search.
        threads: of the simulator.
    """
    kind = baselines.PARAMETERS[name]
    limits = bounds(kind)
    stage = Stage(course_of(TASK[name], "train"), episodes, baselines.OPTIONS, threads)
    best = float("inf")
    with tqdm(total=population * (generations + 1), unit=" candidates", file=sys.stderr) as bar:

        def judged(values: Any) -> float:
            nonlocal best
            result = cost(stage, name, values)
            if result < best:
                best = result
                bar.set_postfix(best=f"{best:.3f}")
            bar.update()
            return result

        rng = np.random.default_rng(seed)
        start = _sobol(limits, population, rng)
        found = differential_evolution(
            judged,
            Bounds(*np.array(limits).T),
            init=start,
            maxiter=generations,
            mutation=(0.4, 0.9),
            recombination=0.8,
            tol=0.0,
            polish=False,
            rng=rng,
        )
    return baselines.rounded(kind(*map(float, found.x)))


def _sobol(limits: Any, count: int, rng: np.random.Generator) -> Any:
    low, high = np.array(limits).T
    exponent = int(np.ceil(np.log2(count)))
    return qmc.scale(qmc.Sobol(len(limits), rng=rng).random_base2(exponent)[:count], low, high)


@click.command()
@click.argument("name", type=click.Choice(list(baselines.PARAMETERS)))
@click.option("--generations", default=40, show_default=True, type=click.IntRange(min=0))
@click.option("--population", default=32, show_default=True, type=click.IntRange(min=5))
@click.option("--episodes", default=512, show_default=True, type=click.IntRange(1, TRAIN.episodes))
@click.option("--seed", default=0, show_default=True, type=click.IntRange(min=0))
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator; all cores by default.")
def main(name: str, generations: int, population: int, episodes: int, seed: int, threads: int | None) -> None:
    """Search constants for a scripted baseline on the training course and print them as TOML."""
    parameters = search(
        name, generations=generations, population=population, episodes=episodes, seed=seed, threads=threads
    )
    click.echo(f"# python -m discjump_training.tune {' '.join(sys.argv[1:])}")
    for kind in ("train", "validation"):
        course = course_of(TASK[name], kind)
        stage = Stage(course, 512, baselines.OPTIONS, threads)
        played = stage.play(baselines.make(name, stage, parameters))
        success, mean = played.success.mean(), played.seconds.mean()
        click.echo(f"# {course.name}: {success:.1%} success, {mean:.2f} s, 512 episodes")
    click.echo(f"[{name}.parameters]\n{baselines.to_toml(parameters)}", nl=False)


if __name__ == "__main__":
    main()
