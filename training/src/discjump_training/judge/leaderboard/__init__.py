"""A leaderboard whose rows are replays: every score is played again before it is shown.

verify   whether a replay is what it claims to be, and its score
show     tables, Markdown, JSON

A replay names a policy, a course and an episode. It counts if it is that episode, in the task's own physics,
and if it comes out as recorded, bit for bit. The score is what comes out here. Episodes of the course that no
replay counts for are failures: nobody gains by leaving out what went badly.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from discjump.envs.tasks import TASKS
from discjump.replays import ReplayError
from discjump_training.courses import COURSES, Course
from discjump_training.errors import TrainingError
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.leaderboard.verify import Run, asked, checked


@dataclass(frozen=True)
class Refused:
    """A replay that does not count.

    Attributes:
        file: where it is.
        reason: why.
    """

    file: Path
    reason: str


@dataclass(frozen=True)
class Standing:
    """A row of the leaderboard.

    Attributes:
        policy, course: names.
        replays: how many count.
        episodes: how many were asked for.
        score: mean time with missing episodes as failures, or share of successes.
        success: share, with missing episodes as failures.
        frame_skips: ticks per decision.
    """

    policy: str
    course: str
    replays: int
    episodes: int
    score: Estimate
    success: Estimate
    frame_skips: tuple[int, ...]


@dataclass(frozen=True)
class Leaderboard:
    """Standings, best first within each course, and what was refused."""

    standings: list[Standing]
    runs: list[Run]
    refused: list[Refused]


def found(places: tuple[Path, ...]) -> list[Path]:
    """Replay files of files and folders.

    Raises:
        TrainingError: there are none.
    """
    files = [
        file for place in places for file in (sorted(place.rglob("*.replay")) if place.is_dir() else [place])
    ]
    if not files:
        raise TrainingError(f"expected replays (*.replay) in {', '.join(map(str, places))}, got none")
    return list(dict.fromkeys(files))


def leaderboard(
    files: list[Path],
    only: Course | None = None,
    episodes: int | None = None,
    tell: Callable[[int], None] = lambda count: None,
) -> Leaderboard:
    """Play all of them again.

    Args:
        files: replays.
        only: refuse those of other courses.
        episodes: the course's first so many are asked for; all by default.
        tell: told how many files were looked at.

    Raises:
        TrainingError: the course has fewer episodes.
    """
    if only is not None:
        only.seeds(episodes)
    runs: dict[tuple[str, str, int], Run] = {}
    refused: list[Refused] = []
    for count, file in enumerate(files):
        tell(count)
        try:
            run = checked(file, only, episodes)
            earlier = runs.get((run.policy, run.course, run.episode))
            if earlier is not None:
                raise TrainingError(f"{earlier.file} is {run.policy}'s replay of this episode already")
        except (TrainingError, ReplayError, OSError) as error:
            refused.append(Refused(file, str(error).removeprefix(f"{file}: ")))
        else:
            runs[run.policy, run.course, run.episode] = run
    kept = list(runs.values())
    names = dict.fromkeys((run.course, run.policy) for run in kept)
    standings = [
        standing([run for run in kept if (run.course, run.policy) == name], episodes) for name in names
    ]
    return Leaderboard(sorted(standings, key=_rank), kept, refused)


def standing(runs: list[Run], episodes: int | None) -> Standing:
    """The row of one policy on one course."""
    of = COURSES[runs[0].course]
    task = TASKS[of.task]
    count = asked(of, episodes)
    seconds = np.full(count, float(task.options.time_limit))
    success = np.zeros(count, np.bool_)
    terrain = np.full(count, "", dtype="U64")
    for run in runs:
        seconds[run.episode], success[run.episode], terrain[run.episode] = (
            run.seconds,
            run.success,
            run.terrain,
        )
    share = statistics.share(success[np.newaxis], terrain)
    score = share
    if task.score == "seconds":
        score = statistics.estimate(statistics.mean, [seconds], terrain)
    skips = tuple(sorted({run.frame_skip for run in runs}))
    return Standing(runs[0].policy, of.name, len(runs), count, score, share, skips)


def _rank(one: Standing) -> tuple[str, float, str]:
    less = TASKS[COURSES[one.course].task].score == "seconds"
    return one.course, one.score.value if less else -one.score.value, one.policy


__all__ = ["Leaderboard", "Refused", "Run", "Standing", "checked", "found", "leaderboard"]
