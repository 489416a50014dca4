"""How much is played: the full form and the quick one."""

from dataclasses import dataclass

THREADS = (1, 2, 3, 16)
BATCHES = (1, 3, 64, 4096)
CROWD = 4096
"""From some hundred players on the threads are used at all."""


@dataclass(frozen=True)
class Form:
    """How much of the matrix is played."""

    name: str
    environments: int
    """Of the reference."""
    crossed: bool
    """Threads x batch x lanes all crossed; else each with each of another."""
    decisions: int | None
    """Decisions of what is neither a batch of 64, a snapshot nor an autoreset mode; None: full episodes."""
    crowd_decisions: tuple[int, int]
    """Decisions of the largest batch, and calls where it is of worlds, if it does not play all."""
    alone: int
    """Environments that are played alone or in threes."""
    scene_worlds: int
    """Worlds of a scene's reference."""
    snapshots: int
    """Ticks at which a snapshot is taken."""
    processes: bool
    """Whether other processes play whole episodes, or only what follows a snapshot and a short crowd."""
    ways: int
    """Environments through other ways in."""
    shifts: tuple[int, ...]
    """By how many places everybody is moved."""


FULL = Form("full", 64, True, None, (60, 6), 4, 32, 3, True, 16, (1, 31, 63))
QUICK = Form("quick", 12, False, 200, (3, 1), 2, 8, 1, False, 4, (31,))


def whole(form: Form, batch: int, threads: int, lanes: int, widths: list[int]) -> bool:
    """Whether a configuration plays full episodes.

    All do but for the largest batch, which does in the full form: on any threads in the widest lanes, in any
    lanes on two threads.
    """
    return batch != CROWD or (form.crossed and (lanes == widths[-1] or threads == 2))


def configurations(form: Form, widths: list[int]) -> list[tuple[int, int, int]]:
    """(batch, threads, lanes) that are played.

    >>> len(configurations(FULL, [1, 8, 16, 32]))
    64
    >>> quick = configurations(QUICK, [1, 8, 16, 32])
    >>> [len({play[axis] for play in quick}) for axis in range(3)]
    [4, 4, 4]
    """
    if form.crossed:
        return [(b, t, w) for b in BATCHES for t in THREADS for w in widths]
    chosen = [(1, 1, widths[-1]), (3, 16, widths[min(1, len(widths) - 1)])]
    for at, threads in enumerate(THREADS):
        chosen += [(64, threads, widths[at % len(widths)]), (CROWD, threads, widths[(at + 1) % len(widths)])]
    return list(dict.fromkeys(chosen))
