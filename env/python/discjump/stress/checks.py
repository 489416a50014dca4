"""What must hold of every tick, asked of all ticks of a record at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from discjump.simulator import SCENES
from discjump.stress import energy
from discjump.stress.floor import Floor, rounding
from discjump.stress.play import Record
from discjump.stress.rules import ARMORS, OLDEST, Bools, Floats, Rows, Rules, pushed

DEPTHS = {"float32": 2e-3, "float64": 1e-9}
"""How far through a face a tick may end, m, beyond the rounding of its numbers (core/docs/tiers.md).

In `engine` feet may be so far below a face as the sphere's middle is above them: it asks the middle."""
MAX_PITCH = np.radians(88.0)


@dataclass(frozen=True)
class Finding:
    """The worst that a check found: how far beyond its bound anybody was, and who was so first."""

    check: str
    #: Largest excess, in the check's unit.
    worst: float
    #: Ticks of players in which it was found.
    count: int
    tick: int
    player: int


@dataclass(frozen=True)
class Ticks:
    """All ticks of all players of a record, flat: (ticks * n,)."""

    record: Record
    rules: Rules
    before: Rows
    after: Rows
    inputs: Rows
    bursts: Floats
    move: energy.Move
    floor: Floor
    #: Depth below the ground at the end, m; NaN where there is none.
    depth: Floats
    #: What of it may be rounding.
    rounding: Floats
    #: Whether the bump limit ended the tick.
    limited: Bools

    def finding(self, check: str, excess: Floats) -> Finding | None:
        """The finding of an excess (ticks * n,) over a bound, none where it is nowhere above 0."""
        bad = np.flatnonzero(~(excess <= 0.0))
        if not bad.size:
            return None
        worst = float(np.nan_to_num(excess[bad], nan=np.inf).max())
        tick, player = divmod(int(bad[0]), self.record.states.shape[1])
        return Finding(check, worst, int(bad.size), tick, player)


def rules_of(record: Record) -> Rules:
    """The rules of a record's batch."""
    setting = record.setting
    return Rules(
        ARMORS[setting.armor],
        record.column.tier == "engine",
        setting.tick_ms,
        setting.energy_pack,
        setting.physics.hysteresis,
    )


def ticks_of(record: Record) -> Ticks:
    """A record, flat, with what several checks ask for."""
    rules = rules_of(record)
    before, after = record.begun.ravel(), record.states[1:].ravel()
    inputs = record.start.inputs.ravel()
    eps = record.column.eps
    move_begins = pushed(rules, before, after, inputs)
    floor = Floor(record.terrain)
    with np.errstate(invalid="ignore", over="ignore"):
        position = np.nan_to_num(after["position"], nan=0.0, posinf=1e30, neginf=-1e30)
        depth = floor.depth(position)
        way = np.linalg.norm(move_begins.final, axis=1) * rules.dt
        slack = rounding(floor, position, way, eps, _middle(record))
    # Scenes that do not count the bump limits may meet one at any contact.
    counts = "bump_limits" in (after.dtype.names or ())
    limited = after["bump_limits"] > before["bump_limits"] if counts else after["touched"]
    models = SCENES[record.setting.scene].models
    bodies = "solids" in models or record.setting.players_per_world > 1
    drops = rules.engine or (bodies and record.column.tier == "fast")
    move = energy.Move(
        rules,
        record.column.tier,
        eps,
        (before["position"][:, 2], after["position"][:, 2]),
        (before["velocity"].astype(np.float64), after["velocity"].astype(np.float64)),
        move_begins,
        after["touched"] | (record.bursts.ravel() > 0),
        after["touched"] if drops else limited,
        np.abs(np.nan_to_num(depth, nan=1.0)) <= slack + DEPTHS[record.column.precision],
        "solids" in models,
    )
    return Ticks(
        record,
        rules,
        before,
        after,
        inputs,
        record.bursts.ravel(),
        move,
        floor,
        depth,
        slack,
        limited,
    )


def _middle(record: Record) -> Floats:
    """Where local coordinates count from."""
    terrain = record.terrain
    return np.array(terrain.origin) + 0.5 * np.array(terrain.size)


