"""From names to policies."""

import re
from dataclasses import dataclass
from pathlib import Path

from discjump_training import baselines, model, shipped
from discjump_training.courses import Course
from discjump_training.errors import ModelError
from discjump_training.judge.policies import function, onnx, sb3, tape
from discjump_training.judge.policies.candidate import Candidate

FUNCTION = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_][\w.]*")
GROUP = re.compile(r"(?P<name>[^=/,]+)=(?P<members>.+)")


@dataclass(frozen=True)
class Entrant:
    """What has one row in the table: a policy, or several training seeds of one algorithm.

    Attributes:
        name: in tables.
        members: its policies; more than one where it is a group.
    """

    name: str
    members: tuple[Candidate, ...]


def find(name: str, course: Course, *, sampled: bool = False) -> Candidate:
    """The policy that a name means.

    Args:
        name: a baseline; `ppo`, the policy that ships for the task; a file or folder with a model, an ONNX
            file or replays; `package.module:function`.
        course: whose task it will play.
        sampled: models draw their actions.

    Raises:
        ModelError: it means nothing, or what it means cannot be had.
    """
    known = baselines.names(course.task)
    if name in known:
        needs = baselines.options(course.task)
        return Candidate(name, "baseline", lambda stage: baselines.make(name, stage), needs, name)
    if name == shipped.NAME:
        return sb3.candidate(shipped.policy(course.task), name, course.task, sampled=sampled)
    path = Path(name)
    if path.is_dir():
        if (path / model.BEST).exists():
            return sb3.candidate(path / model.BEST, name, course.task, sampled=sampled)
        if any(path.glob("*.replay")):
            return tape.candidate(path, name, course)
    elif path.suffix == ".onnx":
        return onnx.candidate(path, name, course.task)
    elif path.suffix == ".replay" and path.exists():
        return tape.candidate(path, name, course)
    elif path.exists():
        return sb3.candidate(path, name, course.task, sampled=sampled)
    elif FUNCTION.fullmatch(name):
        return function.imported(name)
    raise ModelError(
        f"{name} is neither a baseline ({', '.join(known)}) nor {shipped.NAME} (the shipped policy) nor a "
        "model file nor the folder of a run, nor one with replays, nor package.module:function"
    )


def entrants(
    names: tuple[str, ...], course: Course, *, with_baselines: bool, sampled: bool = False
) -> list[Entrant]:
    """What to judge, in the order named; baselines that were not named are added if wanted.

    Args:
        names: see `find`; `NAME=POLICY,POLICY,...` is a group: several training seeds of the same algorithm.
        course: whose task they will play.
        with_baselines: add them.
        sampled: models draw their actions.

    Raises:
        ModelError: see `find`, or two groups have one name.
    """
    added = [one for one in baselines.names(course.task) if with_baselines and one not in names]
    found: list[Entrant] = []
    for name in [*dict.fromkeys(names), *added]:
        group = None if Path(name).exists() else GROUP.fullmatch(name)
        members = group["members"].split(",") if group else [name]
        if len(set(members)) < len(members):
            raise ModelError(f"{name}: a policy is named twice in the group")
        called = group["name"] if group else name
        if called in [one.name for one in found]:
            raise ModelError(f"{called} names two policies: choose another name")
        found.append(Entrant(called, tuple(find(one, course, sampled=sampled) for one in members)))
    return found
