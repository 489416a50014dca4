"""The scripted disc jumper: it knows that a disc lifts most some four ticks after the jump.

On the ground it waits until the tank is full, jumps, looks straight down and shoots in the
decision after the jump (with two ticks a decision the disc bursts below its feet in the fourth or fifth
tick), and burns its jets from the jump on. It walks below the marker first: in the air it presses a direction
only where its drift would carry it past. Where it comes down again without success and discs are left, it
does the same once more.
"""

from dataclasses import dataclass

import numpy as np

from discjump_training.baselines.script import tuned
from discjump_training.baselines.sight import angle
from discjump_training.baselines.steering import press, wrap
from discjump_training.policy import LOWEST_PITCH, Actions, Floats, Layout, Mask, Observations, encode_armed

AHEAD = 0.0


@dataclass(frozen=True)
class JumperParameters:
    """What the script can be tuned in."""

    energy: float = tuned(30.0, 60.0)
    """energy from which it jumps"""
    wait: float = tuned(0.0, 4.0)
    """decisions between the jump and the shot"""
    walk: float = tuned(0.5, 20.0)
    """horizontal distance of the marker from which it walks there before it jumps, m"""
    speed: float = tuned(0.2, 12.0)
    """horizontal speed above which it does not jump, m/s"""
    climb: float = tuned(0.0, 120.0)
    """decisions after the jump in which it presses no direction"""
    near: float = tuned(0.0, 20.0)
    """how far it may pass by the marker without pressing a direction, m"""
    lead: float = tuned(0.0, 6.0)
    """time for which it takes its drift into account, s"""


class Jumper:
    """The scripted disc jumper.

    Args:
        parameters: tuned constants.
        layout: of the observations it will read.
        turn_rate: largest turn of the action space, rad/s.
    """

    name = "jumper"
    note = "scripted"

    def __init__(self, parameters: JumperParameters, layout: Layout, turn_rate: float) -> None:
        self.parameters = parameters
        self._layout = layout
        self._turn_rate = turn_rate
        self._since = np.zeros(0)

    def reset(self, done: Mask) -> None:
        """Forget the jump under way in the environments `done`."""
        self._remember(done.size)
        self._since[done] = np.inf

    def _remember(self, num_envs: int) -> None:
        if self._since.size != num_envs:
            self._since = np.full(num_envs, np.inf)

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        p = self.parameters

        def read(name: str) -> Floats:
            return self._layout.read(observations, name)

        self._remember(len(observations))
        velocity, near = read("velocity")[:, :2], read("goal_near")[:, :2]
        height, energy = read("height")[:, 0], read("energy")[:, 0]
        grounded = (height < 0.5) & (self._since > 8)
        loaded = (read("ammo")[:, 0] > 0) & (read("reload")[:, 0] <= 0)
        below = np.hypot(near[:, 0], near[:, 1]) <= p.walk
        still = np.hypot(velocity[:, 0], velocity[:, 1]) < p.speed
        jump = grounded & loaded & (energy >= p.energy) & below & still
        self._since = np.where(jump, 0.0, np.where(grounded, np.inf, self._since + 1.0))
        flying = np.isfinite(self._since)
        fire = self._since == np.rint(p.wait)
        # Where its drift will not carry it by itself: pressing a direction takes much of the lift away.
        way = near - np.where(flying, p.lead, 0.0)[:, None] * velocity
        press_on = np.where(
            flying,
            (np.hypot(way[:, 0], way[:, 1]) > p.near) & (self._since > p.climb),
            ~below,
        )
        forward, strafe, turn = press(wrap(angle(way)), 0.4)
        forward, strafe = np.where(press_on, forward, 0.0), np.where(press_on, strafe, 0.0)
        jet = flying
        pitch = np.where(self._since <= p.wait, LOWEST_PITCH, AHEAD)
        return encode_armed(forward, strafe, jump, jet, turn, fire, pitch, self._turn_rate)
