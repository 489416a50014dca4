"""Whether a replay is what it claims to be, and what it scores when it is played again."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from discjump import replays
from discjump.envs.options import SIGHT
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay
from discjump.replays.episode import plain_options
from discjump_training.courses import Course, course
from discjump_training.errors import TrainingError
from discjump_training.judge.play import CLAIM

#: Options that do not change the task: what is observed, what is rewarded, how often one decides.
FREE = {*SIGHT, "reward", "actions", "frame_skip"}
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


def asked(of: Course, episodes: int | None) -> int:
    """How many episodes of a course count."""
    return of.episodes if episodes is None else min(episodes, of.episodes)


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
    if row not in range(asked(of, episodes)):
        raise TrainingError(f"it claims to be episode {row}, which is not one of the {asked(of, episodes)}")
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
    defaults = task.options()
    usual = {**plain_options(defaults), "terrain_seeds": list(of.terrain_seeds)}
    # What the task leaves to its difficulty may also be written out, as earlier releases did.
    level = defaults.level(defaults.difficulty)._asdict()
    for name in sorted(usual.keys() - FREE):
        got = replay.options.get(name, usual[name])
        drawn = level.get(name) if usual[name] is None else None
        if drawn is None or got != (list(drawn) if isinstance(drawn, tuple) else drawn):
            expected[f"option {name}"] = (usual[name], got)
    for name, (wanted, got) in expected.items():
        if wanted != got:
            shown = f"{got}"
            raise TrainingError(
                f"it is not episode {row} of {of.name}: its {name} is {shown:.120}, expected {wanted!s:.120}"
            )
