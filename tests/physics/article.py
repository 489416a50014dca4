"""The `article` model in plain float64 Python, from the text of core/docs/physics.md alone (3.1, 4, 5.2, 12).

It shares nothing with the Rust code but that page, so where both agree the page has one reading."""

import math
from dataclasses import dataclass, field

from .ground import Ground, Vec, along, dot

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
    jump_impulse: float
    jet_force: float
    fade_out_speed: float
    max_energy: float
    drain: float
    """Per second."""
    landing_scale: float


ARMORS = {
    "light": Armor(9, 360, 3.0, 11, 75, 236, 22, 60, 25.0, 0.005),
    "medium": Armor(13, 455, 3.0, 8, 110, 320, 17, 80, 31.25, 0.005),
    "heavy": Armor(18, 630, 4.5, 5, 150, 385, 12, 110, 34.375, 0.006),
}


@dataclass(frozen=True)
class Rules:
    armor: Armor = ARMORS["light"]
    tick_ms: int = 32
    recharge: float = 8.0
    hysteresis: bool = True
    ski_bug: bool = False


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


def norm(a: Vec) -> float:
    return math.sqrt(dot(a, a))


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


def thrust(player: Player, u: Vec | None, armor: Armor) -> Vec:
    """Section 4.2."""
    full = armor.jet_force / armor.mass
    if u is None or player.jump_age < GRACE_MS:
        return (0.0, 0.0, full)
    s0 = dot(player.velocity, u)
    if s0 > armor.fade_out_speed:
        share = 0.0
    elif s0 < 0.0:
        share = 1.0
    else:
        share = 1.0 - s0 / armor.fade_out_speed
    share = min(share, MAX_SIDEWAYS)
    return (share * full * u[0], share * full * u[1], (1.0 - share) * full)


def rub(player: Player, wanted: Vec, armor: Armor, dt: float) -> None:
    """Section 4.3."""
    dx, dy = wanted[0] - player.velocity[0], wanted[1] - player.velocity[1]
    change = math.sqrt(dx * dx + dy * dy)
    cap = armor.ground_force / armor.mass * min(armor.traction * player.friction, 1.0) * dt
    if change > cap:
        dx, dy = dx * cap / change, dy * cap / change
    else:
        player.crawled = True
    player.velocity = (player.velocity[0] + dx, player.velocity[1] + dy, player.velocity[2])


def tick(player: Player, keys: Keys, ground: Ground, rules: Rules) -> None:
    """Section 3.1, after section 12's step (0)."""
    dt, armor = rules.tick_ms / 1000.0, rules.armor
    player.yaw = (player.yaw + keys.turn * dt + math.pi) % (2.0 * math.pi) - math.pi

    wanted, u = wish(player, keys, rules)

    if not keys.jet:
        player.jetting = False
    elif not rules.hysteresis:
        player.jetting = player.energy > 0.0
    else:
        player.jetting = player.energy > 1.0 if player.jetting else player.energy >= 5.0

    if keys.jump and player.jump_age < GRACE_MS:
        speed, normal = armor.jump_impulse / armor.mass, player.jump_normal
        if u is not None:
            player.velocity = along(player.velocity, u, speed * max(0.0, dot(normal, u)))
        player.velocity = along(player.velocity, UP, speed * normal[2])
        player.jump_age = GRACE_MS

    player.crawled = norm(player.velocity) < CRAWL_SPEED

    acceleration: Vec = (0.0, 0.0, -GRAVITY)
    player.energy += rules.recharge * dt
    if player.jetting:
        acceleration = along(thrust(player, u, armor), UP, -GRAVITY)
        player.energy -= armor.drain * dt
    player.energy = min(max(player.energy, 0.0), armor.max_energy)

    player.velocity = along(player.velocity, acceleration, dt)
    if player.touched:
        rub(player, wanted, armor, dt)
    player.jump_age += rules.tick_ms
    move(player, ground, rules, dt)


def move(player: Player, ground: Ground, rules: Rules, dt: float) -> None:
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
            normal = ground.sweep(player.position, along((0.0, 0.0, 0.0), player.velocity, h))
            if normal is None:
                player.position = along(player.position, player.velocity, h)
                left = 0.0 if s == slices - 1 else left - h
                continue
            touch(player, normal, rules)
            bumps += 1
            if normal[2] > 0.0 and player.crawled and norm(player.velocity) < STOP_SPEED:
                player.velocity, player.position = (0.0, 0.0, 0.0), begin
                stopped = True
            break
    if bumps == MAX_BUMPS and rules.ski_bug:
        player.velocity = (0.0, 0.0, 0.0)
    if player.touched:
        player.friction = min(1.0, max(player.friction, FRICTION_MEMORY * old_friction))


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