def finite(ticks: Ticks) -> Finding | None:
    """Every number of every state."""
    bad = np.zeros(len(ticks.after), bool)
    for name in ticks.after.dtype.names or ():
        numbers = ticks.after[name]
        if numbers.dtype.kind == "f":
            bad |= ~np.isfinite(numbers.reshape(len(bad), -1)).all(axis=1)
    return ticks.finding("finite", bad.astype(np.float64))


def bounds(ticks: Ticks) -> Finding | None:
    """Energy in the tank, friction in 0 to 1, angles on their circle, ages and counts that only count."""
    before, after, rules = ticks.before, ticks.after, ticks.rules
    step = 1 if rules.engine else rules.tick_ms
    age = after["jump_age"].astype(np.int64)
    # A jump sets the age to the end of the grace.
    oldest = np.minimum(np.maximum(before["jump_age"].astype(np.int64), rules.grace) + step, OLDEST)
    normal = np.linalg.norm(after["jump_normal"].astype(np.float64), axis=1)
    hurt = after["damage"].astype(np.float64) - before["damage"].astype(np.float64)
    speed = np.linalg.norm(ticks.move.pushed.final, axis=1)
    contacts = energy.CONTACTS.get(ticks.record.column.tier, 4)
    hardest = contacts * rules.armor.landing_scale * np.maximum(0.0, speed - 25.0)
    eps = ticks.record.column.eps
    damage = after["damage"].astype(np.float64)
    hardest += 16.0 * eps * (hardest + damage) + 1.3 * ticks.bursts + 1e-12
    hardest = np.where(ticks.move.touched, hardest, 0.0)
    bad = (after["energy"] < 0.0) | (after["energy"].astype(np.float64) > rules.armor.max_energy)
    bad |= ~((after["friction"] >= 0.0) & (after["friction"] <= 1.0))
    bad |= ~(np.abs(after["yaw"].astype(np.float64)) <= np.pi + 1e-6)
    bad |= ~(np.abs(after["pitch"].astype(np.float64)) <= MAX_PITCH + 1e-6)
    bad |= (age < 0) | (age > oldest) | ~(np.abs(normal - 1.0) <= 2e-3)
    bad |= (hurt < 0.0) | (hurt > hardest)
    if "bump_limits" in (after.dtype.names or ()):
        more = after["bump_limits"].astype(np.int64) - before["bump_limits"]
        bad |= (more < 0) | (more > 1)
    return ticks.finding("bounds", bad.astype(np.float64))


def tank(ticks: Ticks) -> Finding | None:
    """Jets light at 5, go out at 1, to the bit; the tank has what it had, gained and gave (section 4.2)."""
    before, after, rules = ticks.before, ticks.after, ticks.rules
    real = after["energy"].dtype.type
    had = before["energy"]
    if rules.engine and rules.energy_pack:
        had = np.minimum(had + real(3.0 * rules.dt), real(rules.armor.max_energy))
    key = ticks.inputs["jet"]
    allowed = had > 0.0
    if rules.hysteresis:
        allowed = np.where(before["jetting"], had > real(1.0), had >= real(5.0))
    burns = key & allowed
    gain = (8.0 + (0.0 if rules.engine or not rules.energy_pack else 3.0)) * rules.dt
    left = had.astype(np.float64) + gain - np.where(burns, rules.armor.drain * rules.dt, 0.0)
    off = np.abs(np.clip(left, 0.0, rules.armor.max_energy) - after["energy"])
    excess = off - 8.0 * ticks.record.column.eps * rules.armor.max_energy
    return ticks.finding("tank", np.where(burns != after["jetting"], np.inf, excess))


def ground(ticks: Ticks) -> Finding | None:
    """Feet at the ends of ticks no deeper in a face than rounding takes them, m."""
    if ticks.record.start.buried:
        return None
    deep = ticks.depth - ticks.rounding - allowed_depth(ticks, ticks.after["position"])
    return ticks.finding("ground", np.where(outside(ticks), -1.0, deep))


