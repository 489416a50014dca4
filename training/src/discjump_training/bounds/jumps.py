"""Disc jumps from rest on a plane: schedules, and how high each leads.

A schedule says in which decision of a run each key is pressed, counted from the one in which the player
jumps. All of many schedules are played side by side.
"""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import Simulator
from discjump_training.policy import ARMED_BINS, LOWEST_PITCH, Floats

Times = NDArray[np.int64]

#: Decisions that never come.
NEVER = 1 << 30
#: Ticks that players stand on the plane first: then they have touched it, and are at rest.
STANDING = 32
#: Played side by side: more do not fit a processor's caches.
BATCH = 2_048
#: Ticks after the jump in which somebody may still rise.
LONGEST = 1_024
#: Pitches that a discrete action can have, rad.
PITCHES: Floats = LOWEST_PITCH * np.linspace(1.0, 0.0, ARMED_BINS[6])


@dataclass(frozen=True)
class Jumps:
    """`n` schedules; times are in decisions after that of the jump, (n,) each.

    Attributes:
        lit: jets burn from then on,
        off: but not from then on,
        relit: until then.
        shot: the disc is fired.
        pitch: of the view until then, rad; (n,) float64.
        second: the second disc is fired.
        again: the jump key is pressed again.
        first: the jump key is pressed; 0, or `NEVER`.
    """

    lit: Times
    off: Times
    relit: Times
    shot: Times
    pitch: Floats
    second: Times
    again: Times
    first: Times

    @classmethod
    def grid(
        cls,
        lit: Iterable[int] = (0,),
        gaps: Iterable[tuple[int, int]] = ((NEVER, NEVER),),
        shot: Iterable[int] = (NEVER,),
        pitch: Iterable[float] = (0.0,),
    ) -> "Jumps":
        """All combinations, with one disc.

        Args:
            lit, shot, pitch: as the attributes.
            gaps: from when until when jets do not burn.
        """
        rows = list(product(lit, gaps, shot, pitch))
        begin, gap, fired, view = zip(*rows, strict=True)
        off, relit = np.array(gap, np.int64).T
        never = np.full(len(rows), NEVER)
        return cls(
            lit=np.array(begin, np.int64),
            off=off,
            relit=relit,
            shot=np.array(fired, np.int64),
            pitch=np.array(view, np.float64),
            second=never,
            again=never,
            first=np.zeros(len(rows), np.int64),
        )

    def __len__(self) -> int:
        return len(self.lit)

    def take(self, which: NDArray[np.intp] | slice) -> "Jumps":
        """Some of them."""
        return replace(self, **{one.name: getattr(self, one.name)[which] for one in fields(self)})

    def row(self, index: int) -> dict[str, float | None]:
        """One of them for JSON; None: never. The pitch is in degrees."""
        told: dict[str, float | None] = {
            one.name: None if (time := int(getattr(self, one.name)[index])) == NEVER else time
            for one in fields(self)
            if one.name != "pitch"
        }
        return {**told, "pitch": round(float(np.rad2deg(self.pitch[index])), 3)}

    def last(self) -> int:
        """The last decision in which anything is pressed that has not been before."""
        times = np.stack([getattr(self, one.name) for one in fields(self) if one.name != "pitch"])
        return int(times[times < NEVER].max(initial=0))


@dataclass(frozen=True)
class Heights:
    """How high the feet got, (n,) each.

    Attributes:
        apex: over the plane, m.
        seconds: from the jump to the apex.
        damage: taken until then.
        alive: whether that is less than kills.
    """

    apex: Floats
    seconds: Floats
    damage: Floats
    alive: NDArray[np.bool_]


#: Damage that kills, by armor (core/docs/physics.md, section 2).
DEADLY = {"light": 0.66, "medium": 1.0, "heavy": 1.32}


def heights(armor: str, jumps: Jumps, ticks: int = 1, tick_ms: int = 32) -> Heights:
    """Play schedules from rest on a plane, with a full tank.

    Args:
        armor: of the players.
        jumps: schedules.
        ticks: of a decision.
        tick_ms: length of a tick.
    """
    parts = [
        _heights(armor, jumps.take(slice(start, start + BATCH)), ticks, tick_ms)
        for start in range(0, len(jumps), BATCH)
    ]
    return Heights(*(np.concatenate([getattr(one, f.name) for one in parts]) for f in fields(Heights)))


def _heights(armor: str, jumps: Jumps, ticks: int, tick_ms: int) -> Heights:
    plane = Terrain.from_heights(np.zeros((9, 9)))
    sim = Simulator(plane, len(jumps), "disc_jump", armor=armor, threads=1, tick_ms=tick_ms, ammo=3)
    sim.step(sim.inputs(), STANDING)
    before = max(0, -int(min(jumps.lit.min(), jumps.shot.min(), 0)))
    apex, when, damage = np.zeros(len(jumps)), np.zeros(len(jumps)), np.zeros(len(jumps))
    last = jumps.last()
    for time in range(-before, LONGEST // ticks):
        keys = sim.inputs()
        keys["jump"] = (jumps.first == time) | (jumps.again == time)
        keys["jet"] = (jumps.lit <= time) & ((time < jumps.off) | (jumps.relit <= time))
        keys["fire"] = (jumps.shot == time) | (jumps.second == time)
        keys["pitch"] = jumps.pitch
        for tick in range(ticks):
            sim.step(keys)
            state = sim.state()
            higher = state["position"][:, 2] > apex
            apex = np.where(higher, state["position"][:, 2], apex)
            when = np.where(higher, (time * ticks + tick + 1) * tick_ms / 1000, when)
            damage = np.where(higher, state["damage"], damage)
        # Who falls with nothing left to come does not rise again; the disc takes a few ticks.
        if time > last + 16 and not (state["velocity"][:, 2] > 0).any():
            break
    return Heights(apex, when, damage, damage < DEADLY[armor])
