"""How much mechanical energy a tick may add: a bound from the state before, the keys, and the contacts.

Energies are per unit of mass, e = v^2 / 2 + 20 z. Let v1 be the velocity after the jump, T what the jets add,
g dt what gravity takes, W what walking adds, v3 the sum, with which the move begins (core/docs/physics.md, 3
and 4).

**Known work.** Jump: (v1^2 - v0^2) / 2. Walking: (v3^2 - v2^2) / 2 with v2 = v3 - W. Jets and gravity of a
free flight, where the height gains v3 dt: v1.T + T^2 / 2 - (g dt)^2 / 2, so the last is lost by every tick of
semi-implicit Euler; `engine` takes the mean of v1 and v3 for the way, and the sum is T.(v1 + v2) / 2 exactly.

**Contacts.** One with the normal n and the impact I turns v into v + n (I + p), p the outward push. It costs
I^2 / 2 - p^2 / 2. From then on the player rises faster by n.up (I + p), for at most the tick: g dt (I + p).
The gain is g dt (I + p) - I^2 / 2 + p^2 / 2, at most (g dt)^2 / 2 + g dt p + p^2 / 2 whatever I is. In
`swept` a contact at once also pushes out by up to a slice of I + p, again at most the tick: twice the rise,
four times the square. In `engine` the way before the contact and the one after it are of different speeds:
the same twice.

**Dropped time.** At the bump limit the rest of the tick is not made, and so the height it would have lost is
kept: g dt times the downward speed that is left. So with the time that overlaps use up in `engine`, and after
the second contact of `fast` where that is with a body. Where the stop rule or the ski bug then take away all
speed, s, it is g dt s - s^2 / 2, again at most (g dt)^2 / 2.

**`fast`** holds the end of its move on the ground: who would end below is lifted onto it, by however much.
Where a tick of it ends on the ground only the speed is bounded.

**Speed**: contacts never add any but the pushes: v^2 <= v3^2 + k p^2.

**Step-up** onto a solid lifts by at most 0.6 r, once a contact (section 12).
"""

from dataclasses import dataclass

import numpy as np

from discjump.stress.rules import GRAVITY, MAX_SLICES, Bools, Floats, Pushed, Rules

CONTACTS = {"fast": 2, "engine": 3}
"""Most contacts of a tick; elsewhere 4."""
LIFTS = {"swept": 2.0, "engine": 2.0}
"""How many times the tick a contact may lift for."""
STEP_UP = 0.6
"""Share of the sphere's radius."""


@dataclass(frozen=True)
class Move:
    """What was seen of the moves of n players in a tick."""

    rules: Rules
    tier: str
    #: Relative rounding of the arithmetic, as numpy's `finfo.eps`.
    eps: float
    #: Height before and after, m, and velocity before and after, m/s.
    z: tuple[Floats, Floats]
    velocity: tuple[Floats, Floats]
    pushed: Pushed
    touched: Bools
    #: Whether the rest of the tick may have been dropped.
    limited: Bools
    #: Whether the tick ended on the ground, to rounding.
    grounded: Bools
    #: Whether solids are about.
    solids: bool


def kinetic(velocity: Floats) -> Floats:
    """v^2 / 2, (n,)."""
    halves: Floats = 0.5 * np.sum(velocity * velocity, axis=-1)
    return halves


def known_work(move: Move) -> Floats:
    """What jump, jets, walking and a free flight's gravity add, (n,)."""
    first, thrust, final = move.pushed.jumped, move.pushed.thrust, move.pushed.final
    falling: Floats = final - move.pushed.walk
    jump: Floats = kinetic(first) - kinetic(move.velocity[0])
    walk = kinetic(final) - kinetic(falling)
    if move.rules.engine:
        burned: Floats = np.sum(thrust * (first + falling), axis=-1) / 2.0
        return jump + walk + burned
    fall = GRAVITY * move.rules.dt
    along: Floats = np.sum(first * thrust, axis=-1)
    return jump + walk + along + kinetic(thrust) - fall * fall / 2.0


def contact_slack(move: Move) -> Floats:
    """What the contacts of a tick may add beyond, (n,): 0 where nothing was touched."""
    dt, push = move.rules.dt, move.rules.push
    fall = GRAVITY * dt
    lift = LIFTS.get(move.tier, 1.0) * fall
    # One more for a stop, which drops time too.
    each = lift * lift / 2.0 + lift * push + push * push / 2.0
    if move.solids:
        each += GRAVITY * STEP_UP * move.rules.armor.height / 2.0
    slack = (CONTACTS.get(move.tier, 4) + 1) * each
    dropped = np.where(move.limited, fall * np.maximum(0.0, -move.velocity[1][:, 2]), 0.0)
    if move.rules.engine:
        # The first piece of the way has the mean of the speeds.
        dropped = dropped + fall * np.maximum(0.0, move.pushed.thrust[:, 2] - fall) / 2.0
    return np.where(move.touched, slack + dropped, 0.0)


def rounding(move: Move) -> Floats:
    """What the arithmetic may add, (n,): of every sum's operands, as many times as it is summed."""
    fastest = np.maximum(kinetic(move.velocity[0]), kinetic(move.pushed.final))
    fastest = np.maximum(fastest, kinetic(move.pushed.jumped))
    way = np.sqrt(2.0 * fastest) * move.rules.dt
    shortest = 0.075 if move.rules.engine else 1.0
    slices = np.minimum(np.ceil(way / shortest), MAX_SLICES) + 8.0
    height = np.maximum(np.abs(move.z[0]), np.abs(move.z[1]))
    # Speeds that squares are no numbers of any more are nothing.
    return 64.0 * move.eps * fastest + GRAVITY * move.eps * (slices * height + 8.0 * way) + 1e-9


def gained(move: Move) -> Floats:
    """The energy that the tick added, (n,)."""
    return kinetic(move.velocity[1]) - kinetic(move.velocity[0]) + GRAVITY * (move.z[1] - move.z[0])


def excess(move: Move) -> Floats:
    """How much more than its bound the tick added, (n,): at most 0 where nothing came from nothing."""
    allowed = known_work(move) + contact_slack(move) + rounding(move)
    over = gained(move) - allowed
    # What `fast` lifts onto the ground.
    return np.where(move.grounded, 0.0, over) if move.tier == "fast" else over


def speed_excess(move: Move) -> Floats:
    """How much kinetic energy the contacts added beyond their pushes, (n,)."""
    pushes = 0.5 * CONTACTS.get(move.tier, 4) * move.rules.push**2
    added = kinetic(move.velocity[1]) - kinetic(move.pushed.final)
    return added - np.where(move.touched, pushes, 0.0) - rounding(move)


def missing(move: Move) -> Floats:
    """How far the energy of ticks that touched nothing is from what is known of them, (n,)."""
    off = np.abs(gained(move) - known_work(move)) - rounding(move)
    return np.where(move.touched, 0.0, off)
