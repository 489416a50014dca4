"""Where two runs part: both in lockstep, tick by tick, up to the first bit that differs.

    sides       what is run: a replay, changed, in some way, perhaps by another installation
    streams     the frames of a side, from here or from a worker of another installation
    ulps        how far two floating-point numbers are apart
    lockstep    the first difference between two streams
    start       a replay that starts there
    contacts    what is touched in that tick
    certificates  two certificates of `discjump verify`: the episodes that differ
    report      what is printed
    command     `discjump bisect`

Arrows point down only: command -> certificates, report, contacts -> start -> lockstep -> streams ->
sides -> discjump.replays.
"""

from discjump.bisect.lockstep import Difference, Parting, bisect
from discjump.bisect.sides import Side
from discjump.bisect.ulps import ulps

__all__ = ["Difference", "Parting", "Side", "bisect", "ulps"]
