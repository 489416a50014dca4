"""What a tick does to a velocity before the move: float64 numpy, from core/docs/physics.md alone.

Sections 2 (constants), 3 (order of a tick) and 4 (jump, jets, friction). It shares nothing with the simulator
but that page: the energy that a tick may add is reckoned from it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Rows = NDArray[np.void]

GRAVITY = 20.0
"""m/s^2."""
OLDEST = 1 << 30
"""Ages stop here, ms (`engine`: ticks)."""
CRAWL_SPEED = 0.1
"""m/s."""
MAX_SLICES = 65_536
"""Beyond so many a move is swept in one piece (section 12); `engine` cuts no finer."""


@dataclass(frozen=True)
class Armor:
    """A column of section 2's table."""

    mass: float
    ground_force: float
    traction: float
    #: Forward; sideways 1 m/s less, in `engine` backward as well.
    walk_speed: float
    jump_impulse: float
    jet_force: float
    #: Speed along the pressed direction at which sideways thrust has faded out, m/s.
    fade_speed: float
    max_energy: float
    #: Per second.
    drain: float
    landing_scale: float
    half_width: float
    height: float


ARMORS = {
    "light": Armor(9.0, 360.0, 3.0, 11.0, 75.0, 236.0, 22.0, 60.0, 25.0, 0.005, 0.5, 2.3),
    "medium": Armor(13.0, 455.0, 3.0, 8.0, 110.0, 320.0, 17.0, 80.0, 31.25, 0.005, 0.7, 2.4),
    "heavy": Armor(18.0, 630.0, 4.5, 5.0, 150.0, 385.0, 12.0, 110.0, 34.375, 0.006, 0.8, 2.6),
}


@dataclass(frozen=True)
class Rules:
    """What is uniform over a batch."""

    armor: Armor
    #: "article" or "engine": section 12's two models.
    engine: bool
    tick_ms: int
    energy_pack: bool = False
    hysteresis: bool = True

    @property
    def dt(self) -> float:
        """Tick length, s."""
        return self.tick_ms / 1000.0

    @property
    def grace(self) -> int:
        """Age from which a contact allows no jump: ms, `engine` ticks."""
        return 8 if self.engine else 256

    @property
    def push(self) -> float:
        """Outward speed that a contact adds, m/s."""
        return 1e-4 if self.engine else 1e-3


@dataclass(frozen=True)
class Pushed:
    """Velocities (n, 3) in the order of a tick, m/s, and what of it burned."""

    #: After the jump.
    jumped: Floats
    #: What the jets add.
    thrust: Floats
    #: What friction adds, which is walking too.
    walk: Floats
    #: What the move begins with.
    final: Floats


def horizontal(yaw: Floats, forward: Floats, right: Floats) -> Floats:
    """(n, 3): so much forward and right of a view."""
    sin, cos = np.sin(yaw), np.cos(yaw)
    return np.stack([right * cos - forward * sin, forward * cos + right * sin, np.zeros_like(yaw)], axis=-1)


def wish(rules: Rules, yaw: Floats, inputs: Rows) -> tuple[Floats, Floats]:
    """Wished velocity and its direction (zero where none), each (n, 3): sections 3.1 and 3.2."""
    forward, strafe = inputs["forward"].astype(np.float64), inputs["strafe"].astype(np.float64)
    top, side = rules.armor.walk_speed, rules.armor.walk_speed - 1.0
    ahead = forward * (np.where(forward < 0.0, side, top) if rules.engine else top)
    velocity = horizontal(yaw, ahead, strafe * side)
    longest = np.maximum(np.abs(ahead), np.abs(strafe * side)) if rules.engine else np.full_like(ahead, top)
    length = np.linalg.norm(velocity, axis=-1)
    shortened = np.minimum(1.0, longest / np.where(length > 0.0, length, 1.0))
    keyed = horizontal(yaw, forward, strafe) if rules.engine else velocity
    size = np.linalg.norm(keyed, axis=-1)
    return velocity * shortened[:, None], keyed / np.where(size > 0.0, size, 1.0)[:, None]


def pushed(rules: Rules, before: Rows, after: Rows, inputs: Rows) -> Pushed:
    """The velocities of a tick up to the move (section 3).

    Args:
        rules: of the batch.
        before: states, (n,).
        after: the same a tick later: of it only the view, which turns first, and whether the jets burned.
        inputs: dtype `INPUT`, (n,).
    """
    armor, dt = rules.armor, rules.dt
    velocity = before["velocity"].astype(np.float64)
    wished, direction = wish(rules, after["yaw"].astype(np.float64), inputs)

    normal = before["jump_normal"].astype(np.float64)
    jumps = inputs["jump"] & (before["jump_age"] < rules.grace)
    leap = armor.jump_impulse / armor.mass
    along = np.maximum(0.0, np.sum(normal * direction, axis=-1))
    jump = direction * (leap * along)[:, None]
    jump[:, 2] += leap * normal[:, 2]
    jumped = velocity + np.where(jumps[:, None], jump, 0.0)

    age = np.where(jumps, rules.grace, before["jump_age"])
    recent = age <= rules.grace if rules.engine else age < rules.grace
    full = armor.jet_force / armor.mass * dt
    speed = np.sum(jumped * direction, axis=-1)
    share = np.where(speed < 0.0, 1.0, 1.0 - speed / armor.fade_speed)
    share = np.minimum(np.where(speed > armor.fade_speed, 0.0, share), 0.8)
    straight_up = recent | ~direction.any(axis=-1)
    share = np.where(straight_up, 0.0, share)
    thrust = direction * (share * full)[:, None]
    thrust[:, 2] += (1.0 - share) * full
    thrust = np.where(after["jetting"][:, None], thrust, 0.0)

    falling = jumped + thrust
    falling[:, 2] -= GRAVITY * dt
    wanted = (wished - falling) * (1.0, 1.0, 0.0)
    size = np.linalg.norm(wanted, axis=-1)
    grip = np.minimum(armor.traction * before["friction"].astype(np.float64), 1.0)
    cap = armor.ground_force / armor.mass * dt * grip
    short = np.minimum(1.0, cap / np.where(size > 0.0, size, 1.0))
    walk = np.where(before["touched"][:, None], wanted * short[:, None], 0.0)
    return Pushed(jumped, thrust, walk, falling + walk)
