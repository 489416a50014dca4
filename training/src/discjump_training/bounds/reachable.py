"""Which markers of a course the search reached: data files `COURSE.json` beside this module.

Each has the course's digest, the options that decide what can be reached, and for each episode that was
searched when the marker was reached, in which stage, and by which schedule: who doubts it plays that
(`proof`).
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from importlib import resources
from typing import Any

import numpy as np

from discjump.envs.options import SIGHT, DiscJumpOptions
from discjump_training.bounds.markers import Found
from discjump_training.bounds.tries import Tries
from discjump_training.courses import Course
from discjump_training.errors import TrainingError
from discjump_training.policy import Mask

SCHEMA = 1
#: Options that change what is seen or rewarded, or that the course says: none decides what can be reached.
ELSEWHERE = ("terrain_seeds", "terrains", *SIGHT, "reward", "curriculum")
COLUMNS = tuple(one.name for one in fields(Tries))


@dataclass(frozen=True)
class Reachable:
    """What was searched.

    Attributes:
        course: name.
        course_digest: of its episodes.
        options: that decide what can be reached.
        found: of the course's first episodes, in their order.
    """

    course: str
    course_digest: str
    options: dict[str, Any]
    found: tuple[Found, ...]

    @property
    def reached(self) -> Mask:
        """(episodes,)."""
        return np.array([one.stage is not None for one in self.found], np.bool_)

    def fits(self, course: Course, options: Mapping[str, Any]) -> bool:
        """Whether it is about this course with these options of the task."""
        same = (self.course, self.course_digest) == (course.name, course.digest())
        return same and self.options == deciding(options)

    def to_text(self) -> str:
        """As JSON, an episode to a line."""
        head = {
            "schema_version": SCHEMA,
            "course": self.course,
            "course_digest": self.course_digest,
            "options": self.options,
            "columns": ["stage", "seconds", "miss", "schedules", "marker_height", *COLUMNS],
        }
        rows = [
            json.dumps(
                [
                    *(one.stage, one.seconds, one.miss, one.schedules, one.marker_height),
                    *(one.schedule[name] for name in COLUMNS),
                ]
            )
            for one in self.found
        ]
        return json.dumps(head, indent=1)[:-2] + ',\n "episodes": [\n  ' + ",\n  ".join(rows) + "\n ]\n}\n"


def made(course: Course, options: Mapping[str, Any], found: Sequence[Found]) -> Reachable:
    """What a search came to."""
    return Reachable(course.name, course.digest(), deciding(options), tuple(found))


def load(course: Course) -> Reachable | None:
    """What is shipped about a course; None: nothing.

    Raises:
        TrainingError: the file is damaged.
    """
    file = resources.files(__package__).joinpath(f"{course.name}.json")
    return parse(file.read_text(encoding="utf-8"), course.name) if file.is_file() else None


def parse(text: str, name: str) -> Reachable:
    """What is in a file's text.

    Raises:
        TrainingError: it is damaged, or of another schema.
    """
    try:
        data = json.loads(text)
        if data["schema_version"] != SCHEMA:
            raise TrainingError(f"{name}: expected schema {SCHEMA}, got {data['schema_version']}")
        found = []
        for row, values in enumerate(data["episodes"]):
            one = dict(zip(data["columns"], values, strict=True))
            schedule = {column: one.pop(column) for column in COLUMNS}
            found.append(Found(episode=row, schedule=schedule, **one))
        return Reachable(data["course"], data["course_digest"], data["options"], tuple(found))
    except (ValueError, KeyError, TypeError) as error:
        raise TrainingError(f"{name}: {type(error).__name__}: {error}") from None


def deciding(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of the task that decide what can be reached, as JSON has them.

    Args:
        options: keyword arguments of the environment.
    """
    checked = DiscJumpOptions.from_keywords(
        {name: value for name, value in options.items() if name not in ELSEWHERE}
    )
    told = {one.name: getattr(checked, one.name) for one in fields(checked) if one.name not in ELSEWHERE}
    told |= {"physics": asdict(checked.physics), "level": checked.level(checked.difficulty)._asdict()}
    plain: dict[str, Any] = json.loads(json.dumps(told))
    return plain


def proof(one: Found) -> Tries:
    """The schedule that reached the marker."""
    return Tries(**{name: np.array([value], np.int64) for name, value in one.schedule.items()})
