"""What a script sees: the named parts of an observation in physical units, seen from the player's yaw.

Angles are in radians, counter-clockwise from straight ahead (positive to the left).
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from discjump_training.errors import TrainingError
from discjump_training.policy import Floats, Layout, Observations


def angle(way: Floats) -> Floats:
    """Angle of ways (forward, right), (n, 2), to (n,)."""
    found: Floats = np.arctan2(-way[:, 1], way[:, 0])
    return found


@dataclass(frozen=True)
class Sight:
    """Physical readings, each of shape (n,) unless said otherwise.

    Attributes:
        bearing: angle to the beacon, or to the goal in the air.
        distance: horizontal metres there.
        closing: speed towards it, m/s.
        drift: speed across the line to the beacon, m/s, positive to the left.
        climb: upward speed, m/s.
        height: metres above ground.
        energy: jet energy, 0 to 60.
        ahead: terrain straight ahead minus feet, metres, at the ranges of the fan, near to far, (n, ranges).
        ranges: those ranges, metres, (ranges,).
    """

    bearing: Floats
    distance: Floats
    closing: Floats
    drift: Floats
    climb: Floats
    height: Floats
    energy: Floats
    ahead: Floats
    ranges: Floats

    @classmethod
    def of(cls, layout: Layout, observations: Observations, ranges: Floats) -> Self:
        """Read a batch of observations; the first bearing of the fan, if there is one, must be straight
        ahead.
        """

        def number(name: str) -> Floats:
            return layout.read(observations, name)[:, 0]

        goal = "beacon" if "beacon_direction" in layout.slices else "goal"
        fan = layout.read(observations, "fan") if "fan" in layout.slices else np.zeros((len(observations), 0))
        height = number("height")
        return cls(
            bearing=angle(layout.read(observations, f"{goal}_direction")),
            distance=number(f"{goal}_distance"),
            closing=number("closing_speed"),
            drift=-number("lateral_speed"),
            climb=layout.read(observations, "velocity")[:, 2],
            height=height,
            energy=number("energy"),
            # The fan is rise over range, seen from the ground below the player.
            ahead=fan[:, : ranges.size] * ranges[: fan.shape[1]] - height[:, None],
            ranges=ranges,
        )

    def rise(self, distance: float) -> Floats:
        """Terrain `distance` metres straight ahead minus feet, interpolated between the fan's samples,
        metres.

        Raises:
            TrainingError: if the observations have no fan.
        """
        if not self.ahead.shape[1]:
            raise TrainingError("the observation has no part 'fan': nothing is seen of the terrain ahead")
        right = int(np.clip(np.searchsorted(self.ranges, distance), 1, self.ranges.size - 1))
        near, far = self.ranges[right - 1], self.ranges[right]
        share = np.clip((distance - near) / (far - near), 0.0, 1.0)
        mixed: Floats = self.ahead[:, right - 1] * (1.0 - share) + self.ahead[:, right] * share
        return mixed
