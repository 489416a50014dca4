"""Judges policies on the fixed episodes of a course: who reaches the beacon, how fast, and by how much one
is faster.

All policies meet the same episodes, so they are compared pair by pair. An episode that ends by time-out or
death counts as 60 s. Intervals are 95% bootstrap intervals over episodes (the success rate's is exact).
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stable_baselines3 import PPO

from discjump.envs.options import SkiOptions
from discjump.replays import EpisodeReplay
from discjump.terrains import SURFACES
from discjump_training import baselines, intervals, model
from discjump_training.courses import COURSES, Course
from discjump_training.episodes import FAILURE_SECONDS, Episodes, Stage
from discjump_training.errors import ModelError, TrainingError
from discjump_training.intervals import Estimate
from discjump_training.policy import Policy
from discjump_training.recipe import Watch

#: Figures of one policy: key, heading, unit, digits.
FIGURES = (
    ("success", "success", "%", 1),
    ("seconds", "time to beacon", "s", 2),
    ("mean_speed", "mean speed", "m/s", 1),
    ("top_speed", "top speed", "m/s", 1),
    ("damage", "damage", "", 3),
)
FIDELITY = SkiOptions.fidelity
#: Ticks per decision of the task; a model that was trained with another time between its decisions is judged
#: with its own, and says so.
FRAME_SKIP = SkiOptions.frame_skip
#: Options that make up the physics of the task, whatever a model was trained in.
PHYSICS: dict[str, Any] = {"fidelity": FIDELITY, "tick_ms": SkiOptions.tick_ms, "surface": SURFACES[0]}
#: What two policies' episodes must have in common to be compared pair by pair.
SHARED = ("start_distance", "terrain", "goals")


@dataclass(frozen=True)
class Judged:
    """A policy and what it did.

    Attributes:
        name: of the policy.
        note: how actions are chosen.
        is_model: no baseline.
        episodes: what happened.
        figures: estimates by key of `FIGURES`.
        frame_skip: ticks per decision that it played with.
    """

    name: str
    note: str
    is_model: bool
    episodes: Episodes
    figures: dict[str, Estimate]
    frame_skip: int = FRAME_SKIP

    @property
    def actions(self) -> str:
        """How actions are chosen, with the ticks per decision where they are not the task's."""
        return self.note if self.frame_skip == FRAME_SKIP else f"{self.note}, frame_skip {self.frame_skip}"


@dataclass(frozen=True)
class Comparison:
    """How much time `policy` needs against `against`, on the same episodes.

    Attributes:
        policy, against: their names.
        difference: mean seconds of policy - against; negative is faster.
        ratio: mean seconds of policy / against; below 1 is faster.
        faster_share: share of the episodes in which the policy is faster.
        faster_terrains: number of terrains on which its mean time is lower.
        terrains: number of terrains.
    """

    policy: str
    against: str
    difference: Estimate
    ratio: Estimate
    faster_share: float
    faster_terrains: int
    terrains: int


def entrants(names: tuple[str, ...], with_baselines: bool) -> list[str]:
    """What to judge, models before baselines; baselines that were not named are added if wanted."""
    added = [name for name in baselines.NAMES if with_baselines and name not in names]
    return [*dict.fromkeys(names), *added]


def model_path(name: str) -> Path:
    """The model that `name` means: a model file, or the folder of a run, whose best model is taken."""
    path = Path(name)
    return path / model.BEST if path.is_dir() else path


def in_task(trained: Mapping[str, Any]) -> dict[str, Any]:
    """Options of the task for a model that was trained with `trained`: what it observes stays its own, the
    physics is the task's, and the time between its decisions stays as near to its own as whole ticks allow.

    >>> in_task({"fidelity": "fast", "tick_ms": 64, "surface": "bilinear", "frame_skip": 2, "landing": False})
    {'fidelity': 'authentic', 'tick_ms': 32, 'surface': 'triangles', 'frame_skip': 4, 'landing': False}
    """
    period = trained.get("tick_ms", SkiOptions.tick_ms) * trained.get("frame_skip", FRAME_SKIP)
    return {**trained, **PHYSICS, "frame_skip": max(1, round(period / PHYSICS["tick_ms"]))}


def judge(
    name: str,
    course: Course,
    episodes: int,
    *,
    sampled: bool,
    threads: int | None,
    record: int,
    at_home: bool = False,
    replays: Path | None = None,
) -> Judged:
    """Play a course with one policy.

    Args:
        name: of a baseline, a model file or the folder of a run.
        course: which episodes.
        episodes: how many of them.
        sampled: models draw their actions instead of taking the likeliest.
        threads: of the simulator.
        record: number of episodes whose paths are kept.
        at_home: models play in the physics that they were trained in, not in the task's.
        replays: folder where the replay of every episode is saved; none where None.

    Raises:
        TrainingError: if the policy cannot be had or does not fit the environment.
    """
    is_model = name not in baselines.NAMES
    policy: Policy
    if is_model:
        stage, ppo = on_stage(model_path(name), course, episodes, threads=threads, at_home=at_home)
        policy = model.Sampled(ppo, name) if sampled else model.Greedy(ppo, name)
    else:
        stage = Stage(course, episodes, baselines.OPTIONS | PHYSICS, threads)
        policy = baselines.make(name, stage)
    keep = None if replays is None else shelf(replays, course, name)
    played = stage.play(policy, record=tuple(range(min(record, episodes))), on_replay=keep)
    stage.close()
    figures = {
        key: intervals.proportion(played.success)
        if key == "success"
        else intervals.mean(getattr(played, key))
        for key, *_ in FIGURES
    }
    return Judged(policy.name, policy.note, is_model, played, figures, stage.frame_skip)


