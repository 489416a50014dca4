"""Plays a course with a policy, a stretch of episodes at a time."""

import re
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np

from discjump.replays import EpisodeReplay
from discjump_training.episodes import Episodes, Stage
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.judged import Judged
from discjump_training.judge.pieces import Pieces
from discjump_training.judge.policies import Candidate, Entrant
from discjump_training.judge.policies.noise import Noisy
from discjump_training.policy import Policy

#: Episodes that are played side by side: what is lost when an evaluation is broken off.
STRETCH = 128
#: Entry of a replay's header that says what it claims to be.
CLAIM = "claim"


@dataclass(frozen=True)
class Keep:
    """What is kept of an evaluation while it goes on.

    Attributes:
        pieces: what was played; None: nothing is kept.
        replays: folder for the replay of every episode; None: only failures are saved.
        failures: folder for those; None: none is.
        paths: indices of the episodes whose paths are kept.
    """

    pieces: Pieces | None = None
    replays: Path | None = None
    failures: Path | None = None
    paths: tuple[int, ...] = ()


class BrokenOff(Exception):
    """The user broke an evaluation off; `judged` holds what was played, which may be less than everything."""

    def __init__(self, judged: list[Judged]) -> None:
        super().__init__("broken off")
        self.judged = judged


def judge(
    entrants: list[Entrant],
    conditions: Conditions,
    keep: Keep | None = None,
    tell: Callable[[str, int], None] = lambda name, done: None,
) -> list[Judged]:
    """What each of them does.

    Args:
        entrants: who plays.
        conditions: what.
        keep: what is kept.
        tell: told the name of a policy and how many episodes it has played, before each stretch.

    Raises:
        TrainingError: a policy does not fit the environment, or fails.
        BrokenOff: Ctrl-C.
    """
    judged: list[Judged] = []
    for entrant in entrants:
        turns: list[_Turn] = []
        try:
            for member in entrant.members:
                turns.append(_Turn(member, conditions, keep or Keep()))
                turns[-1].play(lambda done, name=member.name: tell(name, done))  # type: ignore[misc]
        except KeyboardInterrupt:
            if begun := [turn for turn in turns if turn.played]:
                judged.append(_judged(entrant, conditions, begun))
            raise BrokenOff(judged) from None
        judged.append(_judged(entrant, conditions, turns))
    return judged


def _judged(entrant: Entrant, conditions: Conditions, turns: list["_Turn"]) -> Judged:
    """What the members did, on the episodes that all of them played."""
    tables = tuple(joined(turn.played) for turn in turns)
    judged = Judged(
        name=entrant.name,
        note=turns[0].note,
        kind=turns[0].candidate.kind,
        members=tuple(turn.candidate.name for turn in turns),
        played=tables,
        frame_skip=turns[0].frame_skip,
        usual_skip=conditions.task.options.frame_skip,
        replays={(i, row): path for i, turn in enumerate(turns) for row, path in turn.replays.items()},
        runs={turn.candidate.name: turn.candidate.run for turn in turns if turn.candidate.run is not None},
    )
    count = min(len(table) for table in tables)
    return judged if all(len(table) == count for table in tables) else judged.first(count)


class _Turn:
    """One policy's turn."""

    def __init__(self, candidate: Candidate, conditions: Conditions, keep: Keep) -> None:
        self.candidate = candidate
        self._conditions = conditions
        self._keep = keep
        self._policy: Policy | None = None
        self.played: list[Episodes] = []
        self.replays: dict[int, Path] = {}
        self.note = ""
        self.frame_skip = 0

    def play(self, tell: Callable[[int], None]) -> None:
        """Play everything that was not played before."""
        conditions, keep = self._conditions, self._keep
        key = ""
        if keep.pieces is not None:
            key = keep.pieces.key(
                policy=self.candidate.identity,
                name=self.candidate.name,
                needs=dict(self.candidate.needs),
                course=conditions.course.digest(),
                conditions=conditions.told(),
                sampled=conditions.sampled,
                replays=str(keep.replays),
                failures=str(keep.failures),
                paths=keep.paths,
            )
        self._prepare()
        for start in range(0, conditions.episodes, STRETCH):
            rows = range(start, min(start + STRETCH, conditions.episodes))
            tell(start)
            found = keep.pieces.get(key, rows) if keep.pieces is not None else None
            if found is None:
                found = self._stretch(rows)
                if keep.pieces is not None:
                    keep.pieces.put(key, rows, *found)
            self.played.append(found[0])
            self.replays |= found[1]

    def _stage(self, rows: range) -> Stage:
        conditions = self._conditions
        options = conditions.environment(self.candidate.needs)
        return Stage(conditions.course, conditions.episodes, options, conditions.threads, rows=rows)

    def _prepare(self) -> None:
        """The policy, and whether it fits."""
        stage = self._stage(range(1))
        policy = self.candidate.make(stage)
        if self._conditions.noise:
            size = int(np.prod(stage.env.single_observation_space.shape or ()))
            policy = Noisy(policy, self._conditions.noise, size)
        self._policy, self.note, self.frame_skip = policy, policy.note, stage.frame_skip
        stage.close()

    def _stretch(self, rows: range) -> tuple[Episodes, dict[int, Path]]:
        assert self._policy is not None
        stage = self._stage(rows)
        saved: dict[int, Path] = {}
        keep = None
        if self._keep.replays is not None or self._keep.failures is not None:
            keep = self._save(saved)
        record = tuple(row - rows.start for row in self._keep.paths if row in rows)
        played = stage.play(self._policy, record, keep)
        stage.close()
        paths = {row + rows.start: path for row, path in played.paths.items()}
        return replace(played, paths=paths), saved

    def _save(self, saved: dict[int, Path]) -> Callable[[int, EpisodeReplay], None]:
        """What saves those replays that are wanted, under names that tell course, episode and policy."""
        course, name = self._conditions.course.name, self.candidate.name
        called = re.sub(r"[^A-Za-z0-9.-]+", "-", name).strip("-.")

        def save(row: int, replay: EpisodeReplay) -> None:
            failed = not (replay.outcome or {}).get("is_success")
            folder = self._keep.replays or (self._keep.failures if failed else None)
            if folder is not None:
                claim = {"policy": name, "course": course, "episode": row}
                path = folder / f"{course}-{row:04}-{called}.replay"
                saved[row] = replay.changed(header={CLAIM: claim}).save(path)

        return save


def joined(pieces: list[Episodes]) -> Episodes:
    """Stretches of episodes in a row, as one."""
    columns = {
        one.name: np.concatenate([getattr(piece, one.name) for piece in pieces])
        for one in fields(Episodes)
        if one.name not in ("paths", "extra")
    }
    paths = {row: path for piece in pieces for row, path in piece.paths.items()}
    keys = set.intersection(*(set(piece.extra) for piece in pieces))
    extra = {key: np.concatenate([piece.extra[key] for piece in pieces]) for key in sorted(keys)}
    return Episodes(**columns, paths=paths, extra=extra)
