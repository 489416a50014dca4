"""Charts of the page: scores, learning curves, and the profiles of an episode."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from discjump import Terrain
from discjump_training import curves as learning
from discjump_training.curves import Curves
from discjump_training.judge.evaluation import Evaluation
from discjump_training.judge.judged import Judged
from discjump_training.judge.page.embed import Markup, svg
from discjump_training.policy import Floats

#: Told apart by people who see few colours, too (Okabe and Ito); in the order of the table.
PALETTE = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8c564b", "#555555")


def colour(judged: Sequence[Judged], name: str) -> str:
    """A policy's colour throughout the page."""
    return PALETTE[[one.name for one in judged].index(name) % len(PALETTE)]


def scores(made: Evaluation) -> Markup:
    """Which share of the episodes each policy finished within which time."""
    figure = Figure(figsize=(5.6, 3.0), layout="constrained")
    axes = figure.add_subplot()
    drawn = [one for one in made.judged if one.name != "random"] or made.judged
    limit = made.conditions.time_limit
    longest = 0.0
    for one in drawn:
        times = np.sort(one.table("seconds")[one.success])
        shares = np.arange(1, len(times) + 1) / one.success.size
        longest = max(longest, float(times[-1]) if len(times) else limit)
        end = np.append(times, limit), np.append(shares, shares[-1] if len(shares) else 0.0)
        # More points than the chart has pixels only make the page larger.
        kept = np.unique(np.linspace(0, len(end[0]) - 1, min(len(end[0]), 300)).astype(int))
        axes.step(
            end[0][kept], 100 * end[1][kept], where="post", color=colour(drawn, one.name), label=one.name
        )
    axes.set_xlim(0, min(limit, 1.08 * longest))
    axes.set_ylim(0, 101)
    axes.set_xlabel(f"time to {made.conditions.task.goal}, s")
    axes.set_ylabel("episodes finished by then, %")
    finished(axes)
    axes.legend(fontsize=8, loc="upper left", frameon=False)
    return svg(figure, "Share of episodes finished within a time, by policy")


def curve(curves: Curves) -> Markup:
    """Learning curves of the runs that were judged."""
    figure = Figure(figsize=(5.6, 3.0), layout="constrained")
    axes = figure.add_subplot()
    learning.draw(axes, curves)
    axes.set_ylabel(curves.title, fontsize=8)
    finished(axes)
    return svg(figure, "Learning curves")


def profiles(made: Evaluation, drawn: list[Judged], row: int, terrain: Terrain) -> Markup:
    """Speed and energy over time, and height along the route with the ground under it, of one episode."""
    figure = Figure(figsize=(5.4, 2.9 + 0.95 * len(drawn)), layout="constrained")
    ratios = [1.3, 1.0, *[1.0] * len(drawn)]
    grid = figure.add_gridspec(len(ratios), 1, height_ratios=ratios)
    speed = figure.add_subplot(grid[0])
    energy = figure.add_subplot(grid[1], sharex=speed)
    heights = [figure.add_subplot(grid[2 + index]) for index in range(len(drawn))]
    for one, axes in zip(drawn, heights, strict=True):
        path, tint = one.episodes.paths[row], colour(drawn, one.name)
        period = made.conditions.task.options().tick_ms * one.frame_skip / 1000
        time = np.minimum(np.arange(len(path)) * period, one.episodes.time[row])
        speed.plot(time, path[:, 3], color=tint, linewidth=1.3, label=one.name)
        energy.plot(time, path[:, 4], color=tint, linewidth=1.3)
        along(axes, path, terrain, tint, one.name)
    speed.set_ylabel("speed, m/s", fontsize=8)
    speed.set_ylim(bottom=0)
    speed.tick_params(labelbottom=False)
    energy.set_ylabel("energy", fontsize=8)
    energy.set_ylim(bottom=0)
    energy.set_xlabel("time, s", fontsize=8)
    heights[-1].set_xlabel("way along the route, m", fontsize=8)
    widest = max(axes.get_xlim()[1] for axes in heights)
    for axes in heights:
        axes.set_xlim(0, widest)
    for axes in (speed, energy, *heights):
        finished(axes)
    return svg(figure, f"Speed, energy and height profiles of episode {row}")


def along(axes: Axes, path: Floats, terrain: Terrain, tint: str, name: str) -> None:
    """Height of a player along the way, over the ground below."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1))])
    ground = terrain.height(path[:, :2])
    floor = min(float(ground.min()), float(path[:, 2].min())) - 3.0
    axes.fill_between(way, ground, floor, color="#b8a888", linewidth=0)
    axes.plot(way, ground, color="#7a6a4f", linewidth=0.8)
    axes.plot(way, path[:, 2], color=tint, linewidth=1.3)
    axes.set_ylabel("height, m", fontsize=8)
    axes.set_title(name, fontsize=8, loc="left", pad=2)
    axes.set_ylim(bottom=floor)


def finished(axes: Axes) -> None:
    """What all charts look like."""
    axes.grid(alpha=0.25)
    axes.tick_params(labelsize=8)
    axes.xaxis.label.set_fontsize(8)
    axes.yaxis.label.set_fontsize(8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
