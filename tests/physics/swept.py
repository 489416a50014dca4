"""Section 5.1 of core/docs/physics.md: one sweep a bump, then the last slice anew with the new velocity."""

import math

from .article import MAX_BUMPS, SLICE, Player, Rules, finish, norm, scaled, stops, touch
from .ground import Surface, along


def move(player: Player, ground: Surface, rules: Rules, dt: float) -> None:
    left, bumps, old_friction = dt, 0, player.friction
    player.friction, player.touched, player.contacts = 0.0, False, []
    while bumps < MAX_BUMPS and left > 0.0:
        path, begin, old_velocity = scaled(player.velocity, left), player.position, player.velocity
        slices = math.ceil(norm(path) / SLICE)
        if slices == 0:
            break
        h = left / slices
        hit = ground.sweep(begin, path)
        if hit is None:
            player.position = along(begin, path, 1.0)
            break
        used = hit.fraction * left
        left -= used
        touch(player, hit.normal, rules)
        # A hit at once makes k zero and `full` negative: the player is pushed out along the normal.
        k = math.ceil(used / h)
        if rules.clamp_fixup:
            k = max(k, 1)
        full = (k - 1) * h
        start, fix = along(begin, old_velocity, full), scaled(player.velocity, used - full)
        # Where a blocked one ends the page does not say: here it is not made at all.
        blocked = rules.fixup_swept and ground.sweep(start, fix) is not None
        player.position = start if blocked else along(start, fix, 1.0)
        bumps += 1
        if stops(player, hit.normal, begin):
            break
    finish(player, bumps, old_friction, rules)
