"""Replays as a policy: each episode plays the actions that were recorded for it."""

from pathlib import Path

import numpy as np

from discjump import replays
from discjump.envs.tasks import TASKS
from discjump.replays import EpisodeReplay, ReplayError
from discjump_training.courses import Course
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.judge.policies.candidate import Candidate, digest_of
from discjump_training.policy import Actions, Mask, Observations

#: Options that say what an action means.
MEANING = ("actions", "turn_rate", "tick_ms", "frame_skip")


def candidate(path: Path, name: str, course: Course) -> Candidate:
    """The replays in a file or folder; those of other courses' episodes are passed over.

    Raises:
        ModelError: there is none of the course, one is damaged, or they mean different things by an action.
    """
    files = sorted(path.glob("*.replay")) if path.is_dir() else [path]
    recorded: dict[int, EpisodeReplay] = {}
    for file in files:
        try:
            found = replays.load(file)
        except ReplayError as error:
            raise ModelError(str(error)) from None
        if not isinstance(found, EpisodeReplay):
            raise ModelError(f"{file} is the replay of a simulator, which has no episodes")
        row = found.seed - course.base_seed
        if found.header["id"] == TASKS[course.task].id and found.episode == 0 and 0 <= row < course.episodes:
            if row in recorded:
                raise ModelError(
                    f"{file}: there is another replay of episode {row} of {course.name} in {path}"
                )
            recorded[row] = found
    if not recorded:
        raise ModelError(
            f"{path}: expected replays of the course {course.name}, it has none among {len(files)}"
        )
    meanings = {repr([replay.options.get(key) for key in MEANING]): replay for replay in recorded.values()}
    if len(meanings) > 1:
        raise ModelError(f"{path}: its replays differ in {', '.join(MEANING)}: {'; '.join(meanings)}")
    options = next(iter(recorded.values())).options
    needs = {key: options[key] for key in MEANING if key in options}
    return Candidate(name, "replays", lambda stage: Tape(recorded, name, stage), needs, digest_of(*files))


class Tape:
    """Plays recorded actions; when they are used up, the last of them goes on.

    Args:
        recorded: replays by row of the course.
        name: in tables.
        stage: where it will play.
    """

    note = "replayed"

    def __init__(self, recorded: dict[int, EpisodeReplay], name: str, stage: Stage) -> None:
        self.name = name
        self._recorded = recorded
        self._dtype = stage.env.single_action_space.dtype
        self._tables: list[Actions] = []
        self._next = 0

    def begin(self, rows: range) -> None:
        """The episodes of these rows are played next.

        Raises:
            ModelError: there is no replay of some of them.
        """
        missing = [row for row in rows if row not in self._recorded]
        if missing:
            shown = ", ".join(map(str, missing[:8])) + (" ..." if len(missing) > 8 else "")
            raise ModelError(f"{self.name} has no replay of {len(missing)} episodes: {shown}")
        self._tables = [self._recorded[row].actions for row in rows]

    def reset(self, done: Mask) -> None:
        """From the first action on."""
        if done.all():
            self._next = 0

    def __call__(self, observations: Observations) -> Actions:
        """The next action of every episode."""
        actions = [table[min(self._next, len(table) - 1)] for table in self._tables]
        self._next += 1
        return np.array(actions, self._dtype)
