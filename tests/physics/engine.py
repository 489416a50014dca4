"""The `engine` model in plain float64 Python, from the text of core/docs/physics.md alone (3.2, 4, 5.3, 12).

Its players are the article's, but `jump_age` counts ticks, and a fresh player has an age of 100."""

import math
from typing import Any

from .article import (
    CRAWL_SPEED,
    FRICTION_MEMORY,
    GRAVITY,
    MIN_JUMPABLE,
    STOP_SPEED,
    UP,
    Armor,
    Keys,
    Player,
    Rules,
    ignite,
    leap,
    norm,
    rub,
    scaled,
    thrust,
    turned,
)
from .article import standing as fresh
from .ground import Surface, Vec, along, dot

GRACE_TICKS = 8
FRESH_AGE = 100
ATTEMPTS = 3
STEP = 0.3
STEP_AFTER_HIT = 0.075
OUTWARD_PUSH = 0.0001
FORGOTTEN = 0.1
PLAIN_RECHARGE = 8.0


def standing(position: Vec = (0.0, 0.0, 0.0), velocity: Vec = (0.0, 0.0, 0.0), **fields: Any) -> Player:
    return fresh(position, velocity, **({"jump_age": FRESH_AGE} | fields))


def wish(yaw: float, keys: Keys, armor: Armor) -> tuple[Vec, Vec | None]:
    """Wish velocity, and the direction of jump and jets, which weighs both axes the same (3.1, step 1)."""
    fore = armor.walk_speed if keys.forward > 0 else armor.walk_speed - 1.0
    side = armor.walk_speed - 1.0
    sin, cos = math.sin(yaw), math.cos(yaw)
    ahead, aside = fore * keys.forward, side * keys.strafe
    velocity: Vec = (-sin * ahead + cos * aside, cos * ahead + sin * aside, 0.0)
    if norm(velocity) > max(fore, side):
        velocity = scaled(velocity, max(fore, side) / norm(velocity))
    keyed: Vec = (-sin * keys.forward + cos * keys.strafe, cos * keys.forward + sin * keys.strafe, 0.0)
    return velocity, scaled(keyed, 1.0 / norm(keyed)) if keys.forward or keys.strafe else None


def tick(player: Player, keys: Keys, ground: Surface, rules: Rules) -> None:
    """Section 3.2, after section 12's step (0). Recharge beyond 8 per second is the pack's."""
    dt, armor = rules.tick_ms / 1000.0, rules.armor
    player.yaw = turned(player.yaw, keys.turn, dt)
    # A full tank takes nothing from the pack: else a medium burns 123 ticks, not section 10's 122.
    player.energy = min(player.energy + (rules.recharge - PLAIN_RECHARGE) * dt, armor.max_energy)
    wanted, u = wish(player.yaw, keys, armor)

    if keys.jump and player.jump_age < GRACE_TICKS:
        player.jump_age = GRACE_TICKS
        player.velocity = leap(player.velocity, player.jump_normal, u, armor)

    acceleration: Vec = (0.0, 0.0, -GRAVITY)
    player.jetting = ignite(player, keys.jet, rules.hysteresis)
    if player.jetting:
        sideways = None if player.jump_age <= GRACE_TICKS else u
        acceleration = along(thrust(player.velocity, sideways, armor), UP, -GRAVITY)
        player.energy -= armor.drain * dt
    player.energy = min(max(player.energy + PLAIN_RECHARGE * dt, 0.0), armor.max_energy)

    old_velocity = player.velocity
    player.velocity = along(player.velocity, acceleration, dt)
    if player.touched:
        player.crawled = rub(player, wanted, armor, dt)
    else:
        player.crawled = norm(old_velocity) < CRAWL_SPEED
    target = along(along(player.position, old_velocity, 0.5 * dt), player.velocity, 0.5 * dt)

    memory = FRICTION_MEMORY * player.friction
    memory = 0.0 if memory < FORGOTTEN else memory
    player.friction = 0.0
    move(player, target, ground, rules, dt)
    player.friction = min(max(player.friction, memory), 1.0)
    player.jump_age += 1


def move(player: Player, target: Vec, ground: Surface, rules: Rules, dt: float) -> None:
    """Section 5.3."""
    player.touched, player.contacts = False, []
    gone, step = 0.0, STEP
    for _ in range(ATTEMPTS):
        path = along(target, player.position, -1.0)
        count = math.ceil(norm(path) / step)
        hit = False
        for s in range(count):
            there = along(player.position, path, 1.0 / count)
            plane = ground.plane_at(there[0], there[1])
            radius = 0.5 * rules.armor.height
            depth = plane.distance(along(there, UP, radius))
            if abs(depth) < radius:
                gone += s * (dt - gone) / count
                player.touched = True
                if depth >= 0.0 and dot(player.velocity, plane.normal) < 0.0:
                    hit = True
                    touch(player, plane.normal, rules)
                    break
            player.position = there
        if not hit:
            return
        target, step = along(player.position, player.velocity, dt - gone), STEP_AFTER_HIT
    if rules.ski_bug:
        player.velocity = (0.0, 0.0, 0.0)


def touch(player: Player, normal: Vec, rules: Rules) -> None:
    """Damage, jump normal and age (section 4.1), bounce, grip, stop test."""
    player.contacts.append(normal)
    impact = -dot(player.velocity, normal)
    player.damage += max(0.0, impact - 25.0) * rules.armor.landing_scale
    # The age grows after the move, so a contact in the tick before has age 1 here.
    if normal[2] > MIN_JUMPABLE and (player.jump_age > 1 or normal[2] > player.jump_normal[2]):
        player.jump_normal, player.jump_age = normal, 0
    player.velocity = along(player.velocity, normal, impact + OUTWARD_PUSH)
    player.friction += normal[2]
    if player.crawled and norm(player.velocity) < STOP_SPEED * normal[2]:
        player.velocity = (0.0, 0.0, 0.0)
