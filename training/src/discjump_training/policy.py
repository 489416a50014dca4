"""What a policy is, and how one reads observations by name and writes actions by meaning."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from discjump_training.errors import TrainingError

Observations = NDArray[np.float32]
Actions = NDArray[np.int64]
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Bins of the action space: forward, strafe, jump, jet, turn; of who has a launcher also fire and pitch.
BINS = (3, 3, 2, 2, 7)
ARMED_BINS = (*BINS, 2, 5)
#: Lowest pitch of the view, rad: the first bin of pitch. The last is straight ahead.
LOWEST_PITCH = -np.deg2rad(88.0)


class Policy(Protocol):
    """Chooses actions for a batch of environments."""

    @property
    def name(self) -> str:
        """Name in tables and plots."""

    @property
    def note(self) -> str:
        """How actions are chosen, in a few words: `greedy`, `sampled`, `scripted` ..."""

    def __call__(self, observations: Observations) -> Actions:
        """Actions (n, 5), with discs (n, 7), int64, for observations (n, observation_size), float32."""

    def reset(self, done: Mask) -> None:
        """Forget what is remembered of the environments in `done` (n,): their next observation begins an
        episode.
        """


@dataclass(frozen=True)
class Layout:
    """Where each named part of an observation lies.

    Attributes:
        slices: columns of each part.
        scales: physical value = observation * scale.
    """

    slices: dict[str, slice]
    scales: dict[str, float]

    @classmethod
    def of(cls, fields: Iterable[Any]) -> "Layout":
        """From an environment's `observation_layout`: fields with `name`, `slice` and `scale`."""
        listed = list(fields)
        return cls(
            {field.name: field.slice for field in listed},
            {field.name: float(field.scale) for field in listed},
        )

    def read(self, observations: Observations, name: str) -> Floats:
        """The part `name` in physical units, shape (n, width).

        Raises:
            TrainingError: if the observation has no such part.
        """
        try:
            columns = observations[:, self.slices[name]]
        except KeyError:
            known = ", ".join(self.slices)
            raise TrainingError(f"the observation has no part {name!r}; it has {known}") from None
        return columns.astype(np.float64) * self.scales[name]


def encode(forward: Floats, strafe: Floats, jump: Mask, jet: Mask, turn: Floats, turn_rate: float) -> Actions:
    """Actions (n, 5) from keys and a turn.

    Args:
        forward: -1, 0 or 1, shape (n,).
        strafe: -1 (left), 0 or 1 (right), shape (n,).
        jump: jump key, shape (n,).
        jet: jet key, shape (n,).
        turn: wanted turn, rad/s, positive to the left, shape (n,); rounded to the nearest bin.
        turn_rate: largest turn of the action space, rad/s.
    """
    most = (BINS[4] - 1) // 2
    bins = np.clip(np.rint(turn / turn_rate * most), -most, most) + most
    return np.stack([forward + 1, strafe + 1, jump, jet, bins], axis=1).astype(np.int64)


def encode_armed(
    forward: Floats,
    strafe: Floats,
    jump: Mask,
    jet: Mask,
    turn: Floats,
    fire: Mask,
    pitch: Floats,
    turn_rate: float,
) -> Actions:
    """Actions (n, 7) from keys, a turn, the trigger and a pitch.

    Args:
        forward, strafe, jump, jet, turn, turn_rate: as in `encode`.
        fire: trigger, shape (n,).
        pitch: wanted pitch of the view, rad, up positive, shape (n,); rounded to the nearest bin.
    """
    last = ARMED_BINS[6] - 1
    bins = np.clip(np.rint(last - last * pitch / LOWEST_PITCH), 0, last)
    keys = encode(forward, strafe, jump, jet, turn, turn_rate)
    return np.column_stack([keys, np.stack([fire, bins], axis=1).astype(np.int64)])