def shelf(folder: Path, course: Course, policy: str) -> Callable[[int, EpisodeReplay], Path]:
    """What saves replays in a folder, under names that tell course, episode and policy."""
    called = re.sub(r"[^A-Za-z0-9.-]+", "-", policy).strip("-.")
    return lambda row, replay: replay.save(folder / f"{course.name}-{row:04}-{called}.replay")


def on_stage(
    path: Path, course: Course, episodes: int, *, threads: int | None, at_home: bool = False
) -> tuple[Stage, PPO]:
    """A model and the environments that it is judged in.

    Args:
        path: of the model file.
        course: which episodes.
        episodes: how many of them.
        threads: of the simulator.
        at_home: in the physics that it was trained in, not in the task's.

    Raises:
        TrainingError: if the model cannot be had or does not fit the environment.
    """
    if not path.exists():
        known = ", ".join(baselines.NAMES)
        raise ModelError(f"{path} is neither a baseline ({known}) nor a model file nor the folder of a run")
    ppo = model.load(path)
    trained = model.about(path).get("environment", {})
    stage = Stage(course, episodes, trained if at_home else in_task(trained), threads)
    model.check_spaces(ppo, path, stage.env)
    return stage, ppo


def level(name: str, threads: int | None) -> float:
    """Mean time of a baseline on the episodes that learning curves are measured on, s."""
    watch = Watch()
    stage = Stage(COURSES[watch.evaluate_course], watch.evaluate_episodes, baselines.OPTIONS, threads)
    return float(stage.play(baselines.make(name, stage)).seconds.mean())


def compare(judged: list[Judged]) -> list[Comparison]:
    """Every model against every baseline; without models, every baseline against the ones after it.

    Raises:
        TrainingError: if two of them did not play the same episodes: `SHARED` must be equal bit for bit.
    """
    models = [one for one in judged if one.is_model]
    if models:
        pairs = [(a, b) for a in models for b in judged if not b.is_model]
        pairs += [(a, b) for i, a in enumerate(models) for b in models[i + 1 :]]
    else:
        pairs = [(a, b) for i, a in enumerate(judged) for b in judged[i + 1 :]]
    return [_comparison(a, b) for a, b in pairs]


def _comparison(a: Judged, b: Judged) -> Comparison:
    for key in SHARED:
        if getattr(a.episodes, key).tobytes() != getattr(b.episodes, key).tobytes():
            raise TrainingError(
                f"{a.name} and {b.name} cannot be compared: expected the same episodes, "
                f"but their {key} differs"
            )
    x, y, terrain = a.episodes.seconds, b.episodes.seconds, a.episodes.terrain
    used = sorted(set(terrain.tolist()))
    return Comparison(
        policy=a.name,
        against=b.name,
        difference=intervals.mean_difference(x, y),
        ratio=intervals.mean_ratio(x, y),
        faster_share=float((x < y).mean()),
        faster_terrains=sum(bool((x - y)[terrain == index].mean() < 0) for index in used),
        terrains=len(used),
    )


def as_json(
    course: Course, episodes: int, judged: list[Judged], compared: list[Comparison]
) -> dict[str, Any]:
    """All figures, and the times of every episode, for `evaluation.json`."""
    return {
        "schema_version": 1,
        "course": course.name,
        "terrain_seeds": list(course.terrain_seeds),
        "first_environment_seed": course.base_seed,
        "episodes": episodes,
        "fidelity": FIDELITY,
        "failure_seconds": FAILURE_SECONDS,
        "interval": (
            f"{intervals.CONFIDENCE:.0%}: BCa bootstrap over episodes, {intervals.RESAMPLES} resamples; "
            "success: exact (Clopper-Pearson)"
        ),
        "policies": [
            {
                "name": one.name,
                "actions": one.note,
                "frame_skip": one.frame_skip,
                **{key: one.figures[key].as_dict() for key, *_ in FIGURES},
                "deaths": int(one.episodes.death.sum()),
                "episode_seconds": [round(value, 3) for value in one.episodes.seconds.tolist()],
            }
            for one in judged
        ],
        "comparisons": [
            {
                "policy": one.policy,
                "against": one.against,
                "seconds_difference": one.difference.as_dict(),
                "seconds_ratio": one.ratio.as_dict(),
                "faster_share": one.faster_share,
                "faster_terrains": one.faster_terrains,
                "terrains": one.terrains,
            }
            for one in compared
        ],
    }
