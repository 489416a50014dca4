"""What a player touches in the tick after which two sides differ."""

from typing import Any

from discjump._text import shown
from discjump.bisect.lockstep import Parting
from discjump.bisect.sides import Side
from discjump.bisect.start import starting

NOT_HERE = "played by another installation, which is not asked"


def contact_list(sides: tuple[Side, Side], parting: Parting) -> tuple[str, str]:
    """The contacts of the tick on both sides, as text."""
    return ("", "")


