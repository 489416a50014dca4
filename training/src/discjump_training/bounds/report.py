"""The results of both searches as JSON and Markdown."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from discjump_training import intervals
from discjump_training.bounds.markers import STAGES, Found
from discjump_training.courses.table import row as course_row
from discjump_training.intervals import Estimate
from discjump_training.markdown import cell, table
from discjump_training.policy import Floats, Mask

TITLES = {
    "jets": "jump and jets",
    "lit_after": "disc jump, jets lit with the jump or later",
    "disc": "disc jump",
    "two": "two discs",
}


def apex_tables(rows: Sequence[dict[str, Any]]) -> str:
    """Apexes as Markdown."""
    heads = ["armor", "ticks per decision", *(f"{title}, m" for title in TITLES.values()), "best schedule"]
    lines = []
    for row in rows:
        cells = [f"{row[key]['apex']:.1f}" for key in TITLES]
        lines.append([row["armor"], str(row["ticks"]), *cells, words(row["disc"]["schedule"])])
    text = "# Apex of the feet over the start, from rest on a plane, m\n\n" + table(heads, lines)
    pitches = [str(pitch) for pitch in sorted({int(one) for row in rows for one in row["by_pitch"]})]
    heads, lines = ["armor", "ticks per decision", *(f"{pitch}°" for pitch in pitches)], []
    for row in rows:
        told = {int(pitch): apex for pitch, apex in row["by_pitch"].items()}
        cells = [f"{told[int(p)]:.1f}" if int(p) in told else "" for p in pitches]
        lines.append([row["armor"], str(row["ticks"]), *cells])
    text += "\nThe best by pitch of the view:\n\n" + table(heads, lines)
    shots = sorted({int(shot) for row in rows for shot in row["by_shot"]})
    heads, lines = ["armor", "ticks per decision", *map(str, shots)], []
    for row in rows:
        cells = [f"{row['by_shot'][str(s)]:.1f}" if str(s) in row["by_shot"] else "" for s in shots]
        lines.append([row["armor"], str(row["ticks"]), *cells])
    text += "\nThe best by ticks between the jump and the shot:\n\n" + table(heads, lines)
    text += "\nWhat decisions of two ticks cost, m of the best disc jump: "
    return text + ", ".join(f"{armor} {cost:.1f}" for armor, cost in costs(rows).items()) + ".\n"


def costs(rows: Sequence[dict[str, Any]]) -> dict[str, float]:
    """How much lower the best disc jump is at decisions of two ticks, m, by armor."""
    found = {(row["armor"], row["ticks"]): float(row["disc"]["apex"]) for row in rows}
    armors = dict.fromkeys(armor for armor, _ in found)
    return {armor: round(found[armor, 1] - found[armor, 2], 3) for armor in armors if (armor, 2) in found}


def words(schedule: dict[str, Any]) -> str:
    """A schedule in words: decisions after the jump."""
    gap = "" if schedule["off"] is None else f", off {schedule['off']} to {schedule['relit']}"
    return f"jets {schedule['lit']:+d}{gap}, shot {schedule['shot']:+d}, {schedule['pitch']:.0f}°"


def marker_figures(found: Sequence[Found], jumper: Mask, jumper_seconds: Floats) -> dict[str, Any]:
    """Shares of markers reached, in all and by band of their height, for JSON.

    Args:
        found: by the search, in the order of the course.
        jumper: whom the scripted jumper reached, (n,).
        jumper_seconds: when, (n,).
    """
    reached = np.array([one.stage is not None for one in found])
    seconds = np.array([np.nan if one.seconds is None else one.seconds for one in found])
    heights = np.array([one.marker_height for one in found])
    either = reached & jumper
    band = course_row("disc-jump").band
    assert band is not None
    which = band.which(heights)
    bands = [
        {
            "low": band.edges[index],
            "high": band.edges[index + 1],
            "episodes": int((which == index).sum()),
            "search": intervals.proportion(reached[which == index]).as_dict(),
            "jumper": intervals.proportion(jumper[which == index]).as_dict(),
        }
        for index in range(len(band.edges) - 1)
        if (which == index).any()
    ]
    return {
        "episodes": len(found),
        "search": intervals.proportion(reached).as_dict(),
        "jumper": intervals.proportion(jumper).as_dict(),
        "jumper_of_reachable": intervals.proportion(jumper[reached]).as_dict() if reached.any() else None,
        "jumper_only": np.flatnonzero(jumper & ~reached).tolist(),
        "not_reached": np.flatnonzero(~reached).tolist(),
        "seconds": intervals.mean(seconds[reached]).as_dict() if reached.any() else None,
        "seconds_where_both": {
            "episodes": int(either.sum()),
            "search": float(seconds[either].mean()) if either.any() else None,
            "jumper": float(jumper_seconds[either].mean()) if either.any() else None,
        },
        "stages": {stage: sum(one.stage == stage for one in found) for stage in STAGES},
        "schedules": int(sum(one.schedules for one in found)),
        "bands": bands,
    }


def marker_tables(told: dict[str, Any], course: str) -> str:
    """The same as Markdown."""
    bands = told["bands"]
    heads = ["", "all", *(f"{one['low']:g} to {one['high']:g} m" for one in bands)]
    lines = [["episodes", str(told["episodes"]), *(str(one["episodes"]) for one in bands)]]
    for key, title in (("search", "exhaustive search"), ("jumper", "scripted jumper")):
        lines.append([title, *(cell(Estimate(**one[key]), "%", 1) for one in (told, *bands))])
    text = f"# Markers reached, %, by height over the start\n\n{table(heads, lines)}\n"
    missed = ", ".join(map(str, told["not_reached"])) or "none"
    share = told["jumper_of_reachable"]
    of_reachable = "" if share is None else cell(Estimate(**share), "%", 1)
    both = told["seconds_where_both"]
    text += (
        f"{course}: its first {told['episodes']} episodes; in brackets exact 95% intervals. Of the markers "
        f"that the search reaches the jumper reaches {of_reachable} %. Where both do, the search "
        f"needs {both['search']:.2f} s and the jumper {both['jumper']:.2f} s on average (the search looks "
        "for the soonest only within the first stage that succeeds). Not reached by the search, episodes: "
        f"{missed}; of these by the jumper: {', '.join(map(str, told['jumper_only'])) or 'none'}.\n\n"
    )
    stages = ", ".join(f"{stage} {count}" for stage, count in told["stages"].items())
    return text + f"Stages that succeeded: {stages}. Schedules played: {told['schedules']:,}.\n"
