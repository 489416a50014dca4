"""Where a flight leads that goes on with all of its jets: by how much it misses a marker.

Jets straight up make parabolas (core/docs/physics.md, sections 2 and 4): one as long as the tank lasts, which
recharges meanwhile, and another after it, when what is recharged lights the jets now and then.
"""

import numpy as np

from discjump_training.policy import Floats, Layout, Observations

GRAVITY, RECHARGE = 20.0, 8.0
#: Acceleration by jets, m/s^2, and energy that they take in a second, by armor.
THRUST = {"light": 236 / 9, "medium": 320 / 13, "heavy": 385 / 18}
DRAIN = {"light": 25.0, "medium": 31.25, "heavy": 34.375}
#: Energy that stays in the tank on average: jets go out at 1 and light again at 5.
KEPT = 3.0
#: What a second until the marker counts, m: of two flights that reach it the sooner one is better.
HASTE = 0.05


def apex(rise: Floats, energy: Floats, armor: str) -> tuple[Floats, Floats]:
    """How much higher a flight leads with jets to the end, m, and after which time, s.

    Args:
        rise: vertical speed, m/s, (n,).
        energy: in the tank, (n,).
        armor: of the player.
    """
    thrust, drain = THRUST[armor], DRAIN[armor]
    burn = np.maximum(energy - KEPT, 0.0) / (drain - RECHARGE)
    climb, fall = thrust - GRAVITY, GRAVITY - thrust * RECHARGE / drain
    fast = rise + climb * burn
    free = np.maximum(fast, 0.0)
    return rise * burn + 0.5 * climb * burn**2 + free**2 / (2 * fall), burn + free / fall


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
