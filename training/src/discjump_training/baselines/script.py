"""Two scripts in one: a skier that heads for the beacon, and one that tacks on the way there.

Both request a jump in every tick (that is what skiing is), press a direction near the course to the beacon,
and spend their energy on climbs and on gaining speed. Sideways thrust fades with the speed *along the
pressed direction* and is gone at 22 m/s; so the tacking script, while its jets burn, presses 45 to 60
degrees off the course, now on one side, now on the other, and goes on accelerating beyond that speed. The
plain script is the same with an angle of zero.
"""

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from discjump_training.baselines.sight import Sight
from discjump_training.baselines.steering import press
from discjump_training.policy import Actions, Floats, Layout, Mask, Observations, encode


def tuned(low: float, high: float) -> Any:
    """A parameter that is searched for between two bounds."""
    return field(metadata={"bounds": (low, high)})


@dataclass(frozen=True)
class SkierParameters:
    """What the plain script can be tuned in."""

    turn_seconds: float = tuned(0.1, 0.8)
    """time within which the yaw is turned onto the pressed direction, s"""
    drift_gain: float = tuned(0.0, 0.2)
    """how far the pressed direction leans against sideways drift, rad per m/s"""
    drift_limit: float = tuned(0.0, 1.5)
    """largest such lean, rad"""
    jet_start: float = tuned(5.0, 60.0)
    """energy at which jets may be lit"""
    jet_stop: float = tuned(0.0, 40.0)
    """energy at which they are put out"""
    look: float = tuned(6.0, 120.0)
    """how far ahead the rise of the terrain is judged, m"""
    climb_rise: float = tuned(-10.0, 40.0)
    """rise of the terrain ahead from which jets are used, m"""
    jet_speed: float = tuned(0.0, 60.0)
    """speed towards the beacon below which jets are used, m/s"""
    ceiling: float = tuned(0.0, 60.0)
    """height above ground above which they are not, unless to climb, m"""
    sink: float = tuned(-40.0, 20.0)
    """upward speed above which jets are not used, m/s"""

    def wants_jets(self, see: Sight, anyway: Mask | bool = False) -> Mask:
        """Who climbs, is slow, or wants them `anyway`, and does not rise by himself."""
        climbing = see.rise(self.look) > self.climb_rise
        slow = (see.closing < self.jet_speed) & (see.height < self.ceiling)
        wanted: Mask = (climbing | slow | anyway) & (see.climb < self.sink)
        return wanted

    def has_energy(self, see: Sight, burning: Mask) -> Mask:
        """Whose energy goes on feeding burning jets, or is enough to light them."""
        return np.where(burning, see.energy > self.jet_stop, see.energy >= self.jet_start)

    def lean(self, see: Sight) -> Floats:
        """How far the pressed direction leans against the drift, rad."""
        return -np.clip(self.drift_gain * see.drift, -self.drift_limit, self.drift_limit)


@dataclass(frozen=True)
class TackerParameters(SkierParameters):
    """What the tacking script can be tuned in."""

    angle: float = tuned(0.3, 1.4)
    """how far off the course it presses while its jets burn, rad"""
    tack_drift: float = tuned(0.0, 20.0)
    """sideways drift at which it changes sides, m/s"""
    tack_speed: float = tuned(0.0, 30.0)
    """speed towards the beacon above which it tacks, m/s"""
    straight: float = tuned(0.0, 200.0)
    """distance to the beacon below which it no longer tacks, m"""


class Script:
    """A scripted skier; with `TackerParameters` it tacks.

    Args:
        name: name in tables.
        parameters: tuned constants.
        layout: of the observations it will read.
        ranges: of the fan (rise of the terrain over range) straight ahead in them, metres.
        turn_rate: largest turn of the action space, rad/s.
    """

    note = "scripted"

    def __init__(
        self, name: str, parameters: SkierParameters, layout: Layout, ranges: Floats, turn_rate: float
    ) -> None:
        self.name = name
        self.parameters = parameters
        self._layout = layout
        self._ranges = ranges
        self._turn_rate = turn_rate
        self._burning = np.zeros(0, np.bool_)
        self._side = np.zeros(0)

    def reset(self, done: Mask) -> None:
        """Put the jets out and forget the tack in the environments `done`."""
        self._remember(done.size)
        self._burning[done] = False
        self._side[done] = 0.0

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        see = Sight.of(self._layout, observations, self._ranges)
        self._remember(see.distance.size)
        jet = self._jets(see)
        forward, strafe, turn = press(see.bearing + self._off_course(see, jet), self.parameters.turn_seconds)
        return encode(forward, strafe, np.ones_like(jet), jet, turn, self._turn_rate)

    def _remember(self, num_envs: int) -> None:
        if self._burning.size != num_envs:
            self._burning = np.zeros(num_envs, np.bool_)
            self._side = np.zeros(num_envs)

    def _jets(self, see: Sight) -> Mask:
        p = self.parameters
        self._burning = p.wants_jets(see) & p.has_energy(see, self._burning)
        return self._burning

    def _off_course(self, see: Sight, jet: Mask) -> Floats:
        p = self.parameters
        lean = p.lean(see)
        if not isinstance(p, TackerParameters):
            return lean
        # Press against the drift; within the band keep the side, at the very start take the right.
        side = np.where(see.drift > p.tack_drift, -1.0, np.where(see.drift < -p.tack_drift, 1.0, self._side))
        self._side = np.where(side == 0.0, -1.0, side)
        tacking = jet & (see.closing > p.tack_speed) & (see.distance > p.straight)
        return np.where(tacking, self._side * p.angle, lean)


def bounds(kind: type[Any]) -> list[tuple[float, float]]:
    """Search bounds of all parameters, in the order of the fields."""
    return [f.metadata["bounds"] for f in fields(kind)]
