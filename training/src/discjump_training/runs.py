"""The folder of a training run: what is in it and how it gets there.

recipe.toml     what was asked for
run.json        seed, versions, machine, how far it came and where the time went
curve.csv       the learning curve, a row per evaluation
best.zip        the model with the best score on the validation course
final.zip       the model at the end
checkpoints/    everything needed to go on: model, optimiser, episodes under way, random generators
tensorboard/    for `tensorboard --logdir`
"""

import csv
import fnmatch
import io
import json
import os
import platform
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, fields
from importlib import metadata
from pathlib import Path
from typing import Any

from discjump_training.errors import TrainingError
from discjump_training.files import write_atomically
from discjump_training.recipe import Recipe

#: Files that a run may leave behind before its first checkpoint, and the folders they are in.
BEGINNINGS = (
    "recipe.toml",
    "curve.csv",
    "best.zip",
    ".*.part",
    "checkpoints/.*.part",
    "tensorboard/events.out.tfevents.*",
)
FOLDERS = ("checkpoints", "tensorboard")


@dataclass
class Point:
    """A row of the learning curve; seconds count a failure as the time limit."""

    steps: int
    training_seconds: float
    validation_success: float
    validation_seconds: float
    training_success: float
    training_return: float
    learning_rate: float

    def rank(self, score: str) -> tuple[float, float]:
        """What is larger for the better one: by the time, or by the share of successes and then the time.

        Args:
            score: the task's, `seconds` or `share`.
        """
        if score == "seconds":
            return -self.validation_seconds, self.validation_success
        return self.validation_success, -self.validation_seconds


#: What the time of a training goes into: fields of `Clock`.
PARTS = ("environment", "policy", "update")


def seconds_of(run: dict[str, Any], parts: Iterable[str] = PARTS) -> float:
    """What a run spent on these, s, from its `run.json`."""
    return float(sum(run["seconds"][part] for part in parts))


def shares(told: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Shares of the training time of runs that went into each of `PARTS`, from their `run.json`."""
    spent = {part: sum(seconds_of(one, [part]) for one in told) for part in PARTS}
    whole = sum(spent.values())
    return {part: value / whole for part, value in spent.items()}


@dataclass
class Clock:
    """Seconds spent since the run began, by what on."""

    environment: float = 0.0
    policy: float = 0.0
    update: float = 0.0
    evaluation: float = 0.0

    @property
    def training(self) -> float:
        """All but evaluation."""
        return self.environment + self.policy + self.update

    def share(self, part: str) -> float:
        """Share of the training time that went into `environment`, `policy` or `update`."""
        return float(getattr(self, part)) / self.training


@dataclass
class Progress:
    """What a run remembers beyond the model: it goes into every checkpoint."""

    seed: int
    curve: list[Point] = field(default_factory=list)
    clock: Clock = field(default_factory=Clock)
    best: Point | None = None
    evaluated_at: int = 0
    checkpointed_at: int = 0

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> "Progress":
        """The inverse of `dataclasses.asdict`.

        Checkpoints that are older than the field `best` have the seconds of the best point alone.
        """
        curve = [Point(**row) for row in data["curve"]]
        if "best" in data:
            best = None if data["best"] is None else Point(**data["best"])
        else:
            best = min(curve, key=lambda point: point.validation_seconds, default=None)
        kept = {name: data[name] for name in ("seed", "evaluated_at", "checkpointed_at")}
        return cls(curve=curve, clock=Clock(**data["clock"]), best=best, **kept)


def check_is_free(folder: Path) -> None:
    """Refuse a folder that holds anything but what a run leaves behind that broke off before its first
    checkpoint: nobody can go on from there, so another may begin.

    Raises:
        TrainingError: if it holds something else, or is no folder.
    """
    if folder.exists() and (not folder.is_dir() or not _only_begun(folder)):
        hint = f"go on with --resume {folder}, or " if checkpoints(folder) else ""
        raise TrainingError(f"{folder} exists and is not an empty folder: {hint}choose another --out")


def clear(folder: Path) -> None:
    """Remove what `check_is_free` lets pass."""
    check_is_free(folder)
    if folder.exists():
        for path in sorted(folder.rglob("*"), reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()


def _only_begun(folder: Path) -> bool:
    for path in folder.rglob("*"):
        name = path.relative_to(folder).as_posix()
        if path.is_symlink() or (path.is_dir() and name not in FOLDERS):
            return False
        if not path.is_dir() and not any(fnmatch.fnmatchcase(name, known) for known in BEGINNINGS):
            return False
    return True


def checkpoints(folder: Path) -> list[Path]:
    """Checkpoints of a run, oldest first."""
    return sorted((folder / "checkpoints").glob("[0-9]*.zip"))


def newest_checkpoint(folder: Path) -> Path:
    """The checkpoint to go on from.

    Raises:
        TrainingError: if there is none.
    """
    found = checkpoints(folder)
    if not found:
        raise TrainingError(f"nothing to resume: there is no checkpoint in {folder / 'checkpoints'}")
    return found[-1]


def write_curve(path: Path, curve: list[Point]) -> None:
    """The learning curve as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, [f.name for f in fields(Point)])
    writer.writeheader()
    writer.writerows(asdict(point) for point in curve)
    write_atomically(path, text.getvalue().encode())


def write_run(folder: Path, recipe: Recipe, progress: Progress, steps: int, from_commit: str | None) -> None:
    """What was run, on what, how far, and where the time went."""
    clock = progress.clock
    run = {
        "task": recipe.task,
        "seed": progress.seed,
        "steps": steps,
        "finished": steps >= recipe.ppo.steps,
        "steps_per_second": steps / clock.training,
        "seconds": asdict(clock),
        "environment_share": clock.share("environment"),
        "best": None if progress.best is None else asdict(progress.best),
        "commit": from_commit,
        "versions": {
            name: metadata.version(name) for name in ("discjump", "stable-baselines3", "torch", "numpy")
        },
        "python": platform.python_version(),
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    write_atomically(folder / "run.json", (json.dumps(run, indent=2) + "\n").encode())


def commit() -> str | None:
    """Commit of the checkout that this package runs from, with `-dirty` where files differ; None where
    it runs from no checkout, or there is no git.
    """
    try:
        said = subprocess.run(
            ["git", "describe", "--always", "--abbrev=40", "--exclude=*", "--dirty"],
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            check=True,
            timeout=10,
        )
        # A package that was installed below somebody else's checkout is not that checkout's.
        subprocess.run(
            ["git", "ls-files", "--error-unmatch", Path(__file__).name],
            cwd=Path(__file__).parent,
            capture_output=True,
            check=True,
            timeout=10,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return said.stdout.strip()
