"""The mission's solids: over the deck, up its ramps, off its sides, and through a base."""

import numpy as np

from discjump._native import Terrain
from discjump.accuracy import scripts
from discjump.accuracy.grounds import Floats
from discjump.accuracy.plays import Places, Play

CLEARANCE = 0.25
"""Of the feet above what they start over, m."""


def bridge(rng: np.random.Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """A quarter each: along the deck, up its ramps, off its sides, through a base.

    Every third player runs, the others hold jump.
    """
    mission = terrain.mission
    assert mission is not None, "generated terrains have one"
    kind = np.arange(count) % 4
    on_deck = (kind == 0) | (kind == 2)

    # From one end of the bridge to the other, or from before the open side of a base to its back.
    way = rng.integers(0, 2, count)
    ends, flags = mission["bridge_ends"][:, :2], mission["flags"][:, :2]
    origin = np.where((kind == 3)[:, None], flags[way], ends[way])
    forward = np.where((kind == 3)[:, None], flags[way] - flags[1 - way], ends[1 - way] - ends[way])
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)

    def drawn(*bounds: tuple[float, float]) -> Floats:
        """Uniform, with the bounds of each player's kind."""
        low, high = np.array(bounds)[kind].T
        numbers: Floats = rng.uniform(low, high)
        return numbers

    along = drawn((2.0, 40.0), (-30.0, -15.0), (10.0, 110.0), (-40.0, -28.0))
    across = drawn((-6.0, 6.0), (-6.0, 6.0), (-4.0, 4.0), (-8.0, 8.0))
    aside = drawn((-0.05, 0.05), (-0.1, 0.1), (0.5, 1.2), (-0.1, 0.1)) * rng.choice([-1.0, 1.0], count)
    right = np.column_stack([forward[:, 1], -forward[:, 0]])
    xy = (origin + along[:, None] * forward + across[:, None] * right).astype(np.float32).astype(np.float64)
    places = Places(xy, np.arctan2(-forward[:, 0], forward[:, 1]) + aside)

    position = places.above(terrain, CLEARANCE)
    deck = mission["bridge_deck_top"] + CLEARANCE
    position[:, 2] = np.where(on_deck, np.maximum(position[:, 2], deck), position[:, 2])
    speed = drawn((5.0, 30.0), (10.0, 30.0), (5.0, 30.0), (5.0, 25.0))
    level = np.column_stack([speed[:, None] * places.ahead, np.zeros(count)])
    velocity = np.where(on_deck[:, None], level, places.along(terrain, speed))

    inputs = scripts.held(ticks, count, forward=1, jump=True)
    inputs["jump"][:, ::3] = False
    return Play(name, terrain, "mission", position, velocity, places.yaw, inputs)