def outside(ticks: Ticks) -> Bools:
    """Who was beyond a rim with nothing behind it, and so may have come back under the map, (ticks * n,)."""
    states = ticks.record.states
    began = ticks.floor.depth(states[0]["position"])
    beyond = np.isnan(np.concatenate([began, ticks.depth])).reshape(states.shape)
    been: Bools = np.logical_or.accumulate(beyond, axis=0)[1:].ravel()
    return been


def allowed_depth(ticks: Ticks, position: Floats) -> Floats | float:
    """How far below a face feet may be, m, (n,)."""
    depth = DEPTHS[ticks.record.column.precision]
    if ticks.rules.engine:
        with np.errstate(invalid="ignore"):
            up = ticks.floor.up(np.nan_to_num(np.ascontiguousarray(position[:, :2])))
        return depth + 0.5 * ticks.rules.armor.height * np.nan_to_num(up)
    return depth


def path(ticks: Ticks) -> Finding | None:
    """No face anywhere on the way of a tick that touched nothing, m."""
    start, end = ticks.before["position"], ticks.after["position"]
    asked = ~ticks.move.touched & np.isfinite(end).all(axis=1) & ~outside(ticks)
    if ticks.record.start.buried or not asked.any():
        return None
    slack = ticks.rounding + allowed_depth(ticks, end)
    # Who is under the ground at an end of the way is for `ground`.
    asked &= ~(np.fmax(ticks.floor.depth(start), ticks.depth) > slack)
    deep = np.full(len(end), -np.inf)
    deep[asked] = ticks.floor.deepest(start[asked], end[asked])
    return ticks.finding("path", deep - slack)


def work(ticks: Ticks) -> Finding | None:
    """No energy from nothing: see `energy`, (m/s)^2."""
    return ticks.finding("energy", _unless_burst(ticks, energy.excess(ticks.move)))


def speed(ticks: Ticks) -> Finding | None:
    """Contacts add no speed but their pushes, (m/s)^2 / 2."""
    return ticks.finding("speed", _unless_burst(ticks, energy.speed_excess(ticks.move)))


def flight(ticks: Ticks) -> Finding | None:
    """Ticks without a contact keep their energy, (m/s)^2."""
    off = energy.missing(ticks.move)
    if ticks.record.column.tier == "fast":
        off = np.where(ticks.move.grounded, 0.0, off)
    return ticks.finding("flight", off)


def stop(ticks: Ticks) -> Finding | None:
    """Nobody stops dead but by the stop rule, or by the ski bug where it is on, m/s.

    Every contact leaves its outward push, so a player at rest to the bit was stopped. (A speed whose rounding
    swallows the push can be lost in a contact straight on.)
    """
    record = ticks.record
    before = np.linalg.norm(ticks.move.pushed.final, axis=1)
    after = np.linalg.norm(ticks.move.velocity[1], axis=1)
    bug = record.setting.physics.ski_bug
    bug = record.column.tier == "engine" if bug is None else bug
    ruled = ticks.after["touched"] & ticks.after["crawled"]
    ruled |= ticks.limited if bug else False
    swallowed = before * record.column.eps * 4.0 > ticks.rules.push
    dead = (after < 0.25 * ticks.rules.push) & (before > 0.01) & ~ruled & ~swallowed & (ticks.bursts == 0)
    return ticks.finding("stop", np.where(dead, before, 0.0))


def _unless_burst(ticks: Ticks, excess: Floats) -> Floats:
    """Projectiles burst after the move, in the same tick: they are bounded where they are set off by hand."""
    return np.where(ticks.bursts > 0, 0.0, excess)


CHECKS: tuple[Callable[[Ticks], Finding | None], ...] = (
    finite,
    bounds,
    tank,
    ground,
    path,
    work,
    speed,
    flight,
    stop,
)


def judge(record: Record) -> list[Finding]:
    """What was found, check by check; nothing where all is well."""
    ticks = ticks_of(record)
    with np.errstate(invalid="ignore", over="ignore"):
        found = [check(ticks) for check in CHECKS]
    return [finding for finding in found if finding is not None]
