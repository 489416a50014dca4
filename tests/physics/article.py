"""The `article` model in plain float64 Python, from the text of core/docs/physics.md alone (3.1, 4, 5.2, 12).

It shares nothing with the Rust code but that page, so where both agree the page has one reading. The other
witnesses stand beside it: `swept` and `anyway` (other moves of the same tick), `engine`, `blast`, `disc`."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from .ground import Surface, Vec, along, dot

UP: Vec = (0.0, 0.0, 1.0)
GRAVITY = 20.0
GRACE_MS = 256
MAX_BUMPS = 4
SLICE = 1.0
OUTWARD_PUSH = 0.001
MIN_JUMPABLE = 0.2
MAX_SIDEWAYS = 0.8
STOP_SPEED = 0.75
CRAWL_SPEED = 0.1
FRICTION_MEMORY = 0.6


@dataclass(frozen=True)
class Armor:
    """A column of section 2's table."""

    mass: float
    ground_force: float
    traction: float
    walk_speed: float
    """Forward. To the back and sideways it is 1 m/s less in the engine, sideways in the article."""
    jump_impulse: float
    jet_force: float
    fade_out_speed: float
    max_energy: float
    drain: float
    """Per second."""
    landing_scale: float
    half_width: float
    height: float
    blast_scales: tuple[float, float, float]
    """Factors of the damage by explosion, shrapnel and mortar."""


ARMORS = {
    "light": Armor(9, 360, 3.0, 11, 75, 236, 22, 60, 25.0, 0.005, 0.5, 2.3, (1.0, 1.2, 1.3)),
    "medium": Armor(13, 455, 3.0, 8, 110, 320, 17, 80, 31.25, 0.005, 0.7, 2.4, (1.0, 1.0, 1.0)),
    "heavy": Armor(18, 630, 4.5, 5, 150, 385, 12, 110, 34.375, 0.006, 0.8, 2.6, (0.6, 0.8, 0.7)),
}


@dataclass(frozen=True)
class Rules:
    armor: Armor = ARMORS["light"]
    tick_ms: int = 32
    recharge: float = 8.0
    hysteresis: bool = True
    ski_bug: bool = False
    clamp_fixup: bool = False
    fixup_swept: bool = False


@dataclass(frozen=True)
class Keys:
    forward: int = 0
    strafe: int = 0
    jump: bool = False
    jet: bool = False
    turn: float = 0.0


@dataclass
class Player:
    position: Vec
    velocity: Vec
    yaw: float
    energy: float
    damage: float
    jetting: bool
    touched: bool
    crawled: bool
    friction: float
    jump_normal: Vec
    jump_age: int
    #: Normals of the contacts of the last tick.
    contacts: list[Vec] = field(default_factory=list)


def standing(position: Vec = (0.0, 0.0, 0.0), velocity: Vec = (0.0, 0.0, 0.0), **fields: Any) -> Player:
    """A fresh player of the article's model, with other `fields` where given."""
    fresh: dict[str, Any] = {
        "yaw": 0.0,
        "energy": 60.0,
        "damage": 0.0,
        "jetting": False,
        "touched": False,
        "crawled": False,
        "friction": 0.0,
        "jump_normal": UP,
        "jump_age": GRACE_MS,
    }
    return Player(position, velocity, **(fresh | fields))


def norm(a: Vec) -> float:
    return math.sqrt(dot(a, a))


def scaled(a: Vec, s: float) -> Vec:
    return (s * a[0], s * a[1], s * a[2])


def wish(player: Player, keys: Keys, rules: Rules) -> tuple[Vec, Vec | None]:
    """Step 1: wish velocity and its direction, None without keys."""
    speed = rules.armor.walk_speed
    ahead, aside = speed * keys.forward, (speed - 1.0) * keys.strafe
    sin, cos = math.sin(player.yaw), math.cos(player.yaw)
    velocity: Vec = (-sin * ahead + cos * aside, cos * ahead + sin * aside, 0.0)
    length = norm(velocity)
    if length == 0.0:
        return velocity, None
    direction = (velocity[0] / length, velocity[1] / length, 0.0)
    if length > speed:
        velocity = (direction[0] * speed, direction[1] * speed, 0.0)
    return velocity, direction


def ignite(player: Player, wanted: bool, hysteresis: bool) -> bool:
    """Whether the jets burn in this tick (section 4.2)."""
    if not wanted or not hysteresis:
        return wanted and player.energy > 0.0
    return player.energy > 1.0 if player.jetting else player.energy >= 5.0


def thrust(velocity: Vec, u: Vec | None, armor: Armor) -> Vec:
    """Section 4.2. `u` is None without keys, and where the last contact is too recent."""
    full = armor.jet_force / armor.mass
    if u is None:
        return (0.0, 0.0, full)
    s0 = dot(velocity, u)
    if s0 > armor.fade_out_speed:
        share = 0.0
    elif s0 < 0.0:
        share = 1.0
    else:
        share = 1.0 - s0 / armor.fade_out_speed
    share = min(share, MAX_SIDEWAYS)
    return (share * full * u[0], share * full * u[1], (1.0 - share) * full)


