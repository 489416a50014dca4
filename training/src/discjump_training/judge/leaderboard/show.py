"""A leaderboard as tables, Markdown and JSON."""

from typing import Any

from discjump.envs.tasks import TASKS
from discjump_training.courses import COURSES
from discjump_training.judge.leaderboard import Leaderboard
from discjump_training.judge.tables import Table
from discjump_training.markdown import cell

NOTE = (
    "Every score was simulated again from the replay's actions. Episodes without a replay that counts are "
    "failures. In brackets 95% intervals."
)


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
