"""Episodes that failed, by cause."""

from dataclasses import dataclass
from pathlib import Path

from discjump_training.episodes import STUCK_METRES, STUCK_SECONDS
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.judged import Judged

CAUSES = ("death", "time-out", "stuck")
MEANING = (
    f"Stuck: timed out with all positions of the last {STUCK_SECONDS:g} s within {STUCK_METRES:g} m of the "
    "last one; time-out: any other."
)


@dataclass(frozen=True)
class Failure:
    """An episode that failed.

    Attributes:
        policy: name of the row.
        member: of the policy in it.
        episode: row of the course.
        terrain: its seed, or the name of a file.
        cause: one of `CAUSES`.
        time: length of the episode, s.
        start_distance: horizontal metres from start to goal.
        replay: file; None where none was saved.
    """

    policy: str
    member: str
    episode: int
    terrain: str
    cause: str
    time: float
    start_distance: float
    replay: Path | None


def failures(one: Judged, conditions: Conditions) -> list[Failure]:
    """All of a policy's, in the order of the course."""
    found = []
    for index, (member, played) in enumerate(zip(one.members, one.played, strict=True)):
        for row in (~played.success).nonzero()[0].tolist():
            cause = "death" if played.death[row] else "stuck" if played.stuck[row] else "time-out"
            found.append(
                Failure(
                    one.name,
                    member,
                    row,
                    conditions.terrain_name(int(played.terrain[row])),
                    cause,
                    float(played.time[row]),
                    float(played.start_distance[row]),
                    one.replays.get((index, row)),
                )
            )
    return found


def counted(found: list[Failure]) -> dict[str, int]:
    """How many of each cause."""
    return {cause: sum(one.cause == cause for one in found) for cause in CAUSES}
