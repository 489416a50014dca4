"""The same bits again: among others, on other threads, in other lanes, and whole tiles away."""

import numpy as np

from discjump.stress import play
from discjump.stress.cases import Case, Start
from discjump.stress.checks import Finding
from discjump.stress.floor import Floor
from discjump.stress.play import Record

CROWD = 513
"""From 512 players on threads are used."""


def repeat(record: Record, crowd: bool) -> Finding | None:
    """Who ended in another state when played again; `crowd`: as well in copies, on two threads."""
    last = record.states[-1]
    for least in (0, CROWD) if crowd else (0,):
        once_more = play.again(record, threads=2, least=least)
        for copy in once_more:
            differs = np.array([copy[k].tobytes() != last[k].tobytes() for k in range(len(last))])
            if differs.any():
                player = int(np.flatnonzero(differs)[0])
                return Finding(
                    "repeat", float(differs.sum()), int(differs.sum()), len(record.begun) - 1, player
                )
    return None


def digest(record: Record) -> Finding | None:
    """Whether the digest, which sees hidden bits too, is another in scalar on two threads."""
    start, setting = record.start, record.setting
    other = play.play(record.terrain, start, record.column, setting, threads=2, lanes=1)
    if other.digest == record.digest:
        return None
    return Finding("repeat", 1.0, 1, len(record.begun) - 1, 0)


def representable(start: Start, record_floor: Floor) -> Start:
    """The same start at places that a float64 of 1e9 m holds to the bit: whole 1/1024 m."""
    xy = np.round(start.position[:, :2] * 1024.0) / 1024.0
    above = np.maximum(start.position[:, 2], np.ceil(record_floor.height(xy) * 1024.0) / 1024.0)
    return Start(
        np.column_stack([xy, above]), start.velocity, start.inputs, start.fields, start.blasts, start.buried
    )


def far(case: Case, record: Record) -> Finding | None:
    """Whether a player whole tiles away moves otherwise in any bit.

    Compared are all fields of the state in every tick, and positions to the last bit that a float64 has
    there: a position is the tile's corner, which is exact, and the local one, rounded once.
    """
    if case.far is None:
        return None
    offset = np.array([*case.far, 0.0]) * [*record.terrain.size, 0.0]
    start = record.start
    shifted = Start(
        start.position + offset, start.velocity, start.inputs, start.fields, start.blasts, start.buried
    )
    away = play.play(record.terrain, shifted, record.column, record.setting)
    differs = np.zeros(record.states.shape, bool)
    for name in record.states.dtype.names or ():
        here, there = record.states[name], away.states[name]
        if name == "position":
            here = here + offset
            # The near one may have been rounded as well, where the middle of the map is 0.
            same = np.abs(there - here) <= np.spacing(np.abs(here))
            same[..., 2] = there[..., 2] == here[..., 2]
        else:
            same = (here == there) | ((here != here) & (there != there))
        differs |= ~same.reshape(*differs.shape, -1).all(axis=-1)
    if not differs.any():
        return None
    tick, player = (int(k) for k in np.argwhere(differs)[0])
    return Finding("far", float(differs.sum()), int(differs.sum()), max(0, tick - 1), player)
