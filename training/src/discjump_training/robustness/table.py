"""Who does how well under each condition."""

from collections.abc import Mapping
from typing import Any

from discjump.envs.tasks import TASKS
from discjump_training.courses import Course
from discjump_training.judge import Judged, statistics
from discjump_training.judge.tables import cell


def as_json(course: Course, episodes: int, played: Mapping[str, list[Judged]]) -> dict[str, Any]:
    """Success and time of each policy by condition, with 95% intervals."""
    return {
        "schema_version": 1,
        "task": course.task,
        "course": course.name,
        "episodes": episodes,
        "conditions": {
            name: {
                one.name: {
                    "success": statistics.share(one.success, one.terrain).as_dict(),
                    "seconds": statistics.estimate(
                        statistics.mean, [one.table("seconds")], one.terrain
                    ).as_dict(),
                }
                for one in judged
            }
            for name, judged in played.items()
        },
    }


def markdown(course: Course, episodes: int, played: Mapping[str, list[Judged]], command: str) -> str:
    """A row per condition, two columns per policy."""
    first = next(iter(played.values()))
    heading = ["condition"]
    for one in first:
        heading += [f"{one.name}: success, %", f"time to {TASKS[course.task].goal}, s"]
    lines = [heading, ["---"] * len(heading)]
    for name, judged in played.items():
        row = [name]
        for one in judged:
            row.append(cell(statistics.share(one.success, one.terrain), "%", 1))
            row.append(
                cell(statistics.estimate(statistics.mean, [one.table("seconds")], one.terrain), "s", 2)
            )
        lines.append(row)
    table = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    what = (
        f"The first {episodes} episodes of {course.name}; each row changes one thing. Failures count as the "
        "time limit. Brackets: 95% intervals over episodes, and over training seeds where there are several. "
        "With another armor, speeds, tanks and weights are others than the policy ever met."
    )
    return f"{table}\n{what}\n\n    {command}\n"
