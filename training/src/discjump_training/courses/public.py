"""Public courses: data files `TASK-public-vN.json` beside this module.

Each has the name, the task, the digest of its episodes and those of its terrains' heights, so that neither an
edit of the file nor a change of the generator passes for the same course. `publish` makes them. A published
file is never changed; another list is another version.
"""

import json
from functools import cache
from importlib import resources
from typing import Any

from discjump_training.courses.course import Course, Place
from discjump_training.errors import TrainingError

SCHEMA = 1


def public_courses() -> dict[str, Course]:
    """All that are shipped, by name.

    Raises:
        TrainingError: a file is not what its digest says.
    """
    files = sorted(
        (one for one in resources.files(__package__).iterdir() if one.name.endswith(".json")),
        key=lambda one: one.name,
    )
    found = [parse(one.read_text(encoding="utf-8"), one.name) for one in files]
    return {one.name: one for one in found}


def parse(text: str, name: str) -> Course:
    """The course in a file's text.

    Raises:
        TrainingError: it is damaged, of another schema, or not what its digest says.
    """
    try:
        data = json.loads(text)
        if data["schema_version"] != SCHEMA:
            raise TrainingError(
                f"{name}: expected schema {SCHEMA} of public courses, got {data['schema_version']}"
            )
        places = tuple(
            Place(int(one["terrain_seed"]), point(one.get("start")), point(one.get("goal")))
            for one in data["episodes"]
        )
        seeds = tuple(dict.fromkeys(one.terrain_seed for one in places))
        made = Course(data["name"], seeds, data["first_environment_seed"], len(places), data["task"], places)
        digest = data["digest"]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise TrainingError(f"{name} is no public course: {type(error).__name__}: {error}") from None
    if made.digest() != digest:
        raise TrainingError(f"{name} was changed: its digest is {digest}, its episodes have {made.digest()}")
    return made


def point(value: Any) -> tuple[float, float] | None:
    """x, y as a pair, or None.

    Raises:
        TypeError, ValueError: it is neither.
    """
    if value is None:
        return None
    x, y = (float(one) for one in value)
    return x, y


@cache
def check_terrains(course: Course) -> None:
    """Refuse a public course whose terrains this release generates otherwise.

    Raises:
        TrainingError: names the first such terrain.
    """
    from discjump import Terrain

    text = resources.files(__package__).joinpath(f"{course.name}.json").read_text(encoding="utf-8")
    for seed, digest in json.loads(text)["terrains"].items():
        if (got := Terrain.raindance(int(seed)).digest()) != digest:
            raise TrainingError(
                f"course {course.name}: expected terrain {seed} with the digest {digest}, "
                f"this release generates {got}"
            )
