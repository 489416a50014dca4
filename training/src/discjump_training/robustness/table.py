"""Who does how well under each condition."""

from collections.abc import Mapping
from typing import Any

from discjump.envs.tasks import TASKS
from discjump_training.courses import Course
from discjump_training.intervals import Estimate
from discjump_training.judge import Judged, statistics
from discjump_training.markdown import cell, table


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


def markdown(told: dict[str, Any], command: str) -> str:
    """A row per condition, two columns per policy, of what `as_json` says."""
    conditions = told["conditions"]
    heading = ["condition"]
    for name in next(iter(conditions.values())):
        heading += [f"{name}: success, %", f"time to {TASKS[told['task']].goal}, s"]
    body = []
    for condition, played in conditions.items():
        row = [condition]
        for one in played.values():
            row += [cell(Estimate(**one["success"]), "%", 1), cell(Estimate(**one["seconds"]), "s", 2)]
        body.append(row)
    what = (
        f"The first {told['episodes']} episodes of {told['course']}; each row changes one thing. Failures "
        "count as the time limit. Brackets: 95% intervals over episodes, and over training seeds where there "
        "are several. With another armor, speeds, tanks and weights are others than the policy ever met."
    )
    return f"{table(heading, body)}\n{what}\n\n    {command}\n"
