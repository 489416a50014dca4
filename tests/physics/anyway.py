"""The literal "anyway" form of section 5.2: after a bounce the slice is made with the new velocity, untested.

The slices are not made anew: the length of time of a slice stays that of the tick's begin."""

import math

from .article import MAX_BUMPS, SLICE, Player, Rules, finish, norm, scaled, stops, touch
from .ground import Surface, along


def move(player: Player, ground: Surface, rules: Rules, dt: float) -> None:
    bumps, old_friction, begin = 0, player.friction, player.position
    player.friction, player.touched, player.contacts = 0.0, False, []
    slices = math.ceil(norm(player.velocity) * dt / SLICE)
    for _ in range(slices):
        h = dt / slices
        hit = ground.sweep(player.position, scaled(player.velocity, h))
        if hit is not None:
            touch(player, hit.normal, rules)
            bumps += 1
            if stops(player, hit.normal, begin):
                break
        player.position = along(player.position, player.velocity, h)
        if bumps == MAX_BUMPS:
            break
    finish(player, bumps, old_friction, rules)
