"""The scripted route runner: a skier with waypoints.

From base to base it skies like the scripted skier, towards a waypoint on the line through the two flags, some
way before the stand it seeks: bases open along that line. From there it heads for the stand, and close to it
it no longer jumps or jets, so that it runs in under the roof. With the flag it does the same the other way
round. Where it has come no nearer for a second, it walks back a bit and then goes aside: out from under the
bridge, past a pier or a wall.
"""

from dataclasses import dataclass

import numpy as np

from discjump_training.baselines.script import SkierParameters, tuned
from discjump_training.baselines.sight import Sight, angle
from discjump_training.baselines.steering import press
from discjump_training.policy import Actions, Floats, Layout, Mask, Observations, encode_armed

#: Decisions without progress after which it takes itself for stuck.
PATIENCE = 8
#: Way to the stand that is progress, m a decision.
LEAST = 0.1


@dataclass(frozen=True)
class RunnerParameters(SkierParameters):
    """What the script can be tuned in."""

    waypoint: float = tuned(10.0, 150.0)
    """how far before the stand the waypoint lies, m"""
    run: float = tuned(5.0, 80.0)
    """distance from the stand from which it no longer jumps or jets, m"""
    brake: float = tuned(0.0, 80.0)
    """distance from the stand from which it presses against a speed above that of a run, m"""
    aside: float = tuned(2.0, 40.0)
    """decisions for which it walks back where it is stuck, and then goes aside"""


class Runner:
    """The scripted route runner.

    Args:
        parameters: tuned constants.
        layout: of the observations it will read.
        ranges: of the fan (rise of the terrain over range) straight ahead in them, metres.
        turn_rate: largest turn of the action space, rad/s.
    """

    name = "runner"
    note = "scripted"

    def __init__(
        self, parameters: RunnerParameters, layout: Layout, ranges: Floats, turn_rate: float
    ) -> None:
        self.parameters = parameters
        self._layout, self._ranges, self._turn_rate = layout, ranges, turn_rate
        self._burning = np.zeros(0, np.bool_)
        self._stuck, self._last = np.zeros(0), np.zeros(0)

    def reset(self, done: Mask) -> None:
        """Put the jets out in the environments `done`."""
        self._remember(done.size)
        self._burning[done] = False
        self._stuck[done], self._last[done] = 0, np.inf

    def _remember(self, num_envs: int) -> None:
        if self._burning.size != num_envs:
            self._burning = np.zeros(num_envs, np.bool_)
            self._stuck, self._last = np.zeros(num_envs), np.full(num_envs, np.inf)

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        p, layout = self.parameters, self._layout
        see = Sight.of(layout, observations, self._ranges)
        self._remember(see.distance.size)
        axis = angle(layout.read(observations, "axis"))
        # The waypoint, seen from the player: the stand less some way along the axis.
        ahead = see.distance * np.cos(see.bearing) - p.waypoint * np.cos(axis)
        left = see.distance * np.sin(see.bearing) - p.waypoint * np.sin(axis)
        along = see.distance * np.cos(see.bearing - axis)
        before = along > p.waypoint
        bearing = np.where(before, np.arctan2(left, ahead), see.bearing)

        near = see.distance < p.run
        # Up to the patience it counts decisions without progress, beyond it those of going aside.
        # By its way, not its speed: who is wedged in has some.
        held = (self._last - see.distance < LEAST) | (self._stuck > PATIENCE)
        self._last = see.distance
        self._stuck = np.where(held & (self._stuck <= PATIENCE + 2 * p.aside), self._stuck + 1, 0)
        back = (self._stuck > PATIENCE) & (self._stuck <= PATIENCE + p.aside)
        aside = self._stuck > PATIENCE + p.aside
        bearing = bearing + np.where(back, np.pi, np.where(aside, 0.5 * np.pi, 0.0))
        near = (near & ~aside) | back
        jet = self._burning = p.wants_jets(see, anyway=aside) & ~near & p.has_energy(see, self._burning)

        fast = (see.distance < p.brake) & (see.closing > 14.0)
        pressed = np.where(fast, bearing + np.pi, bearing + p.lean(see))
        forward, strafe, turn = press(pressed, p.turn_seconds)
        none = np.zeros(jet.size)
        return encode_armed(forward, strafe, ~near, jet, turn, none.astype(np.bool_), none, self._turn_rate)
