"""The witnesses by name, and runs of a single player."""

from collections import deque
from collections.abc import Iterator
from typing import Any

from . import anyway, article, engine, swept
from .article import ARMORS, Keys, Player, Rules
from .ground import Surface, Vec

#: The pack's rate and the plain one, energy per second.
RECHARGE = {False: 8.0, True: 11.0}
MODELS = ("sliced", "swept", "anyway", "engine")
MOVES = {"sliced": article.move, "swept": swept.move, "anyway": anyway.move}


def tick(model: str, player: Player, keys: Keys, ground: Surface, rules: Rules) -> None:
    if model == "engine":
        engine.tick(player, keys, ground, rules)
    else:
        article.tick(player, keys, ground, rules, MOVES[model])


def rules_of(model: str, armor: str = "light", energy_pack: bool = False, **switches: Any) -> Rules:
    switches = {"ski_bug": model == "engine"} | switches
    return Rules(ARMORS[armor], recharge=RECHARGE[energy_pack], **switches)


def standing(
    model: str,
    position: Vec = (0.0, 0.0, 0.0),
    velocity: Vec = (0.0, 0.0, 0.0),
    armor: str = "light",
    **fields: Any,
) -> Player:
    """A fresh player, with a full tank."""
    fields = {"energy": ARMORS[armor].max_energy} | fields
    if model == "engine":
        return engine.standing(position, velocity, **fields)
    return article.standing(position, velocity, **fields)


def play(
    model: str, player: Player, keys: Keys, ground: Surface, rules: Rules | None = None, ticks: int = 10_000
) -> Iterator[Player]:
    """The same player after every tick."""
    rules = rules or rules_of(model)
    for _ in range(ticks):
        tick(model, player, keys, ground, rules)
        yield player


def last(states: Iterator[Player]) -> Player:
    return deque(states, maxlen=1)[0]
