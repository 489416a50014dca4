"""How high jump, jets and disc lead at best, by exhaustive search over when each key is pressed.

From rest on a plane, on a full tank, without another key. All combinations are played of

| what | values |
| --- | --- |
| shot, ticks after the jump | -2 to 10 |
| jets lit, ticks after the jump | -8 to 8 |
| jets off again | never; from 0 to 6 ticks after the jump for 2, 4 or 8 ticks |
| pitch, degrees | the five of the discrete action; at decisions of one tick also -85, -80, -75, -70 |

Of two discs (the second can be fired 56 ticks after the first) all combinations are played of the first shot
0 to 6 ticks after the first jump or without one, the second shot up to tick 124, the second jump 0 to 4 ticks
before it, and jets lit with the first jump, or 4 ticks before to 2 after the second one. The view is straight
down for both.

At decisions of `n` ticks everything happens at multiples of `n`, and keys are held so long. Not searched:
walking, turning, other grounds than a plane, more than one gap of the jets.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from discjump_training.bounds.jumps import NEVER, PITCHES, Heights, Jumps, heights

#: Pitches between those of the discrete action, rad.
FINE = tuple(np.deg2rad([-85.0, -80.0, -75.0, -70.0]).tolist())
#: Ticks between two discs.
RELOAD = 56


def search(armor: str, ticks: int = 1) -> dict[str, Any]:
    """The best of all schedules.

    Args:
        armor: of the player.
        ticks: of a decision.

    Returns:
        For JSON: each with `apex` (m over the start), `seconds` until it is reached, `damage`, `schedules`
        that were tried and the best `schedule` (decisions after the jump): `jets` (jump and jets alone),
        `disc` (with one disc), `lit_after` (the same where the jets are not lit before the jump), `two`
        (discs); `by_pitch` and `by_shot` are the best apexes with a disc by pitch in degrees and ticks
        between jump and shot.
    """
    lit = steps(-8, 8, ticks)
    alone = Jumps.grid(lit=lit)
    jets = heights(armor, alone, ticks)
    gaps = [(NEVER, NEVER)]
    for begin in steps(0, 6, ticks):
        gaps += [(begin, begin + length) for length in sorted({max(1, n // ticks) for n in (2, 4, 8)})]
    pitches = [*PITCHES.tolist(), *(FINE if ticks == 1 else ())]
    jumps = Jumps.grid(lit, gaps, steps(-2, 10, ticks), pitches)
    one = heights(armor, jumps, ticks)
    pair = two_discs(ticks)
    both = heights(armor, pair, ticks)
    everyone = np.ones(len(jumps), np.bool_)
    return {
        "armor": armor,
        "ticks": ticks,
        "jets": best(alone, jets, np.ones(len(alone), np.bool_)),
        "disc": best(jumps, one, everyone),
        "lit_after": best(jumps, one, jumps.lit >= 0),
        "two": best(pair, both, np.ones(len(pair), np.bool_)),
        "by_pitch": {
            f"{np.rad2deg(pitch):.0f}": round(float(one.apex[jumps.pitch == pitch].max()), 3)
            for pitch in sorted(pitches)
        },
        "by_shot": {
            str(shot * ticks): round(float(one.apex[jumps.shot == shot].max()), 3)
            for shot in steps(-2, 10, ticks)
        },
    }


def two_discs(ticks: int) -> Jumps:
    """The schedules with two discs."""
    least = -(-RELOAD // ticks)
    rows = [
        (lit, shot, second, again, first)
        for first in (0, NEVER)
        for shot in steps(0, 6, ticks)
        for second in range(shot + least, 124 // ticks + 1)
        for again in range(second - 4 // ticks, second + 1)
        for lit in (0, *(again + wait for wait in steps(-4, 2, ticks)))
    ]
    lit, shot, second, again, first = np.array(rows, np.int64).T
    never = np.full(len(rows), NEVER)
    down = np.full(len(rows), PITCHES[0])
    return Jumps(lit, never, never, shot, down, second, again, first)


def steps(low: int, high: int, ticks: int) -> range:
    """Decisions that begin from tick `low` to tick `high`."""
    return range(-(-low // ticks), high // ticks + 1)


def best(jumps: Jumps, reached: Heights, among: Any) -> dict[str, Any]:
    """The highest of those that live, for JSON."""
    apex = np.where(among & reached.alive, reached.apex, -np.inf)
    index = int(apex.argmax())
    return {
        "apex": round(float(apex[index]), 3),
        "seconds": round(float(reached.seconds[index]), 3),
        "damage": round(float(reached.damage[index]), 4),
        "schedules": int(np.count_nonzero(among)),
        "schedule": jumps.row(index),
    }


def markers(rows: Iterable[dict[str, Any]], radius: float) -> dict[str, tuple[float, float]]:
    """Between which heights of a marker a disc jump decides, by armor: what jump and jets reach and the
    radius within which a marker counts as reached, and what a disc jump reaches with the jets lit with the
    jump or after it.
    """
    return {row["armor"]: (row["jets"]["apex"] + radius, row["lit_after"]["apex"]) for row in rows}
