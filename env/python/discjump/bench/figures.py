"""Every figure that is asked for, as data."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from discjump.bench.clock import Effort, interleave
from discjump.bench.figure import Figure, beside, call, known, rate, ratio, row
from discjump.bench.ways import FAR, SEED, Agents, Players, Resets, Sb3, Single, Vector
from discjump.envs.options import SkiOptions
from discjump.simulator import SCENES, Simulator
from discjump.terrains import generated

MEDIUM, LARGE = 4096, 16384
SIZES = (1024, MEDIUM, LARGE)
"""Targets hold from `MEDIUM` on."""
ENDED, ENDLESS = 0.032, 60.0
"""Time limits, s: every episode ends in every step of one tick, or hardly any does."""


def measure(effort: Effort) -> list[dict[str, Any]]:
    """All of them, for `figure.table` and JSON."""
    timed = [*physics(), *steps(), *calls(), *ratios()]
    # Cases that are compared come next to each other: the less can change between them.
    compared_first = sorted(timed, key=lambda figure: -len(figure.cases))
    times = interleave((case for figure in compared_first for case in figure.cases), effort, "figures")
    return [row(figure, times) for figure in (*timed, *stored())]


def physics() -> Iterator[Figure]:
    """Players without a task."""
    what = "player-ticks/s, physics only, ski, authentic, 16,384 players, 4 ticks a call"
    yield rate(what, Players(LARGE), 100)
    yield rate(f"{what}; 8 lanes", Players(LARGE, lanes=8), 50)
    scalar, eight, most = (Players(LARGE, 1, lanes) for lanes in (1, 8, None))
    yield ratio("lanes over scalar, one thread", (scalar, most), 4, at_least=True)
    yield ratio("8 lanes over scalar, one thread", (scalar, eight), 2.5, at_least=True)


def steps() -> Iterator[Figure]:
    """Environments, by way in and size."""
    asked: dict[tuple[int, int | None], float] = {(1, None): 18, (1, 8): 9, (4, None): 12}
    for frame_skip in (1, 4):
        for lanes in (None, 8):
            target = asked.get((frame_skip, lanes))
            name = f"Rust, frame_skip {frame_skip}, {'lanes' if lanes is None else f'{lanes} lanes'}"
            for size in SIZES:
                yield _steps(name, Agents(size, frame_skip, lanes=lanes), target)
    for dtype in ("int8", "int64"):
        for size in SIZES:
            yield _steps(f"VectorEnv.step, frame_skip 1, {dtype} actions", Vector(size, dtype=dtype), 15)
    for size in SIZES:
        yield _steps("SB3 VecEnv, frame_skip 1", Sb3(size), 10)


def _steps(name: str, case: Agents | Vector | Sb3, asked: float | None) -> Figure:
    what = f"agent steps/s, {name}, {case.num_envs:,} environments"
    return rate(what, case, asked if case.num_envs >= MEDIUM else None)


def calls() -> Iterator[Figure]:
    """How long one call takes."""
    for size in (64, MEDIUM):
        what = f"SB3 VecEnv over the same step from Rust, {size:,} environments"
        yield beside(what, Sb3(size), Agents(size), per_unit=False)
    for frame_skip, vector, single in ((1, 10.0, 12.0), (4, None, None)):
        skip = f"frame_skip {frame_skip}"
        yield call(f"64 environments, VectorEnv.step, {skip}", Vector(64, frame_skip), vector)
        yield call(f"one environment, gymnasium.make, step, {skip}", Single(frame_skip), single)
    for size in (64, MEDIUM):
        what = f"observation_fn and reward_fn over the same step without, {size:,} environments"
        yield beside(what, Vector(size, replaced=True), Vector(size), per_unit=False)
    endless = Agents(MEDIUM, threads=1, time_limit=ENDLESS, autoreset="same_step")
    what = "end and reset of one environment in a step of 4,096, Rust"
    yield beside(what, replace(endless, time_limit=ENDED), endless, per_unit=True, asked=2)
    for size in (64, MEDIUM):
        yield call(f"reset(mask of one of {size:,}), Rust", Resets(size), 2)
        yield call(f"reset(mask of one of {size:,}), VectorEnv", Resets(size, gymnasium=True))


def ratios() -> Iterator[Figure]:
    """One case over another."""
    for size in (MEDIUM, LARGE):
        alone, both = Players(size, 1), Players(size)
        yield ratio(f"second thread, physics, {size:,}", (alone, both), 1.8, at_least=True)
        pair = Agents(size, threads=1), Agents(size)
        yield ratio(f"second thread, full step, {size:,}", pair, 1.8, at_least=True)
    ski = Players(MEDIUM, 1)
    discs = replace(ski, scene="disc_jump"), ski
    yield ratio("disc-jump scene over ski scene, per tick", discs, 1.6, at_least=False)
    bare = Players(MEDIUM, 1, scene="mission", square=FAR)
    built = replace(bare, solids=1000), bare
    yield ratio("1,000 solids far from the players over none", built, 1.05, at_least=False)
    pool = Agents(MEDIUM, terrains=64), Agents(MEDIUM, terrains=1)
    yield ratio("64 terrains over one, full step, 4,096", pool, 1.5, at_least=False)


def stored() -> Iterator[Figure]:
    """Memory, beside observation rows and terrain."""
    terrain = generated(SEED)
    task = SkiOptions(terrains=[terrain]).batch(64, "next_step", 1)
    yield known("bytes per environment of the ski task", task.bytes_per_env, 512)
    for scene in SCENES:
        size = Simulator(terrain, 64, scene=scene, threads=1).player_bytes
        yield known(f"bytes per player, scene {scene}", size, 512 if scene == "ski" else None)
