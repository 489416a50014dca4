"""Plays the episodes of a course, planning every decision."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from tqdm import tqdm

from discjump.envs.tasks import TASKS, Task
from discjump.replays import EpisodeReplay, VectorRecorder
from discjump_training.courses import COURSES, Course
from discjump_training.errors import TrainingError
from discjump_training.planner import proposals
from discjump_training.planner.planned import Cost, Outcome, Planned
from discjump_training.planner.rollouts import Rollouts
from discjump_training.planner.search import Memory, Search
from discjump_training.planner.settings import Settings
from discjump_training.planner.store import Store
from discjump_training.planner.team import Team

#: Candidates that are simulated at once, about: more gain nothing, and an interruption loses more.
BATCH = 8_192


def plan(
    task: str,
    course: str | Course,
    *,
    episodes: int | None = None,
    settings: Settings | None = None,
    guides: Sequence[str] = (),
    values: Sequence[str] | None = None,
    options: dict[str, Any] | None = None,
    threads: int | None = None,
    group: int | None = None,
    out: str | Path | None = None,
    resume: bool = False,
    quiet: bool = True,
) -> Planned:
    """Plan episodes of a course and play them.

    Args:
        task: name in `discjump.envs.tasks.TASKS`.
        course: of that task, or its name.
        episodes: the course's first so many; all by default.
        settings: of the planner.
        guides: models (files or folders of runs), or a script by name, that complete sequences.
        values: models whose value networks judge the ends of sequences; None: the guides where they are
            models; empty: the task's own objective.
        options: of the task, over those that guides and values need; terrains are the course's.
        threads: of the simulator; None: all cores. No bit depends on it.
        group: episodes planned at once; None: as many as make a good batch. No bit depends on it.
        out: folder where results are kept; None: nowhere.
        resume: go on with what `out` holds.
        quiet: no progress bar.

    Raises:
        TrainingError: something asked for does not exist or does not fit; says what.

    A KeyboardInterrupt leaves finished episodes in `out`, marked partial.
    """
    if task not in TASKS:
        raise TrainingError(f"task: expected one of {', '.join(TASKS)}, got {task!r}")
    if isinstance(course, str):
        if course not in COURSES:
            raise TrainingError(f"course: expected one of {', '.join(COURSES)}, got {course!r}")
        course = COURSES[course]
    settings = settings or Settings()
    seeds = course.seeds(episodes)
    group = max(1, min(64, BATCH // settings.candidates)) if group is None else group
    if group < 1:
        raise TrainingError(f"group: expected at least 1 episode, got {group}")
    team = Team.of(TASKS[task], guides, values)
    empty = Planned(
        task=task,
        course=course,
        wanted=len(seeds),
        settings=settings,
        guides=team.guides,
        values=team.values,
        options={**team.options, **(options or {})},
        outcomes=(),
        replays={},
        folder=None if out is None else Path(out),
    )
    player = _Player(TASKS[task], empty, team, threads, group)
    store = Store(empty, resume=resume)
    finished = {one.episode for one in store.planned.outcomes}
    rows = [row for row in range(len(seeds)) if row not in finished]
    with tqdm(total=len(seeds), initial=len(finished), unit=" episodes", disable=quiet, smoothing=0) as bar:
        for start in range(0, len(rows), group):
            player.play(rows[start : start + group], seeds, store, bar)
    player.close()
    return store.planned


class _Player:
    """Environments and a search for groups of episodes."""

    def __init__(self, task: Task, empty: Planned, team: Team, threads: int | None, group: int) -> None:
        self._options = {"terrain_seeds": list(empty.course.terrain_seeds), **empty.options}
        self._task = task
        self._team = team
        self._settings = empty.settings
        probe: Any = self._env(1)
        inner = probe.unwrapped
        self._made = inner.options
        if self._made.actions != "multi_discrete":
            raise TrainingError(f"actions: expected multi_discrete, got {self._made.actions}")
        team.check(probe)
        self._length = self._settings.decisions(self._made.decision_seconds)
        self._bins: NDArray[np.int64] = np.asarray(inner.single_action_space.nvec, np.int64)
        guide = team.guide(inner)
        proposal = proposals.make(self._settings, self._bins, self._length, self._made.decision_seconds)
        self._rollouts = Rollouts(
            task.id,
            self._options,
            self._settings.candidates,
            threads,
            team.objective(task, inner, self._settings.objective),
            guide,
        )
        guided = guide is not None and self._settings.guided > 0
        self._search = Search(
            self._settings, self._rollouts, proposal, self._bins, self._length, guided=guided
        )
        probe.close()

    def play(self, rows: list[int], seeds: NDArray[np.uint64], store: Store, bar: Any) -> None:
        """Plan these episodes of the course side by side."""
        # A network's sums may be rounded otherwise by several threads.
        before = torch.get_num_threads()
        torch.set_num_threads(1)
        try:
            self._play(rows, [int(seeds[row]) for row in rows], store, bar)
        finally:
            torch.set_num_threads(before)

    def _play(self, rows: list[int], seeds: list[int], store: Store, bar: Any) -> None:
        replays: dict[int, EpisodeReplay] = {}
        env = VectorRecorder(
            self._env(len(rows)),
            episodes=1,
            on_replay=lambda one: replays.__setitem__(one.made["index"], one),
        )
        inner: Any = env.unwrapped
        observations, _ = env.reset(seed=seeds)
        memories = [Memory(seed) for seed in seeds]
        spent = np.zeros((len(rows), 2))
        alive = list(range(len(rows)))
        actions = np.tile(self._bins // 2, (len(rows), 1))
        while alive:
            clock = np.array([time.perf_counter(), time.process_time()])
            plans = self._search.plan(
                [memories[slot] for slot in alive],
                [inner.snapshot(slot) for slot in alive],
                observations[alive],
            )
            spent[alive] += (np.array([time.perf_counter(), time.process_time()]) - clock) / len(alive)
            for nth in range(self._settings.commit):
                for slot, sequence in zip(alive, plans, strict=True):
                    actions[slot] = sequence[nth]
                observations, _, terminated, truncated, info = env.step(actions)
                over = [slot for slot in alive if terminated[slot] or truncated[slot]]
                for slot in over:
                    cost = self._cost(memories[slot].simulated, *spent[slot].tolist())
                    outcome = self._outcome(rows[slot], seeds[slot], slot, info, replays[slot], cost)
                    store.add(outcome, replays[slot])
                    bar.update()
                    bar.set_postfix_str(f"{store.planned.seconds.mean():.2f} s on average")
                plans = [one for slot, one in zip(alive, plans, strict=True) if slot not in over]
                alive = [slot for slot in alive if slot not in over]
            for slot in alive:
                memories[slot].advance(self._settings.commit)
        env.close()

    def _outcome(
        self, row: int, seed: int, slot: int, info: dict[str, Any], replay: EpisodeReplay, cost: Cost
    ) -> Outcome:
        success = bool(info["is_success"][slot])
        return Outcome(
            episode=row,
            seed=seed,
            success=success,
            death=bool(info["death"][slot]),
            timeout=bool(info["timeout"][slot]),
            seconds=float(info["time"][slot]) if success else float(self._made.time_limit),
            decisions=len(replay.actions),
            episode_return=float(info["return"][slot]),
            cost=cost,
        )

    def _cost(self, decisions: int, wall: float, cpu: float) -> Cost:
        return Cost(
            decisions=decisions,
            ticks=decisions * self._made.frame_skip,
            simulated_seconds=decisions * self._made.decision_seconds,
            wall_seconds=wall,
            cpu_seconds=cpu,
        )

    def _env(self, count: int) -> Any:
        return gymnasium.make_vec(self._task.id, num_envs=count, threads=1, **self._options)

    def close(self) -> None:
        """Close the batches."""
        self._rollouts.close()
