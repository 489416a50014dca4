"""Plays one player of one case again, and shows the tick in which a check found something."""

from collections.abc import Sequence
from dataclasses import dataclass

import click
import numpy as np

from discjump._text import described, shown
from discjump.stress import energy, matrix, repeats
from discjump.stress.cases import PRECISIONS, SURFACES, TIERS, Case, Column
from discjump.stress.checks import judge, ticks_of
from discjump.stress.floor import Floor
from discjump.stress.play import play, prepared

UNIT = {
    "ground": "m below what is allowed",
    "path": "m below what is allowed",
    "energy": "(m/s)^2 more than the bound",
    "speed": "(m/s)^2 more than the bound",
    "flight": "(m/s)^2 off",
    "stop": "m/s lost",
    "tank": "energy off",
    "blast": "m/s off",
}


@dataclass(frozen=True)
class Address:
    """A player of a case in a column."""

    column: Column
    case: Case
    player: int

    def __str__(self) -> str:
        return address(self.column, self.case.extreme, self.case.name, self.player)


def address(column: Column, extreme: str, case: str, player: int) -> str:
    """What `--replay` takes: tier/precision/surface/extreme/case/player."""
    return f"{column}/{extreme}/{case}/{player}"


def parsed(text: str, cases: Sequence[Case]) -> Address:
    """The player of a case among these.

    Raises:
        click.BadParameter: no such column, case or player; says what there is.
    """
    wanted = "tier/precision/surface/extreme/case/player"
    words = text.split("/")
    if len(words) < 6:
        raise click.BadParameter(f"expected {wanted}, got {text!r}", param_hint="--replay")
    for name, word, known in zip(
        ("tier", "precision", "surface"), words, (TIERS, PRECISIONS, SURFACES), strict=False
    ):
        if word not in known:
            raise click.BadParameter(
                f"expected a {name} of {', '.join(known)}, got {word!r}", param_hint="--replay"
            )
    label, player = "/".join(words[3:-1]), words[-1]
    found = [case for case in cases if case.label == label]
    if not found:
        labels = ", ".join(case.label for case in cases)
        raise click.BadParameter(f"expected one of the cases {labels}, got {label!r}", param_hint="--replay")
    if not player.isdecimal():
        raise click.BadParameter(f"expected the number of a player, got {player!r}", param_hint="--replay")
    return Address(Column(*words[:3]), found[0], int(player))


def replay(where: Address) -> tuple[str, bool]:
    """What happened to the player, and whether anything was found.

    He is played alone, or with his world where he shares one: his bits do not depend on others in the batch.
    """
    case, column = where.case, where.column
    terrain, start = prepared(case, column)
    if case.far is not None:
        start = repeats.representable(start, Floor(terrain))
    players = start.inputs.shape[1]
    if where.player >= players:
        raise click.BadParameter(
            f"expected a player from 0 to {players - 1}, got {where.player}", param_hint="--replay"
        )
    per_world = case.setting.players_per_world
    first = where.player // per_world * per_world
    record = play(terrain, start.take(slice(first, first + per_world)), column, case.setting)
    me = where.player - first
    found = [*judge(record), *matrix.others(case, record, crowd=False)]
    found = [f for f in found if f.player == me]
    ticks = len(record.begun)
    if not found:
        return f"{where}: nothing found in {ticks} ticks", False
    worst = min(found, key=lambda f: f.tick)
    lines = [f"{where}: {ticks} ticks, {len(found)} checks found something"]
    for f in found:
        lines.append(
            f"  {f.check}: first in tick {f.tick}, in {f.count} ticks, {f.worst:.6g} {UNIT.get(f.check, '')}"
        )
    at = ticks_of(record)
    row = worst.tick * record.states.shape[1] + me
    before, after = record.begun[worst.tick, me], record.states[worst.tick + 1, me]
    lines += ["", f"tick {worst.tick} of {case.setting.tick_ms} ms, check {worst.check}"]
    lines += [f"  keys      {described(record.start.inputs[worst.tick, me])}"]
    lines += [
        f"  {name:<12}{shown(before[name]):<52}{shown(after[name])}" for name in before.dtype.names or ()
    ]
    move = at.move
    with np.errstate(invalid="ignore", over="ignore"):
        for name in ("jumped", "thrust", "walk", "final"):
            lines.append(f"  {name:<12}{shown(getattr(move.pushed, name)[row])} m/s")
        deep = f"{at.depth[row]:.6g} m below the face, of which rounding {at.rounding[row]:.3g} m"
        ledger = {
            "gained": energy.gained(move),
            "known work": energy.known_work(move),
            "contacts": energy.contact_slack(move),
            "rounding": energy.rounding(move),
        }
        sums = ", ".join(f"{name} {values[row]:.6g}" for name, values in ledger.items())
        lines += [f"  {'depth':<12}{deep}", f"  {'energy':<12}{sums} (m/s)^2"]
    return "\n".join(lines), True
