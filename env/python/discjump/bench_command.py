"""`discjump bench`: agent steps a second through each way in, by batch size."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump import bench_scenes
from discjump._results import machine, save

ENV_ID = "discjump/Ski-v0"
Step = Callable[[NDArray[Any]], object]


@click.command()
@click.option(
    "--num-envs",
    "sizes",
    type=click.IntRange(1, 2**20),
    multiple=True,
    default=(1, 64, 1024, 4096),
    show_default=True,
    help="Environments in a batch; may be given several times.",
)
@click.option("--repeats", type=click.IntRange(3, 1000), default=9, show_default=True, help="Timed repeats.")
@click.option(
    "--seconds",
    type=click.FloatRange(0.01, 60),
    default=0.25,
    show_default=True,
    help="Length of a repeat, s.",
)
@click.option("--scenes", is_flag=True, help="What scenes and tiers cost, without a task, instead.")
@click.option("--quick", is_flag=True, help="3 repeats of 0.05 s: whether it runs, not how fast.")
@click.option("--threads", type=click.IntRange(1, 256), help="Simulator threads; one per core if absent.")
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("runs/bench.json"),
    show_default=True,
    help="Where the figures go (JSON).",
)
def bench(
    sizes: tuple[int, ...],
    repeats: int,
    seconds: float,
    scenes: bool,
    quick: bool,
    threads: int | None,
    out: Path,
) -> None:
    """Agent steps per second of the ski environment, random actions, full observation, autoreset.

    An agent step is one decision of one environment: 4 physics ticks of 32 ms. The ways in take turns within
    a repeat, so that a busy machine slows them alike; medians and quartiles over the repeats.

    With --scenes: what each scene models and stores, nanoseconds per player-tick for every scene and tier
    on one thread, 1,024 players, and what solids add.
    """
    if quick:
        repeats, seconds = 3, 0.05
    if scenes:
        _scenes(repeats, out)
        return
    rows = []
    for size in sizes:
        ways = _ways(size, threads)
        taken: dict[str, list[float]] = {name: [] for name in ways}
        actions = _actions(size)
        with click.progressbar(range(repeats), label=f"{size:>6} environments") as bar:
            for _ in bar:
                for name, step in ways.items():
                    taken[name].append(_rate(step, actions, size, seconds))
        for name, rates in taken.items():
            low, median, high = np.quantile(rates, [0.25, 0.5, 0.75])
            rows.append(
                {"num_envs": size, "way": name, "median": median, "quartiles": [low, high], "rates": rates}
            )
    click.echo(table(rows))
    save(out, {"machine": {**machine(), "threads": threads}, "frame_skip": 4, "rows": rows})
    click.echo(str(out))


def _scenes(repeats: int, out: Path) -> None:
    rows = bench_scenes.measure(repeats)
    click.echo(bench_scenes.lists())
    click.echo()
    click.echo(bench_scenes.table(rows))
    save(out, {"machine": {**machine(), "threads": 1}, "players": bench_scenes.PLAYERS, "rows": rows})
    click.echo(str(out))


def table(rows: list[dict[str, Any]]) -> str:
    """The rates as Markdown: agent steps, and the physics ticks in them.

    >>> print(table([{"num_envs": 64, "way": "make_vec", "median": 5e5, "quartiles": [4e5, 6e5]}]))
    | environments | way in | agent steps/s (median, quartiles) | player-ticks/s | microseconds per call |
    |---|---|---|---|---|
    | 64 | make_vec | 500,000 (400,000 .. 600,000) | 2,000,000 | 128.0 |
    """
    lines = [
        "| environments | way in | agent steps/s (median, quartiles) | player-ticks/s "
        "| microseconds per call |",
        "|---|---|---|---|---|",
    ]
    for row in rows:
        low, high = row["quartiles"]
        median = row["median"]
        lines.append(
            f"| {row['num_envs']:,} | {row['way']} | {median:,.0f} ({low:,.0f} .. {high:,.0f}) "
            f"| {4 * median:,.0f} | {row['num_envs'] / median * 1e6:,.1f} |"
        )
    return "\n".join(lines)


def _ways(size: int, threads: int | None) -> dict[str, Step]:
    """A step function for each way in, reset and ready."""
    ways: dict[str, Step] = {}
    if size == 1:
        env = gymnasium.make(ENV_ID)
        env.reset(seed=0)

        def single(actions: NDArray[Any]) -> None:
            *_, terminated, truncated, _ = env.step(actions[0])
            if terminated or truncated:
                env.reset()

        ways["make"] = single
    vector = gymnasium.make_vec(ENV_ID, num_envs=size, threads=threads)
    vector.reset(seed=0)
    ways["make_vec"] = vector.step
    try:
        from discjump.sb3 import make_vec_env
    except ImportError:
        return ways
    adapter = make_vec_env(ENV_ID, n_envs=size, seed=0, threads=threads)
    adapter.reset()
    ways["sb3"] = adapter.step
    return ways


def _actions(size: int) -> list[NDArray[Any]]:
    """Random actions, drawn beforehand: drawing them is no part of a step."""
    generator = np.random.default_rng(0)
    return [generator.integers(0, [3, 3, 2, 2, 7], (size, 5)) for _ in range(32)]


def _rate(step: Step, actions: list[NDArray[Any]], size: int, seconds: float) -> float:
    calls = 0
    begin = time.perf_counter()
    while (elapsed := time.perf_counter() - begin) < seconds:
        step(actions[calls % len(actions)])
        calls += 1
    return calls * size / elapsed
