"""Studies: variants of a recipe, several training seeds each, judged on the same episodes.

    python -m discjump_training.study training/studies/terrain.toml --runs runs/terrain --out results

A study is a TOML file: a recipe, changes that all variants share, and variants by name with changes of their
own. Runs that are there already and were made by the same recipe are not trained again, runs that broke off
go on, so the same command finishes a study that was interrupted.
"""

import json
import shlex
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import click
import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from discjump_training import intervals, model, runs
from discjump_training.cli import clean_errors
from discjump_training.courses import COURSES, course
from discjump_training.episodes import Stage
from discjump_training.errors import RecipeError, TrainingError
from discjump_training.files import write_atomically
from discjump_training.policy import Floats
from discjump_training.recipe import Recipe


class Study(BaseModel):
    """What is compared."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    title: str
    recipe: str = Field(description="by name, or a TOML file")
    seeds: list[int] = Field(min_length=1)
    course: str = Field(description="on which the best model of each run is judged")
    base: list[str] = Field([], description="changes of the recipe that all variants share")
    variants: dict[str, list[str]] = Field(
        min_length=1, description="further changes, by name of the variant"
    )

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a study.

        Raises:
            RecipeError: if it cannot be read, or a field does not fit.
        """
        try:
            study = cls.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, ValidationError) as error:
            raise RecipeError(f"{path} is no study: {error}") from None
        course(study.course)
        for name in study.variants:
            study.recipe_of(name)
        return study

    def changes(self, variant: str) -> tuple[str, ...]:
        """All changes of a variant; its own come last and win."""
        return (*self.base, *self.variants[variant])

    def recipe_of(self, variant: str) -> Recipe:
        """The recipe of a variant."""
        return Recipe.load(self.recipe, self.changes(variant))

    def command(self, variant: str, seed: int, folder: Path) -> str:
        """The command that makes the same run."""
        sets = [part for change in self.changes(variant) for part in ("--set", change)]
        recipe = self.recipe_of(variant)
        words = ["discjump", "train", recipe.task, "--recipe", self.recipe, *sets]
        return shlex.join([*words, "--seed", str(seed), "--out", str(folder)])


@dataclass(frozen=True)
class Judged:
    """The best models of a variant's runs.

    Attributes:
        seconds, success: of each seed and episode, (seeds, episodes); failures count as the time limit.
        rates: decisions per second of training, of each seed.
        training: seconds of training, of each seed.
        shares: of the training time, by part, over all seeds.
        commands: that make the runs.
    """

    seconds: Floats
    success: Floats
    rates: list[float]
    training: list[float]
    shares: dict[str, float]
    commands: list[str]


def train_all(study: Study, folder: Path) -> None:
    """Make every run that is missing, seed by seed, so that a study that is cut short has whole seeds.

    Raises:
        TrainingError: if a folder holds a run by another recipe; KeyboardInterrupt: at Ctrl-C.
    """
    from discjump_training.train import train

    for seed in study.seeds:
        for variant in study.variants:
            where, recipe = folder / f"{variant}-{seed}", study.recipe_of(variant)
            begun = bool(runs.checkpoints(where))
            if begun and not same(Recipe.load(where / "recipe.toml"), recipe):
                raise TrainingError(
                    f"{where} holds a run by another recipe: remove it, or choose other --runs"
                )
            if (where / "final.zip").exists():
                continue
            click.echo(study.command(variant, seed, where), err=True)
            if not train(recipe, seed, where, resume=begun, quiet=True).finished:
                raise KeyboardInterrupt


def same(one: Recipe, other: Recipe) -> bool:
    """Whether two recipes give the same policy: threads decide no bit."""

    def deciding(recipe: Recipe) -> dict[str, Any]:
        return recipe.model_dump() | {"rollout": recipe.rollout.model_dump(exclude={"threads"})}

    return deciding(one) == deciding(other)


