"""Named, versioned courses: which terrains and which episodes a policy is trained, chosen and judged on.

table    the rows: one per task, from which its courses follow
public   fixed lists of (terrain seed, environment seed, start, goal): data files with a digest
publish  makes them

A course is a pool of terrain seeds and a range of environment seeds. Its episode `i` is the *first* episode
of the environment with seed `base_seed + i`: an episode is a function of that seed alone, so every policy
meets the same starts and goals, and none can collect more short episodes than another by finishing them
sooner. A public course also says where each episode starts and where its goal is.

Seeds are kept apart by wide margins. Training run `r` uses the environment seeds from `r * SEED_SPACING`,
at most `MAX_RUN_SEED` runs; validation, held-out and public courses lie above all of these, and each task has
a range of its own in them.
"""

from discjump_training.courses.course import MAX_RUN_SEED, SEED_SPACING, Course, Place, run_seed
from discjump_training.courses.public import public_courses
from discjump_training.courses.table import ROWS, Band, Row, row
from discjump_training.errors import TrainingError

COURSES = {one.name: one for made in ROWS.values() for one in made.courses()} | public_courses()
"""By name."""

TRAIN = COURSES["ski-train-v1"]
VALIDATION = COURSES["ski-validation-v1"]
HELD_OUT = COURSES["ski-held-out-v1"]


def course(name: str) -> Course:
    """The course of that name.

    Raises:
        TrainingError: if there is none; says which versions and which courses there are.
    """
    if name in COURSES:
        return COURSES[name]
    stem, _, version = name.rpartition("-v")
    versions = [known for known in COURSES if known.rpartition("-v")[0] == stem]
    if versions and version.isdigit():
        raise TrainingError(f"no course is named {name!r}: of {stem} there is {', '.join(versions)}")
    raise TrainingError(f"no course is named {name!r}; there are {', '.join(COURSES)}")


def course_of(task: str, name: str | None) -> Course:
    """A course of a task by its full name, or by its kind: `held-out`, `validation`, `train`, `public`.

    Args:
        task: short name of the task.
        name: of the course; None: held-out.

    Raises:
        TrainingError: there is none, or it is another task's.
    """
    kind = name or "held-out"
    of_kind = sorted(
        (one for one in COURSES.values() if one.task == task and one.kind == kind),
        key=lambda one: one.version,
    )
    found = of_kind[-1] if of_kind else course(kind)
    if found.task != task:
        raise TrainingError(f"course {found.name} is one of the task {found.task}, not of {task}")
    return found


__all__ = [
    "COURSES",
    "HELD_OUT",
    "MAX_RUN_SEED",
    "ROWS",
    "SEED_SPACING",
    "TRAIN",
    "VALIDATION",
    "Band",
    "Course",
    "Place",
    "Row",
    "course",
    "course_of",
    "row",
    "run_seed",
]
