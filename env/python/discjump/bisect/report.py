"""What `discjump bisect` prints and writes."""

from typing import Any

import numpy as np

from discjump._text import described, shown
from discjump.bisect.lockstep import Outcome, Parting
from discjump.bisect.sides import Side
from discjump.bisect.start import inputs_of
from discjump.replays import EpisodeReplay, Replay

Contacts = tuple[list[str], list[str]]
"""The contact lists of A and B, a line for each contact."""


def seconds(replay: Replay, tick: int) -> float:
    """Time after so many ticks, s."""
    return float(tick * replay.options["tick_ms"] / 1000)


def text(sides: tuple[Side, Side], outcome: Outcome, contacts: Contacts) -> str:
    """The report.

    Args:
        sides: A and B.
        outcome: what came of running them.
        contacts: the contact list of the tick on each side.
    """
    lines = []
    for name, side, found in zip("AB", sides, outcome.installations, strict=True):
        lines.append(f"{name}  {side.text}: discjump {found['discjump']}, {found['where']}")
    replay, parting = sides[0].replay, outcome.parting
    if parting is None:
        lines.append(f"the same in every bit: {outcome.ticks} ticks, {seconds(replay, outcome.ticks):.3f} s")
        return "\n".join(lines)
    lines += ["", headline(replay, parting), ""]
    lines += [f"  {name:<12}{value}" for name, value in facts(replay, parting).items()]
    if contacts[0] == contacts[1]:
        lines += listed("contacts", contacts[0])
    else:
        lines += [*listed("contacts A", contacts[0]), *listed("contacts B", contacts[1])]
    if parting.others:
        lines += ["", f"  also apart: {', '.join(parting.others)}"]
    return "\n".join([*lines, "", *table(parting)])


def listed(name: str, rows: list[str]) -> list[str]:
    """Lines under one name."""
    return [f"  {name if k == 0 else '':<12}{row}" for k, row in enumerate(rows)]


def headline(replay: Replay, parting: Parting) -> str:
    """Where they part, in a line."""
    environment = "environment" if isinstance(replay, EpisodeReplay) else "player"
    where = f"{environment} {parting.difference.row}"
    if parting.tick == 0:
        return f"apart from the beginning, {where}"
    decision = ""
    if isinstance(replay, EpisodeReplay):
        decision = f", decision {-(-parting.tick // replay.options['frame_skip'])}"
    return f"apart after tick {parting.tick} ({seconds(replay, parting.tick):.3f} s{decision}), {where}"


def facts(replay: Replay, parting: Parting) -> dict[str, str]:
    """The first difference, and the inputs of the tick."""
    found = parting.difference
    made = {"field": found.field, "A": shown(found.a), "B": shown(found.b)}
    if found.metres is not None:
        made["apart"] = f"{found.metres:.6g} m"
    elif found.ulps is not None:
        zero = " (less than one, or the sign of zero)" if found.ulps == 0 else ""
        size = abs(float(found.a) - float(found.b))
        made["apart"] = f"{found.ulps:,} ULP of {found.counted}{zero}, {size:.3g}"
    made["inputs"] = keys(replay, parting)
    return made


def keys(replay: Replay, parting: Parting) -> str:
    """The inputs of the tick, on both sides where they differ."""
    told = []
    for frame in parting.after:
        if "action" in frame.values:
            rate = replay.options["turn_rate"]
            rows = inputs_of(frame.values["action"][np.newaxis], rate, np.dtype(np.float64))
            told.append(described(rows[0]))
        elif "inputs" in frame.values:
            told.append(described(frame.values["inputs"][parting.difference.row]))
        else:
            told.append("none: it is the beginning")
    return told[0] if told[0] == told[1] else f"A: {told[0]}; B: {told[1]}"


def table(parting: Parting) -> list[str]:
    """The player's fields: before the tick, and after it on both sides; what is equal is said once."""
    row = parting.difference.row
    frames = [*(() if parting.before is None else parting.before[:1]), *parting.after]
    labels = ["before"] * (len(frames) - 2) + ["A", "B"]
    states = [frame.values["state"][row] for frame in frames]
    lines = []
    for name in states[0].dtype.names or ():
        values = [shown(state[name]) if name in (state.dtype.names or ()) else "absent" for state in states]
        told: dict[str, list[str]] = {}
        for label, value in zip(labels, values, strict=True):
            told.setdefault(value, []).append(label)
        lines += [
            f"  {name if k == 0 else '':<12}{', '.join(who):<14}{value}"
            for k, (value, who) in enumerate(told.items())
        ]
    return lines


def as_json(sides: tuple[Side, Side], outcome: Outcome, contacts: Contacts) -> dict[str, Any]:
    """The same for machines."""
    parting = outcome.parting
    made: dict[str, Any] = {
        "schema_version": 1,
        "sides": [side.text for side in sides],
        "installations": list(outcome.installations),
        "ticks_compared": outcome.ticks,
        "same": parting is None,
    }
    if parting is not None:
        found = parting.difference
        made |= {
            "tick": parting.tick,
            "row": found.row,
            "field": found.field,
            "a": shown(found.a),
            "b": shown(found.b),
            "ulps": found.ulps,
            "metres": found.metres,
            "inputs": keys(sides[0].replay, parting),
            "contacts": list(contacts),
            "others": list(parting.others),
        }
    return made
