"""What a player touches in the tick after which two sides differ."""

from discjump._text import shown
from discjump.bisect.lockstep import Parting
from discjump.bisect.sides import Side
from discjump.bisect.start import just_before


def contact_list(sides: tuple[Side, Side], parting: Parting) -> tuple[list[str], list[str]]:
    """The contacts of the tick on both sides, in their order, one line each."""
    return _of(sides[0], parting, 0), _of(sides[1], parting, 1)


def _of(side: Side, parting: Parting, k: int) -> list[str]:
    if parting.before is None:
        return ["none: it is the beginning"]
    if side.python is not None:
        return ["not known: another installation plays it"]
    sim, inputs, _ = just_before(side, parting, k)
    row = parting.difference.row
    query = getattr(sim, "contacts", None)
    if query is None:
        return ["not known"]
    found = query(row, inputs[0, row])
    return [
        f"at {shown(one['position'])} m, moving {shown(one['velocity'])} m/s, normal {shown(one['normal'])}"
        for one in found
    ] or ["none"]