def leap(velocity: Vec, normal: Vec, u: Vec | None, armor: Armor) -> Vec:
    """The velocity after a jump (section 4.1)."""
    speed = armor.jump_impulse / armor.mass
    if u is not None:
        velocity = along(velocity, u, speed * max(0.0, dot(normal, u)))
    return along(velocity, UP, speed * normal[2])


def rub(player: Player, wanted: Vec, armor: Armor, dt: float) -> bool:
    """Section 4.3. Whether the wanted change was within the cap."""
    dx, dy = wanted[0] - player.velocity[0], wanted[1] - player.velocity[1]
    change = math.sqrt(dx * dx + dy * dy)
    cap = armor.ground_force / armor.mass * min(armor.traction * player.friction, 1.0) * dt
    if change > cap:
        dx, dy = dx * cap / change, dy * cap / change
    player.velocity = (player.velocity[0] + dx, player.velocity[1] + dy, player.velocity[2])
    return change <= cap


def turned(yaw: float, turn: float, dt: float) -> float:
    """Section 12's step (0): wrapped to [-pi, pi)."""
    return (yaw + turn * dt + math.pi) % (2.0 * math.pi) - math.pi


def move(player: Player, ground: Surface, rules: Rules, dt: float) -> None:
    """Section 5.2, the restart form."""
    left, bumps, old_friction = dt, 0, player.friction
    player.friction, player.touched, player.contacts = 0.0, False, []
    stopped = False
    while bumps < MAX_BUMPS and left > 0.0 and not stopped:
        slices = math.ceil(norm(player.velocity) * left / SLICE)
        if slices == 0:
            break
        h, begin = left / slices, player.position
        for s in range(slices):
            hit = ground.sweep(player.position, scaled(player.velocity, h))
            if hit is None:
                player.position = along(player.position, player.velocity, h)
                left = 0.0 if s == slices - 1 else left - h
                continue
            touch(player, hit.normal, rules)
            bumps += 1
            stopped = stops(player, hit.normal, begin)
            break
    finish(player, bumps, old_friction, rules)


def touch(player: Player, normal: Vec, rules: Rules) -> None:
    """Contact response: damage, jump normal and age (section 4.1), bounce, grip."""
    player.touched = True
    player.contacts.append(normal)
    impact = -dot(player.velocity, normal)
    player.damage += max(0.0, impact - 25.0) * rules.armor.landing_scale
    if normal[2] >= MIN_JUMPABLE and (player.jump_age > rules.tick_ms or normal[2] < player.jump_normal[2]):
        player.jump_normal, player.jump_age = normal, 0
    player.velocity = along(player.velocity, normal, impact + OUTWARD_PUSH)
    if normal[2] > 0.0:
        player.friction = normal[2]


def stops(player: Player, normal: Vec, begin: Vec) -> bool:
    """The stop test of section 4.4, after a bounce."""
    if not (normal[2] > 0.0 and player.crawled and norm(player.velocity) < STOP_SPEED):
        return False
    player.velocity, player.position = (0.0, 0.0, 0.0), begin
    return True


def finish(player: Player, bumps: int, old_friction: float, rules: Rules) -> None:
    """The bump limit, and the friction memory of section 4.4."""
    if bumps == MAX_BUMPS and rules.ski_bug:
        player.velocity = (0.0, 0.0, 0.0)
    if player.touched:
        player.friction = min(1.0, max(player.friction, FRICTION_MEMORY * old_friction))


#: Section 5: from a velocity to a place. Sets touched, friction, jump normal and age, damage.
Move = Callable[[Player, Surface, Rules, float], None]


def tick(player: Player, keys: Keys, ground: Surface, rules: Rules, move: Move = move) -> None:
    """Section 3.1, after section 12's step (0)."""
    dt, armor = rules.tick_ms / 1000.0, rules.armor
    player.yaw = turned(player.yaw, keys.turn, dt)

    wanted, u = wish(player, keys, rules)
    player.jetting = ignite(player, keys.jet, rules.hysteresis)

    if keys.jump and player.jump_age < GRACE_MS:
        player.velocity = leap(player.velocity, player.jump_normal, u, armor)
        player.jump_age = GRACE_MS

    player.crawled = norm(player.velocity) < CRAWL_SPEED

    acceleration: Vec = (0.0, 0.0, -GRAVITY)
    player.energy += rules.recharge * dt
    if player.jetting:
        sideways = None if player.jump_age < GRACE_MS else u
        acceleration = along(thrust(player.velocity, sideways, armor), UP, -GRAVITY)
        player.energy -= armor.drain * dt
    player.energy = min(max(player.energy, 0.0), armor.max_energy)

    player.velocity = along(player.velocity, acceleration, dt)
    if player.touched and rub(player, wanted, armor, dt):
        player.crawled = True
    player.jump_age += rules.tick_ms
    move(player, ground, rules, dt)
