"""The picture of an evaluation: command maps with the paths of a few episodes, and the learning curve."""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LightSource, Normalize
from matplotlib.figure import Figure

from discjump import Terrain
from discjump_training import curves as learning
from discjump_training.curves import Curves
from discjump_training.judge.conditions import Conditions
from discjump_training.judge.judged import Judged
from discjump_training.policy import Floats

#: Top of the colour scale of speed, m/s.
TOP_SPEED = 50.0
#: Metres shown around the paths.
MARGIN = 80.0

SPEEDS = Normalize(0.0, TOP_SPEED)
COLOURS = "plasma"
#: Rims of the paths, by policy: the inside shows the speed.
_RIMS = ("black", "deepskyblue", "limegreen", "white")


def draw(
    path: Path,
    conditions: Conditions,
    judged: list[Judged],
    curves: Curves | None,
) -> None:
    """Draw the picture.

    Args:
        path: PNG to write.
        conditions: of the evaluation.
        judged: policies with recorded paths, the models first.
        curves: learning curves of the models, where there are any.
    """
    episodes = sorted(judged[0].episodes.paths)
    columns = max(len(episodes), 1)
    figure = Figure(figsize=(4.6 * columns, 8.6 if curves else 5.0), layout="constrained")
    grid = figure.add_gridspec(2 if curves else 1, columns, height_ratios=[5, 3] if curves else [1])
    maps = [figure.add_subplot(grid[0, column]) for column in range(len(episodes))]
    for axes, episode in zip(maps, episodes, strict=True):
        command_map(axes, conditions, judged, episode)
    if maps:
        colours = matplotlib.cm.ScalarMappable(SPEEDS, COLOURS)
        figure.colorbar(colours, ax=maps, label="speed, m/s", location="right", fraction=0.02, pad=0.01)
    if curves:
        learning.draw(figure.add_subplot(grid[1, :]), curves)
    figure.savefig(path, dpi=110)


def command_map(axes: Axes, conditions: Conditions, judged: list[Judged], episode: int) -> None:
    """One episode from above: hillshade, contours, start, goal and everybody's path coloured by speed."""
    first = judged[0].episodes
    goal = first.goals[episode]
    seen = np.concatenate([one.episodes.paths[episode][:, :2] for one in judged] + [goal[None, :2]])
    low, high = seen.min(axis=0), seen.max(axis=0)
    side = (high - low).max() + 2.0 * MARGIN
    corner = (low + high) / 2.0 - side / 2.0
    index = int(first.terrain[episode])
    ground(axes, conditions.terrains()[index], corner, side)

    # The first policy is drawn last, on top of the others.
    for one, rim in reversed(list(zip(judged, _RIMS, strict=False))):
        path = one.episodes.paths[episode]
        points = path[:, :2]
        axes.plot(*points.T, color=rim, linewidth=4.5, solid_capstyle="round", label=one.name)
        segments = np.stack([points[:-1], points[1:]], axis=1)
        lines = LineCollection(list(segments), cmap=COLOURS, norm=SPEEDS, linewidth=2.4, zorder=2.0)
        lines.set_array(path[1:, 3])
        axes.add_collection(lines)
    start = first.paths[episode][0, :2]
    axes.plot(*start, "o", color="white", markeredgecolor="black", label="start")
    radius = float(conditions.changes.get("arrival_radius", conditions.task.options.arrival_radius))
    axes.add_patch(matplotlib.patches.Circle(tuple(goal[:2]), radius, fill=False, color="red", linewidth=1.5))
    axes.plot(*goal[:2], "*", color="red", markeredgecolor="black", markersize=12, label=conditions.task.goal)
    times = "\n".join(
        f"{one.name}: "
        + (f"{one.episodes.seconds[episode]:.1f} s" if one.episodes.success[episode] else "never")
        for one in judged
    )
    axes.set_title(
        f"terrain {conditions.terrain_name(index)}, {first.start_distance[episode]:.0f} m\n{times}",
        fontsize=9,
    )
    axes.set_xlabel("east, m")
    axes.tick_params(labelsize=7)
    if episode == 0:
        axes.set_ylabel("north, m")
        axes.legend(loc="lower left", fontsize=7)


def ground(axes: Axes, terrain: Terrain, corner: Floats, side: float, pixels: int = 300) -> None:
    """Hillshade and contours of a square of terrain."""
    along = np.linspace(0.0, side, pixels)
    x, y = np.meshgrid(corner[0] + along, corner[1] + along)
    heights = terrain.height(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    step = side / (pixels - 1)
    shade = LightSource(azdeg=315, altdeg=45).hillshade(heights, dx=step, dy=step)
    extent = (corner[0], corner[0] + side, corner[1], corner[1] + side)
    axes.imshow(shade, cmap="gray", extent=extent, origin="lower", vmin=-0.3, vmax=1.1)
    levels = np.arange(np.floor(heights.min() / 10.0) * 10.0, heights.max() + 10.0, 10.0)
    axes.contour(x, y, heights, levels=levels, colors="saddlebrown", linewidths=0.4, alpha=0.7)
    axes.set_xlim(extent[0], extent[1])
    axes.set_ylim(extent[2], extent[3])
    axes.set_aspect("equal")
