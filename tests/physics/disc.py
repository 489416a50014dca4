"""The disc launcher in plain float64 Python, from the text of core/docs/physics.md alone (7 and 12)."""

import math
from dataclasses import dataclass, field

from .article import Armor, Player, scaled
from .blast import DISC, Charge, explode
from .ground import Surface, Vec, along, dot
from .shell import SHELLS
from .shell import fly as fly_shell

MUZZLE_SPEED = 65.0
TERMINAL_SPEED = 80.0
INHERITED = 0.5
#: m/s^2, by the name of the switch `accel`: a force of 5 by nothing, and by the disc's mass of 2.
ACCELERATIONS = {"none": 0.0, "nominal": 5.0, "mass": 2.5}
#: m to the right, forward and up from the feet.
MUZZLE = (0.2, 0.5, 1.5)
STEEPEST_AIM = math.radians(88.0)
LIFE_MS = 6500
CYCLE_MS = (1250, 250, 250)
#: The engine's disc: a sub-step moves it by 1/30 s, and takes 33 ms of the clock.
ENGINE_STEP = 1.0 / 30.0
ENGINE_CLOCK_MS = 33


def whole_ticks(ms: int, tick_ms: int) -> int:
    return -(-ms // tick_ms)


def aim(yaw: float, pitch: float) -> Vec:
    pitch = min(max(pitch, -STEEPEST_AIM), STEEPEST_AIM)
    return (-math.sin(yaw) * math.cos(pitch), math.cos(yaw) * math.cos(pitch), math.sin(pitch))


@dataclass(frozen=True)
class Launcher:
    #: "disc" or a key of `SHELLS`
    weapon: str = "disc"
    tick_ms: int = 32
    accel: str = "nominal"
    #: "surface" or "engine"
    disc: str = "surface"
    formula: str = "tribes"
    cutoff: str = "engine"

    @property
    def charge(self) -> Charge:
        return DISC if self.weapon == "disc" else SHELLS[self.weapon].charge

    @property
    def speed(self) -> float:
        return MUZZLE_SPEED if self.weapon == "disc" else SHELLS[self.weapon].speed

    @property
    def cycle(self) -> int:
        """Ticks from one shot to the next; every state waits for a whole tick."""
        states = CYCLE_MS if self.weapon == "disc" else SHELLS[self.weapon].cycle_ms
        return sum(whole_ticks(ms, self.tick_ms) for ms in states)

    @property
    def life(self) -> int:
        """The tick in which a disc vanishes, the shot's being the first."""
        return whole_ticks(LIFE_MS, self.tick_ms)


@dataclass
class Disc:
    position: Vec
    velocity: Vec
    aim: Vec
    #: Ticks since the shot's, which is 0.
    age: int = 0
    steps: int = 0


@dataclass
class Shooter:
    """What a player holds: the launcher's state and his discs in flight."""

    ammo: int = 15
    wait: int = 0
    discs: list[Disc] = field(default_factory=list)


def fire(player: Player, pitch: float, shooter: Shooter, launcher: Launcher) -> None:
    """Step (1) of a tick with the trigger held: from the position and velocity before the move."""
    if shooter.wait > 0 or shooter.ammo == 0:
        return
    shooter.ammo -= 1
    shooter.wait = launcher.cycle
    sin, cos = math.sin(player.yaw), math.cos(player.yaw)
    right, forward, up = MUZZLE
    offset = (cos * right - sin * forward, sin * right + cos * forward, up)
    direction = aim(player.yaw, pitch)
    velocity = along(scaled(player.velocity, INHERITED), direction, launcher.speed)
    shooter.discs.append(Disc(along(player.position, offset, 1.0), velocity, direction))


def fly(disc: Disc, ground: Surface, launcher: Launcher) -> tuple[bool, Vec | None]:
    """Step (3) for one disc: whether it is still there, and where it burst."""
    age = disc.age
    disc.age += 1
    if launcher.weapon != "disc":
        shell = SHELLS[launcher.weapon]
        armed = age * launcher.tick_ms >= shell.arm_ms
        disc.position, disc.velocity, burst = fly_shell(
            disc.position, disc.velocity, shell, armed, ground, launcher.tick_ms / 1000.0
        )
        return (False, disc.position) if burst else (True, None)
    if age + 1 >= launcher.life:
        return False, None
    if launcher.disc == "engine":
        return fly_engine(disc, age, ground, launcher)
    dt = launcher.tick_ms / 1000.0
    lacking = TERMINAL_SPEED - dot(disc.velocity, disc.aim)
    gain = max(0.0, min(ACCELERATIONS[launcher.accel] * dt, lacking))
    disc.velocity = along(disc.velocity, disc.aim, gain)
    path = scaled(disc.velocity, dt)
    hit = ground.crossing(disc.position, path)
    disc.steps += 1
    if hit is not None:
        return False, along(disc.position, path, hit.fraction)
    disc.position = along(disc.position, path, 1.0)
    return True, None


def fly_engine(disc: Disc, age: int, ground: Surface, launcher: Launcher) -> tuple[bool, Vec | None]:
    terminal = scaled(disc.aim, TERMINAL_SPEED)
    if all(abs(v) >= abs(t) for v, t in zip(disc.velocity, terminal, strict=True)):
        disc.velocity = terminal
    due = age * launcher.tick_ms // ENGINE_CLOCK_MS - max(age - 1, 0) * launcher.tick_ms // ENGINE_CLOCK_MS
    for _ in range(due):
        path = scaled(disc.velocity, ENGINE_STEP)
        disc.steps += 1
        if ground.crossing(disc.position, path) is not None:
            return False, disc.position
        disc.position = along(disc.position, path, 1.0)
    return True, None


def after_move(
    player: Player, shooter: Shooter, ground: Surface, launcher: Launcher, armor: Armor
) -> list[Vec]:
    """Steps (3) and (4) for a player alone in his world: discs fly, blasts act. Where they burst."""
    burst = []
    kept = []
    for disc in shooter.discs:
        alive, point = fly(disc, ground, launcher)
        if alive:
            kept.append(disc)
        elif point is not None:
            burst.append(point)
    shooter.discs = kept
    shooter.wait = max(0, shooter.wait - 1)
    for point in burst:
        explode(player, armor, point, ground, launcher.charge, launcher.formula, launcher.cutoff)
    return burst
