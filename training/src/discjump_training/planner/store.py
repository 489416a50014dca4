"""The folder of a plan: `plan.json` and a replay of each episode. What is finished is not planned again."""

import json
from dataclasses import replace
from pathlib import Path

from discjump.replays import EpisodeReplay
from discjump_training.errors import TrainingError
from discjump_training.files import write_atomically
from discjump_training.planner.planned import Outcome, Planned, load_replay, replay_path

RESULTS = "plan.json"
#: What must be the same for a plan to be gone on with.
SAME = ("task", "course", "settings", "guides", "values", "options")


class Store:
    """Keeps what is finished.

    Args:
        empty: the plan without outcomes.
        resume: go on with what its folder holds; otherwise it must hold no plan.

    Raises:
        TrainingError: if the folder holds a plan and `resume` is not set, or one of something else.
    """

    def __init__(self, empty: Planned, *, resume: bool) -> None:
        self.planned = empty
        folder = empty.folder
        if folder is None:
            if resume:
                raise TrainingError("resume: expected a folder to go on with, got none")
            return
        found = folder / RESULTS
        if found.exists():
            if not resume:
                raise TrainingError(
                    f"{folder} holds a plan already: go on with it (--resume) or name another folder"
                )
            self._read(found)
        (folder / "replays").mkdir(parents=True, exist_ok=True)
        self._write()

    def add(self, outcome: Outcome, replay: EpisodeReplay) -> None:
        """An episode is finished."""
        old = self.planned
        outcomes = sorted([*old.outcomes, outcome], key=lambda one: one.episode)
        self.planned = replace(
            old, outcomes=tuple(outcomes), replays={**old.replays, outcome.episode: replay}
        )
        if old.folder is not None:
            replay.save(replay_path(old.folder, old.course, outcome.episode))
            self._write()

    def _write(self) -> None:
        folder = self.planned.folder
        assert folder is not None
        text = json.dumps(self.planned.as_dict(), indent=1) + "\n"
        write_atomically(folder / RESULTS, text.encode())

    def _read(self, path: Path) -> None:
        empty = self.planned
        try:
            stored = json.loads(path.read_text(encoding="utf-8"))
            outcomes = [Outcome.of(one) for one in stored["episodes"]]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise TrainingError(f"{path} is not what discjump plan wrote: {error!r}") from error
        # Through JSON, as what is stored went: tuples are lists there.
        now = json.loads(json.dumps(empty.as_dict()))
        for key in SAME:
            if stored.get(key) != now[key]:
                raise TrainingError(
                    f"{path} was planned with {key} {stored.get(key)}, this is {now[key]}: "
                    "name another folder"
                )
        kept = tuple(one for one in outcomes if one.episode < empty.wanted)
        if len(kept) < len(outcomes):
            raise TrainingError(
                f"{path} holds {len(outcomes)} episodes, more than the {empty.wanted} asked for now"
            )
        assert empty.folder is not None
        replays = {
            one.episode: load_replay(replay_path(empty.folder, empty.course, one.episode)) for one in kept
        }
        self.planned = replace(empty, outcomes=kept, replays=replays)