def judge(study: Study, variant: str, folder: Path, threads: int | None) -> Judged | None:
    """Play the course with the best model of every run of a variant that ended; None where there is none."""
    seconds, success, told, commands = [], [], [], []
    recipe = study.recipe_of(variant)
    stage = Stage(COURSES[study.course], None, recipe.environment.judged(), threads)
    for seed in study.seeds:
        where = folder / f"{variant}-{seed}"
        if not (where / "final.zip").exists():
            continue
        ppo = model.load(where / model.BEST)
        played = stage.play(model.Greedy(ppo, variant))
        seconds.append(played.seconds)
        success.append(played.success.astype(np.float64))
        told.append(json.loads((where / "run.json").read_text(encoding="utf-8")))
        commands.append(study.command(variant, seed, where))
    stage.close()
    if not told:
        return None
    return Judged(
        np.stack(seconds),
        np.stack(success),
        [run["steps_per_second"] for run in told],
        [run["steps"] / run["steps_per_second"] for run in told],
        runs.shares(told),
        commands,
    )


def table(study: Study, judged: dict[str, Judged]) -> tuple[dict[str, Any], str]:
    """The results as JSON and Markdown; differences are to the first variant."""
    first = next(iter(judged.values()))
    rows: dict[str, Any] = {}
    lines = [
        f"# {study.title}",
        "",
        "| variant | seeds | success | mean time, s | against the first, s | in % | each seed, s "
        "| training, s | decisions/s | environment, policy, update |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, one in judged.items():
        mean = intervals.over_seeds(one.seconds)
        gap = None if one is first else intervals.over_seeds_difference(one.seconds, first.seconds)
        percent = 100 * (one.seconds.mean() / first.seconds.mean() - 1)
        each = one.seconds.mean(axis=1)
        rows[name] = {
            "changes": list(study.variants[name]),
            "seconds": mean.as_dict(),
            "difference": None if gap is None else gap.as_dict(),
            "percent": percent,
            "success": float(one.success.mean()),
            "seconds_of_seeds": each.tolist(),
            "training_seconds": one.training,
            "decisions_per_second": one.rates,
            "shares": one.shares,
            "commands": one.commands,
        }
        shares = ", ".join(f"{one.shares[part]:.0%}" for part in runs.PARTS)
        lines.append(
            f"| {name} | {len(each)} | {one.success.mean():.1%} | {mean.value:.2f} [{mean.low:.2f}, "
            f"{mean.high:.2f}] | "
            + ("|" if gap is None else f"{gap.value:+.2f} [{gap.low:+.2f}, {gap.high:+.2f}] | {percent:+.1f}")
            + f" | {' '.join(f'{value:.2f}' for value in each)} | "
            f"{np.mean(one.training):.0f} | {np.mean(one.rates):,.0f} | {shares} |"
        )
    episodes = first.seconds.shape[1]
    lines += [
        "",
        f"{episodes} episodes of {study.course}, the same for every run; the best model of each run (by the "
        "validation course), likeliest actions; failures count as the time limit. Brackets: 95% intervals, "
        "training seeds and episodes both resampled. Training times are of a machine that did other work.",
        "",
        "## Commands",
        "",
        "```",
        *(command for one in judged.values() for command in one.commands),
        "```",
    ]
    result = {
        "schema_version": 1,
        "title": study.title,
        "course": study.course,
        "episodes": episodes,
        "recipe": study.recipe,
        "base": study.base,
        "variants": rows,
    }
    return result, "\n".join(lines) + "\n"


@click.command()
@click.argument("source", type=click.Path(path_type=Path), metavar="STUDY")
@click.option("--runs", "folder", type=click.Path(path_type=Path), required=True, help="Folder of the runs.")
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder of the tables.")
@click.option("--no-train", is_flag=True, help="Judge the runs that are there.")
@click.option(
    "--threads", type=click.IntRange(min=1), help="Of the simulator, to judge.  [default: all cores]"
)
def main(source: Path, folder: Path, out: Path, no_train: bool, threads: int | None) -> None:
    """Train and judge the variants of STUDY."""
    with clean_errors():
        study = Study.load(source)
        if not no_train:
            train_all(study, folder)
        judged = {
            name: one for name in study.variants if (one := judge(study, name, folder, threads)) is not None
        }
        if not judged:
            raise TrainingError(f"{folder} holds no run of this study that ended")
        result, text = table(study, judged)
        out.mkdir(parents=True, exist_ok=True)
        write_atomically(out / f"{source.stem}.json", (json.dumps(result, indent=1) + "\n").encode())
        write_atomically(out / f"{source.stem}.md", text.encode())
        click.echo(text, nl=False)


if __name__ == "__main__":
    main()
