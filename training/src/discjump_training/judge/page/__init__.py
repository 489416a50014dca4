"""The HTML report of an evaluation: one file that needs no other and no network.

charts    figures of scores and of single episodes, as SVG
maps      command maps with paths coloured by speed, as WebP
embed     how both become part of the page
page.html the template
"""

from importlib import resources
from typing import Any

import jinja2

import discjump
from discjump_training.curves import Curves
from discjump_training.judge import tables
from discjump_training.judge.evaluation import Evaluation
from discjump_training.judge.failures import MEANING, Failure
from discjump_training.judge.judged import Judged
from discjump_training.judge.page import charts, maps
from discjump_training.judge.page.embed import Markup

#: Failures that are listed of each policy; all of them are in evaluation.json.
LISTED = 12


def render(made: Evaluation, curves: Curves | None = None) -> str:
    """The report.

    Args:
        made: the evaluation.
        curves: learning curves of the models, where there are any.

    Returns:
        HTML.
    """
    drawn = [one for one in made.judged if one.name != "random"] or made.judged
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    text = resources.files(__package__).joinpath("page.html").read_text(encoding="utf-8")
    names = ", ".join(one.name for one in made.judged if one.is_model) or "baselines"
    return environment.from_string(text).render(
        title=f"{made.conditions.task.name}: {names}",
        partial=made.partial,
        caption=tables.caption(made),
        policies=tables.policies(made),
        comparisons=tables.comparisons(made.comparisons) if made.comparisons else None,
        bands=tables.bands(made),
        causes=tables.causes(made),
        meaning=MEANING,
        failures=_listed(made),
        scores=charts.scores(made),
        curve=charts.curve(curves) if curves else None,
        episodes=[_episode(made, drawn, row) for row in _rows(drawn)],
        colours=[{"name": one.name, "colour": charts.colour(drawn, one.name)} for one in drawn],
        release=discjump.__version__,
        digest=made.conditions.course.digest(),
    )


def _rows(drawn: list[Judged]) -> list[int]:
    """Episodes whose paths all of them have."""
    return sorted(set.intersection(*(set(one.episodes.paths) for one in drawn)))


def _episode(made: Evaluation, drawn: list[Judged], row: int) -> dict[str, Any]:
    """One episode: its map and its profiles."""
    conditions, first = made.conditions, drawn[0].episodes
    index = int(first.terrain[row])
    terrain = conditions.terrains()[index]
    ends = []
    for one in drawn:
        played = one.episodes
        how = "died after" if played.death[row] else "gave up after"
        word = "arrived after" if played.success[row] else how
        ends.append(
            {
                "name": one.name,
                "colour": charts.colour(drawn, one.name),
                "told": ("in its first run " if len(one.members) > 1 else "")
                + f"{word} {played.time[row]:.2f} s, top speed {played.top_speed[row]:.1f} m/s",
            }
        )
    radius = float(conditions.changes.get("arrival_radius", conditions.task.options.arrival_radius))
    map_: Markup = maps.command_map(terrain, drawn, row, radius)
    return {
        "row": row,
        "terrain": conditions.terrain_name(index),
        "distance": f"{first.start_distance[row]:.0f}",
        "ends": ends,
        "map": map_,
        "profiles": charts.profiles(made, drawn, row, terrain),
    }


def _listed(made: Evaluation) -> list[dict[str, Any]]:
    """The first failures of each policy."""
    shown: list[dict[str, Any]] = []
    for one, found in zip(made.judged, made.failures, strict=True):
        if found:
            rest = len(found) - LISTED
            shown.append(
                {"policy": one.name, "rows": [_row(each) for each in found[:LISTED]], "rest": max(0, rest)}
            )
    return shown


def _row(failure: Failure) -> dict[str, str]:
    return {
        "member": failure.member,
        "episode": str(failure.episode),
        "terrain": failure.terrain,
        "cause": failure.cause,
        "time": f"{failure.time:.2f}",
        "distance": f"{failure.start_distance:.0f}",
        "replay": "" if failure.replay is None else str(failure.replay),
    }
