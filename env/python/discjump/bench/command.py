"""The command `discjump bench`."""

import os
from pathlib import Path
from typing import Any

import click

from discjump._options import FiniteRange
from discjump._results import machine, require_matplotlib, save, versions
from discjump.bench import copies, figure, figures, parts, peers, ppo, scenes
from discjump.bench.clock import Case, Effort, Timed, interleave, spread
from discjump.bench.ways import Agents, Players, Sb3, Single, Vector

QUICK = Effort(3, 0.01, quick=True)


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
@click.option("--frame-skip", type=click.IntRange(1, 64), default=4, show_default=True, help="Ticks a step.")
@click.option(
    "--figures", "asked", is_flag=True, help="All figures that are asked for, beside what is asked."
)
@click.option("--training", is_flag=True, help="With --figures: the environment's share of PPO too.")
@click.option(
    "--scenes", "by_scene", is_flag=True, help="What scenes and tiers model, store and cost, without a task."
)
@click.option(
    "--copies", "copied", is_flag=True, help="Snapshots, copies, two threads, the answer to Ctrl-C."
)
@click.option("--peers", "beside", is_flag=True, help="gymnasium's CartPole and EnvPool in the same run.")
@click.option(
    "--picture",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Draw where the time of a step goes, by batch size (PNG).",
)
@click.option("--repeats", type=click.IntRange(3, 1000), default=9, show_default=True, help="Timed repeats.")
@click.option(
    "--seconds",
    type=FiniteRange(0.001, 60),
    default=0.25,
    show_default=True,
    help="Length of a repeat of one case, s.",
)
@click.option("--quick", is_flag=True, help="3 repeats of 0.01 s: whether it runs, not how fast.")
@click.option(
    "--threads",
    type=click.IntRange(1, 256),
    help="Threads, one per core if absent; --figures uses two, --scenes and --picture one.",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("runs/bench.json"),
    show_default=True,
    help="Where the figures go (JSON).",
)
def bench(
    sizes: tuple[int, ...],
    frame_skip: int,
    asked: bool,
    training: bool,
    by_scene: bool,
    copied: bool,
    beside: bool,
    picture: Path | None,
    repeats: int,
    seconds: float,
    quick: bool,
    threads: int | None,
    out: Path,
) -> None:
    """How fast the ski environment steps: random actions, full observation, autoreset.

    By default through each way in, by batch size. An agent step is one decision of one environment, which is
    --frame-skip physics ticks of 32 ms; physics alone is counted in player-ticks. All cases take turns within
    a repeat, so that a busy machine slows them alike: trust ratios of one run. Tables show medians and
    quartiles over the repeats; the JSON has every repeat.

    --figures, --scenes, --copies, --peers and --picture choose what is measured instead, and can be combined.

    --scenes also counts instructions where valgrind is installed: they do not depend on what else runs.

    --peers compares what differs: CartPole is a handful of multiplications with 4 observations, HalfCheetah
    a rigid-body simulation with 17 and 5 ticks a step, ours skis over terrain with 37 and, in the ratios, 1
    tick. They say what order of magnitude a user gets, not who is better at the same work.
    """
    if training and not asked:
        raise click.UsageError("--training goes with --figures")
    if picture is not None:
        require_matplotlib("discjump bench --picture")
    threads = threads or min(os.cpu_count() or 1, 256)
    load = round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None
    effort = QUICK if quick else Effort(repeats, seconds)
    made: dict[str, Any] = {}
    if asked:
        made["figures"] = figures.measure(effort)
        if training:
            made["figures"].append(ppo.measure())
        click.echo(figure.table(made["figures"]))
    if by_scene:
        made["players"], made["rows"] = scenes.PLAYERS, scenes.measure(effort)
        click.echo(f"{scenes.lists()}\n\n{scenes.table(made['rows'])}")
    if copied:
        made["copies"] = copies.measure(effort)
        click.echo(figure.table(made["copies"]))
    if beside:
        made["peers"] = peers.measure(effort, threads)
        click.echo(peers.table(made["peers"]))
    if picture is not None:
        made["parts"] = parts.measure(effort)
        parts.draw(made["parts"], picture)
        click.echo(parts.table(made["parts"]))
    if not made:
        made = {"frame_skip": frame_skip, "rows": _by_size(sizes, frame_skip, threads, effort)}
        click.echo(table(made["rows"], frame_skip))
    here = {**machine(), "threads": threads, "lanes": _lanes(), "load": load}
    packages = versions("discjump", "numpy", "gymnasium", "stable-baselines3", "envpool", "torch")
    save(out, {"machine": here, "versions": packages, "effort": effort._asdict(), **made})
    click.echo(
        f"{here['processor']}, {here['cores']} cores, {threads} threads, lanes {here['lanes']}, "
        f"load when it began {load}"
    )
    click.echo("\n".join(str(path) for path in (out, picture) if path is not None))


def _by_size(sizes: tuple[int, ...], frame_skip: int, threads: int, effort: Effort) -> list[dict[str, Any]]:
    rows = []
    for size in sizes:
        ways: dict[str, Case] = {
            "Rust": Agents(size, frame_skip, threads),
            "make_vec": Vector(size, frame_skip, threads),
            "sb3": Sb3(size, frame_skip, threads),
        }
        if size == 1:
            ways["make"] = Single(frame_skip)
        times = interleave(ways.values(), effort, f"{size:>6} environments")
        for name, case in ways.items():
            timed = times[case]
            if not isinstance(timed, Timed):
                click.echo(f"{name}: {timed}", err=True)
                continue
            middle = spread(timed.rate)
            quartiles = [middle.low, middle.high]
            row = {"num_envs": size, "way": name, "median": middle.median, "quartiles": quartiles}
            rows.append({**row, "rates": timed.rate.tolist()})
    return rows


def table(rows: list[dict[str, Any]], frame_skip: int) -> str:
    """The rates as Markdown: agent steps, and the physics ticks in them.

    >>> print(table([{"num_envs": 64, "way": "make_vec", "median": 5e5, "quartiles": [4e5, 6e5]}], 4))
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
            f"| {frame_skip * median:,.0f} | {row['num_envs'] / median * 1e6:,.1f} |"
        )
    return "\n".join(lines)


def _lanes() -> dict[str, int]:
    """How many players are side by side where there are many."""
    return {"players": Players(64, 1).make().lanes, "environments": Agents(64, threads=1).make().lanes}
