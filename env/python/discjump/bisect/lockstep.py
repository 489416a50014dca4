"""The first difference between two sides, tick by tick."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump.bisect.sides import Side
from discjump.bisect.streams import opened
from discjump.bisect.ulps import ulps
from discjump.replays.bare.play import Frame, Values


@dataclass(frozen=True)
class Difference:
    """Two values that should be one.

    Attributes:
        field: what differs, such as `state.velocity[2]`.
        row: which player of a simulator; 0 of an environment.
        a, b: the values.
        ulps: how far they are apart in last places; None where that means nothing.
        counted: in which dtype's: the shorter one's of the two. States hold positions in float64, whatever
            the tier computes in; theirs are counted in the dtype of the velocities.
        metres: how far the positions are apart, where a tolerance was asked for.
    """

    field: str
    row: int
    a: Any
    b: Any
    ulps: int | None = None
    counted: str = ""
    metres: float | None = None


@dataclass(frozen=True)
class Parting:
    """Where two sides part.

    Attributes:
        tick: the tick after which it shows, counted from 1; 0: they begin apart.
        difference: the first one.
        others: names of further values that differ after the same tick.
        before: the last frames that were equal, of A and B; None at tick 0.
        after: the frames that differ.
    """

    tick: int
    difference: Difference
    others: tuple[str, ...]
    before: tuple[Frame, Frame] | None
    after: tuple[Frame, Frame]


@dataclass(frozen=True)
class Outcome:
    """What came of running two sides.

    Attributes:
        ticks: so many were compared.
        parting: where they part; None: nowhere.
        installations: what played A and B.
    """

    ticks: int
    parting: Parting | None
    installations: tuple[dict[str, Any], dict[str, Any]]


def bisect(a: Side, b: Side, tolerance: float = 0.0) -> Outcome:
    """Run both sides in lockstep up to the first difference.

    Args:
        a, b: the sides.
        tolerance: 0: any bit; else the positions of a player must be farther apart than so many metres.

    Raises:
        SideError, ReplayError: a side cannot be run.
    """
    with opened(a) as one, opened(b) as other:
        before, ticks = None, 0
        for frames in zip(one.frames(), other.frames(), strict=False):
            ticks = frames[0].tick
            found = list(differences(frames[0], frames[1], tolerance))
            if found:
                names = tuple(dict.fromkeys(f.field for f in found[1:]))
                parting = Parting(ticks, found[0], names, before, frames)
                return Outcome(ticks, parting, (one.installation, other.installation))
            before = frames
            if frames[0].over or frames[1].over:
                break
        return Outcome(ticks, None, (one.installation, other.installation))


def differences(a: Frame, b: Frame, tolerance: float) -> Iterator[Difference]:
    """What differs between two frames, the first number of each value and field, in their order."""
    if tolerance:
        yield from _apart(a.values, b.values, tolerance)
    else:
        for name, values in a.values.items():
            if name in b.values:
                yield from _unequal(name, values, b.values[name], _real(a.values, b.values))
    if a.over != b.over:
        words = {True: "over", False: "goes on"}
        yield Difference("end", 0, words[a.over], words[b.over])


def _apart(a: Values, b: Values, tolerance: float) -> Iterator[Difference]:
    one, other = a["state"]["position"], b["state"]["position"]
    metres = np.linalg.norm(one - other, axis=1)
    # A position that is no number is not within any tolerance.
    for row in np.flatnonzero(~(metres <= tolerance)):
        yield Difference("state.position", int(row), one[row], other[row], metres=float(metres[row]))


def _real(a: Values, b: Values) -> np.dtype[Any]:
    """The shorter dtype that the two sides compute in."""
    both = [values["state"].dtype["velocity"].base for values in (a, b)]
    return min(both, key=lambda dtype: dtype.itemsize)


def _unequal(name: str, a: NDArray[Any], b: NDArray[Any], real: np.dtype[Any]) -> Iterator[Difference]:
    if a.shape != b.shape:
        yield Difference(f"{name} (how many)", 0, a.shape, b.shape)
    elif a.dtype.names is not None:
        for field in a.dtype.names:
            if field in (b.dtype.names or ()):
                yield from _unequal(f"{name}.{field}", a[field], b[field], real)
    else:
        unequal = np.argwhere(~_same(a, b))
        if len(unequal):
            place = tuple(int(k) for k in unequal[0])
            # Rows are players; what is within a row is a component of a vector.
            rows = name.startswith(("state.", "inputs.", "projectiles.", "blasts.", "decision.state."))
            row, inner = (place[0], place[1:]) if rows else (0, place)
            one, other = a[place], b[place]
            field = name + "".join(f"[{k}]" for k in inner)
            dtypes = [one.dtype, other.dtype, *([real] if name.endswith(".position") else [])]
            short = min(dtypes, key=lambda dtype: dtype.itemsize)
            yield Difference(field, row, one, other, ulps(one, other, short), short.name)


def _same(a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.bool_]:
    """Where the bits are the same; where dtypes differ, the numbers."""
    if a.dtype == b.dtype and a.dtype.kind == "f":
        bits = f"u{a.dtype.itemsize}"
        equal: NDArray[np.bool_] = np.ascontiguousarray(a).view(bits) == np.ascontiguousarray(b).view(bits)
        return equal.reshape(a.shape)
    same: NDArray[np.bool_] = np.asarray(a == b)
    return same
