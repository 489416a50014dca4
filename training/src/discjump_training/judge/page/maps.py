"""Command maps with the paths of all policies, coloured by speed."""

import matplotlib
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from discjump import Terrain
from discjump.envs import relief
from discjump_training import picture
from discjump_training.judge.judged import Judged
from discjump_training.judge.page import charts
from discjump_training.judge.page.embed import Markup
from discjump_training.judge.page.embed import picture as embedded

#: Metres shown around the paths.
MARGIN = 35.0
#: Of the ground, along a side.
PIXELS = 520


def command_map(terrain: Terrain, drawn: list[Judged], row: int, arrival_radius: float) -> Markup:
    """One episode from above: relief, contours every 10 m, start, goal, and everybody's path: its inside
    coloured by speed, its rim by policy.
    """
    figure = Figure(figsize=(6.0, 5.2), layout="constrained")
    axes = figure.add_subplot()
    first = drawn[0].episodes
    goal = first.goals[row]
    seen = np.concatenate([one.episodes.paths[row][:, :2] for one in drawn] + [goal[None, :2]])
    low, high = seen.min(axis=0), seen.max(axis=0)
    side = float((high - low).max() + 2.0 * MARGIN)
    west, south = ((low + high) / 2.0 - side / 2.0).tolist()
    ground = relief.shaded(terrain, west, south, side, PIXELS) / 255.0
    axes.imshow(
        np.clip(ground, 0.0, 1.0), extent=(west, west + side, south, south + side), interpolation="none"
    )
    for one in reversed(drawn):
        path = one.episodes.paths[row]
        points = path[:, :2]
        axes.plot(*points.T, color=charts.colour(drawn, one.name), linewidth=5.5, solid_capstyle="round")
        lines = LineCollection(
            list(np.stack([points[:-1], points[1:]], axis=1)),
            cmap=picture.COLOURS,
            norm=picture.SPEEDS,
            linewidth=2.6,
        )
        lines.set_array(path[1:, 3])
        lines.set_zorder(2.5)
        axes.add_collection(lines)
    start = first.paths[row][0, :2]
    axes.plot(*start, "o", color="white", markeredgecolor="black", markersize=8, zorder=3)
    axes.annotate("start", (start[0], start[1]), xytext=(6, 6), textcoords="offset points", fontsize=8)
    axes.add_patch(
        matplotlib.patches.Circle(tuple(goal[:2]), arrival_radius, fill=False, color="#c1121f", linewidth=1.6)
    )
    axes.plot(*goal[:2], "*", color="#c1121f", markeredgecolor="black", markersize=13, zorder=3)
    axes.set_xlabel("east, m", fontsize=8)
    axes.set_ylabel("north, m", fontsize=8)
    axes.tick_params(labelsize=7)
    colours = matplotlib.cm.ScalarMappable(picture.SPEEDS, picture.COLOURS)
    bar = figure.colorbar(colours, ax=axes, fraction=0.04, pad=0.02)
    bar.set_label("speed, m/s", fontsize=8)
    bar.ax.tick_params(labelsize=7)
    return embedded(figure, f"Command map of episode {row}: paths coloured by speed")
