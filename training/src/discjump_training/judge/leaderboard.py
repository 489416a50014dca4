"""A leaderboard whose rows are replays: every score is played again before it is shown.

A replay names a policy, a course and an episode. It counts if it is that episode, in the task's own physics,
and if it comes out as recorded, bit for bit. The score is what comes out here. Episodes of the course that no
replay counts for are failures: nobody gains by leaving out what went badly.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from discjump import replays
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay, ReplayError
from discjump.replays.episode import plain_options
from discjump_training.courses import COURSES, Course, course
from discjump_training.errors import TrainingError
from discjump_training.intervals import Estimate
from discjump_training.judge import statistics
from discjump_training.judge.play import CLAIM
from discjump_training.judge.tables import Table, cell

#: Options that do not change the task: what is observed, what is rewarded, how often one decides.
FREE = {"fan_bearings", "fan_ranges", "landing", "reward", "actions", "frame_skip", "terrains"}
#: Names as `discjump evaluate --replays` gives them.
NAMED = re.compile(r"(?P<course>.+-v\d+)-(?P<episode>\d{4,})-(?P<policy>.+)")


@dataclass(frozen=True)
class Run:
    """A replay that counts.

    Attributes:
        policy, course, episode: what it claims to be, rightly.
        success: it reached the goal.
        seconds: until then; a failure counts as the time limit.
        frame_skip: ticks per decision.
        terrain: digest of its terrain.
        file: where it is.
    """

    policy: str
    course: str
    episode: int
    success: bool
    seconds: float
    frame_skip: int
    terrain: str
    file: Path


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


def checked(file: Path, only: Course | None = None, episodes: int | None = None) -> Run:
    """The score of a replay, played again.

    Raises:
        TrainingError: it is not what it claims to be, or does not come out as recorded.
        ReplayError: it cannot be read or played.
        OSError: the file cannot be read.
    """
    replay = replays.load(file)
    if not isinstance(replay, EpisodeReplay):
        raise TrainingError("it is the replay of a simulator, which has no episodes")
    policy, of, row = claim(replay, file)
    if only is not None and of.name != only.name:
        raise TrainingError(f"it claims to be of the course {of.name}, not {only.name}")
    if row not in range(of.episodes if episodes is None else episodes):
        raise TrainingError(
            f"it claims to be episode {row}, which is not one of the {episodes or of.episodes}"
        )
    check_episode(replay, of, row)
    mismatch = replay.verify()
    if mismatch is not None:
        raise TrainingError(f"it does not come out as recorded: {mismatch}")
    # Not the recorded outcome: what a replay says of itself decides nothing.
    fresh = replay.again()
    if fresh.outcome is None:
        raise TrainingError("it stops before the end of its episode")
    success = bool(fresh.outcome["is_success"])
    limit = float(TASKS[of.task].options.time_limit)
    return Run(
        policy,
        of.name,
        row,
        success,
        float(fresh.outcome["time"]) if success else limit,
        int(replay.options["frame_skip"]),
        str(fresh.header["terrain"]),
        file,
    )


def claim(replay: EpisodeReplay, file: Path) -> tuple[str, Course, int]:
    """Policy, course and episode that a replay claims: by its header, else by its file's name.

    Raises:
        TrainingError: it claims nothing, or a course that there is not.
    """
    stated: Any = replay.header.get(CLAIM)
    if stated is None and (named := NAMED.fullmatch(file.stem)):
        stated = {"policy": named["policy"], "course": named["course"], "episode": int(named["episode"])}
    kinds = {"policy": str, "course": str, "episode": int}
    if not isinstance(stated, dict) or any(
        not isinstance(stated.get(key), kind) or isinstance(stated.get(key), bool)
        for key, kind in kinds.items()
    ):
        raise TrainingError(
            "it does not say whose it is and of which course: neither in its header nor by a name like "
            "COURSE-EPISODE-POLICY.replay"
        )
    return stated["policy"], course(stated["course"]), stated["episode"]


def check_episode(replay: EpisodeReplay, of: Course, row: int) -> None:
    """Refuse a replay that is not that episode of the course in the task's own physics.

    Raises:
        TrainingError: names the first difference.
    """
    task = TASKS[of.task]
    placed = of.places[row] if of.places else None
    reset: dict[str, Any] = {}
    if placed is not None:
        reset = {"terrain_seed": placed.terrain_seed}
        reset |= {
            key: list(point) for key in ("start", "goal") if (point := getattr(placed, key)) is not None
        }
    expected: dict[str, tuple[Any, Any]] = {
        "environment": (task.id, replay.header["id"]),
        "seed": (int(of.seeds()[row]), replay.seed),
        "number of the episode": (0, replay.episode),
        "placement": (reset, replay.header["reset"]),
        "terrains of its own": (None, replay.header["terrains"]),
    }
    usual = {**plain_options(task.options()), "terrain_seeds": list(of.terrain_seeds)}
    known = {one.name for one in fields(task.options)} - FREE
    for name in sorted(known):
        expected[f"option {name}"] = (usual[name], replay.options.get(name, usual[name]))
    for name, (wanted, got) in expected.items():
        if wanted != got:
            shown = f"{got}"
            raise TrainingError(
                f"it is not episode {row} of {of.name}: its {name} is {shown:.120}, expected {wanted!s:.120}"
            )


def standing(runs: list[Run], episodes: int | None) -> Standing:
    """The row of one policy on one course."""
    of = COURSES[runs[0].course]
    task = TASKS[of.task]
    count = of.episodes if episodes is None else episodes
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


def tables(made: Leaderboard) -> list[Table]:
    """One per course, and one of what was refused."""
    shown = []
    for name in dict.fromkeys(one.course for one in made.standings):
        task = TASKS[COURSES[name].task]
        seconds = task.score == "seconds"
        heading = ["rank", "policy", f"time to {task.goal}, s"] if seconds else ["rank", "policy"]
        rows = []
        for rank, one in enumerate((one for one in made.standings if one.course == name), 1):
            cells = [str(rank), one.policy, *([cell(one.score, "s", 2)] if seconds else [])]
            cells += [cell(one.success, "%", 1), f"{one.replays} of {one.episodes}"]
            rows.append([*cells, ", ".join(map(str, one.frame_skips))])
        shown.append(Table(name, [*heading, "success, %", "replays", "frame_skip"], rows))
    if made.refused:
        rows = [[str(one.file), one.reason] for one in made.refused]
        shown.append(Table("Refused", ["replay", "reason"], rows))
    return shown


NOTE = (
    "Every score was simulated again from the replay's actions. Episodes without a replay that counts are "
    "failures. In brackets 95% intervals."
)


def markdown(made: Leaderboard) -> str:
    """As Markdown."""
    parts = [f"## {table.title}\n\n{table.markdown()}" for table in tables(made)]
    return "\n".join(["# Leaderboard\n", *parts, NOTE, ""])


def as_json(made: Leaderboard) -> dict[str, Any]:
    """For leaderboard.json."""
    return {
        "schema_version": 1,
        "standings": [
            {
                "policy": one.policy,
                "course": one.course,
                "course_digest": COURSES[one.course].digest(),
                "replays": one.replays,
                "episodes": one.episodes,
                "score": one.score.as_dict(),
                "success": one.success.as_dict(),
                "frame_skips": list(one.frame_skips),
            }
            for one in made.standings
        ],
        "replays": [{**vars(one), "file": str(one.file)} for one in made.runs],
        "refused": [{"file": str(one.file), "reason": one.reason} for one in made.refused],
    }
