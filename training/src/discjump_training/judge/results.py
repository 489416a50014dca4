"""evaluation.json: all figures and every episode, to be read by people's own scripts and by `compare`."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from discjump_training import intervals
from discjump_training.episodes import Episodes
from discjump_training.errors import TrainingError
from discjump_training.judge import statistics
from discjump_training.judge.evaluation import Evaluation
from discjump_training.judge.failures import MEANING, counted
from discjump_training.judge.judged import Judged

SCHEMA = 2
#: What is kept of every episode, by key of `Episodes`.
COLUMNS = ("success", "death", "seconds", "time", "moved", "mean_speed", "top_speed", "damage")
INTERVAL = (
    f"{intervals.CONFIDENCE:.0%}: percentile bootstrap over episodes, stratified by terrain, crossed with "
    f"the runs of a group, {statistics.RESAMPLES} resamples; success: exact (Clopper-Pearson)"
)


def as_json(made: Evaluation) -> dict[str, Any]:
    """Everything."""
    conditions = made.conditions
    course = conditions.course
    # Whoever played most tells where all episodes began.
    longest = max(made.judged, key=lambda one: len(one.episodes)).episodes
    return {
        "schema_version": SCHEMA,
        "task": course.task,
        "score": conditions.task.score,
        "course": course.name,
        "course_digest": course.digest(),
        "terrain_seeds": list(course.terrain_seeds),
        "first_environment_seed": course.base_seed,
        "episodes": conditions.episodes,
        "partial": made.partial,
        "fidelity": conditions.environment({})["fidelity"],
        "changes": conditions.told(),
        "failure_seconds": conditions.time_limit,
        "interval": INTERVAL,
        "causes": MEANING,
        "starts": {
            "terrain": longest.terrain.tolist(),
            "start_distance": longest.start_distance.tolist(),
            "goals": longest.goals.tolist(),
        },
        "policies": [_policy(made, index) for index in range(len(made.judged))],
        "comparisons": [
            {
                "policy": one.policy,
                "against": one.against,
                "episodes": one.episodes,
                "seconds_difference": one.difference.as_dict(),
                "seconds_ratio": one.ratio.as_dict(),
                "success_difference": one.success.as_dict(),
                "improvement": one.improvement.as_dict(),
                "tests": [asdict(test) for test in one.tests],
                "faster_share": one.faster_share,
                "faster_terrains": one.faster_terrains,
                "terrains": one.terrains,
                "by_terrain": {
                    conditions.terrain_name(index): apart for index, apart in one.by_terrain.items()
                },
            }
            for one in made.comparisons
        ],
    }


def _policy(made: Evaluation, index: int) -> dict[str, Any]:
    one, found = made.judged[index], made.failures[index]
    percent = made.percent[index] if made.percent else None
    reached = made.reachable[index] if made.reachable else None
    return {
        "name": one.name,
        "kind": one.kind,
        "actions": one.actions,
        "frame_skip": one.frame_skip,
        "episodes": len(one.episodes),
        "partial": len(one.episodes) < made.conditions.episodes,
        **{key: estimate.as_dict() for key, estimate in made.figures[index].items()},
        "percent_of_planner": None if percent is None else {**percent[0].as_dict(), "episodes": percent[1]},
        "share_of_reachable": None if reached is None else {**reached[0].as_dict(), "episodes": reached[1]},
        "deaths": int(sum(played.death.sum() for played in one.played)),
        "causes": counted(found),
        "failures": [
            {**asdict(each), "replay": None if each.replay is None else str(each.replay)} for each in found
        ],
        "bands": [
            {
                "low": band.low,
                "high": band.high,
                "episodes": band.episodes,
                "success": band.success.as_dict(),
                "seconds": band.seconds.as_dict(),
            }
            for band in made.bands
            if band.policy == one.name
        ],
        "episode_seconds": [round(value, 3) for value in one.episodes.seconds.tolist()],
        "members": [
            {"name": name, **{key: getattr(played, key).tolist() for key in COLUMNS}}
            for name, played in zip(one.members, one.played, strict=True)
        ],
    }


def load(path: Path, name: str | None = None) -> tuple[Judged, dict[str, Any]]:
    """A policy of an earlier evaluation, as it was judged, and what the file says of the evaluation.

    Args:
        path: evaluation.json.
        name: of the policy; None: the first.

    Raises:
        TrainingError: the file cannot be read, is none of ours, or lacks the policy.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise TrainingError(f"cannot read {path}: {error.strerror}") from None
    except ValueError as error:
        raise TrainingError(f"{path} is no evaluation: {error}") from None
    if not isinstance(data, dict) or data.get("schema_version") != SCHEMA:
        version = data.get("schema_version") if isinstance(data, dict) else None
        raise TrainingError(f"{path}: expected an evaluation of schema {SCHEMA}, got {version}")
    try:
        policies = {one["name"]: one for one in data["policies"]}
        if name is not None and name not in policies:
            raise TrainingError(f"{path} has no policy {name}; it has {', '.join(policies)}")
        found = policies[name] if name is not None else data["policies"][0]
        judged = Judged(
            name=found["name"],
            note=found["actions"],
            kind=found["kind"],
            members=tuple(one["name"] for one in found["members"]),
            played=tuple(_episodes(one, data["starts"], found["episodes"]) for one in found["members"]),
            frame_skip=found["frame_skip"],
            usual_skip=found["frame_skip"],
        )
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise TrainingError(f"{path} is no whole evaluation: {type(error).__name__}: {error}") from None
    return judged, data


def _episodes(member: dict[str, Any], starts: dict[str, Any], count: int) -> Episodes:
    flags = ("success", "death")
    columns: dict[str, Any] = {
        key: np.array(member[key], np.bool_ if key in flags else np.float64) for key in COLUMNS
    }
    if any(column.shape != (count,) for column in columns.values()):
        raise ValueError(f"expected {count} episodes of {member['name']}")
    return Episodes(
        **columns,
        start_distance=np.array(starts["start_distance"][:count], np.float64),
        episode_return=np.full(count, np.nan),
        terrain=np.array(starts["terrain"][:count], np.int64),
        goals=np.array(starts["goals"][:count], np.float64),
        paths={},
    )
