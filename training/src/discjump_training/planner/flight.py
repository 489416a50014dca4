"""Where a flight leads that goes on with all of its jets: by how much it misses a marker.

Free flight and jets straight up are parabolas (core/docs/physics.md, sections 2 and 4): the jets last as long
as the tank, which recharges meanwhile.
"""

import numpy as np

from discjump_training.policy import Floats, Layout, Observations

GRAVITY = 20.0
#: Acceleration upwards with jets, m/s^2, and energy that they use up in a second, by armor.
CLIMB = {"light": 236 / 9 - GRAVITY, "medium": 320 / 13 - GRAVITY, "heavy": 385 / 18 - GRAVITY}
DRAIN = {"light": 25.0 - 8.0, "medium": 31.25 - 8.0, "heavy": 34.375 - 8.0}
#: Energy below which jets go out.
CUT = 1.0
#: What a second until the marker counts, m: of two flights that reach it the sooner one is better.
HASTE = 0.05


def apex(rise: Floats, energy: Floats, armor: str) -> tuple[Floats, Floats]:
    """How much higher a flight leads with jets to the end, m, and after which time, s.

    Args:
        rise: vertical speed, m/s, (n,).
        energy: in the tank, (n,).
        armor: of the player.
    """
    burn = np.maximum(energy - CUT, 0.0) / DRAIN[armor]
    fast = rise + CLIMB[armor] * burn
    height = rise * burn + 0.5 * CLIMB[armor] * burn**2
    free = np.maximum(fast, 0.0)
    return height + free**2 / (2 * GRAVITY), burn + free / GRAVITY


def miss(layout: Layout, observations: Observations, armor: str, radius: float) -> Floats:
    """How far a flight passes by the marker that goes on with all of its jets, and no direction pressed, m.

    (n,): the height that it lacks, and the horizontal distance beyond the radius when it is as high as the
    marker, or highest; and a little for the time until then.
    """
    velocity = layout.read(observations, "velocity")
    near = layout.read(observations, "goal_near")[:, :2]
    above = layout.read(observations, "goal_height")[:, 0]
    energy = layout.read(observations, "energy")[:, 0]
    height, time = apex(velocity[:, 2], energy, armor)
    # Up two parabolas, told as one: as if the whole way to the apex were free flight.
    share = 1.0 - np.sqrt(np.clip(1.0 - above / np.maximum(height, 1e-9), 0.0, 1.0))
    until = time * np.where(above > 0.0, share, 0.0)
    aside = np.linalg.norm(near - velocity[:, :2] * until[:, np.newaxis], axis=1)
    found: Floats = np.maximum(above - height, 0.0) + np.maximum(aside - 0.75 * radius, 0.0) + HASTE * until
    return found
