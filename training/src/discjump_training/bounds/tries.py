"""Schedules for an episode of the disc-jump task, and what becomes of them in copies of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import product
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump.envs.tasks import DISC_JUMP
from discjump_training.episodes import place
from discjump_training.policy import ARMED_BINS, Floats, Layout, Mask

Times = NDArray[np.int64]

#: Keys (forward, strafe) that press into each eighth of the horizon; the last presses nothing.
KEYS = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (0, 0)], np.int64)
NONE = len(KEYS) - 1
#: Options that make the observation small: nobody looks at the ground.
SMALL: dict[str, Any] = {"fan_bearings": [], "fan_ranges": [], "landing": False}
#: Decisions after the jump in which it shows whether he rises.
RISING = 8


@dataclass(frozen=True)
class Tries:
    """`n` schedules, (n,) each. Times and lengths are in decisions.

    Attributes:
        facing: which sequence of turns is played first.
        wait: from the beginning until he walks.
        walk, walking: direction (an index of `KEYS`) and length; he stands for `STAND` after it.
        push, pushing: the same right before the jump.
        lit: jets burn from then on, counted from the jump, as the following.
        shot, pitch: the disc is fired; bin of the pitch until then.
        steer, steering_from, steering: direction pressed in the air, from when, length.
    """

    facing: Times
    wait: Times
    walk: Times
    walking: Times
    push: Times
    pushing: Times
    lit: Times
    shot: Times
    pitch: Times
    steer: Times
    steering_from: Times
    steering: Times

    @classmethod
    def grid(cls, values: Mapping[str, Sequence[Any]]) -> "Tries":
        """All combinations; a key may name several attributes, joined by a comma, and have tuples."""
        names = [one.name for one in fields(cls)]
        columns: dict[str, Any] = dict.fromkeys(names, 0)
        columns |= {"walk": NONE, "push": NONE, "steer": NONE}
        rows = list(product(*values.values()))
        for column, key in enumerate(values):
            parts = key.split(",")
            for nth, name in enumerate(parts):
                columns[name] = [row[column][nth] if len(parts) > 1 else row[column] for row in rows]
        filled = {name: np.broadcast_to(np.asarray(columns[name]), len(rows)).copy() for name in names}
        return cls(**filled)

    def __len__(self) -> int:
        return len(self.wait)

    @property
    def jump(self) -> Times:
        """When he jumps."""
        return self.wait + self.walking + np.where(self.walking > 0, STAND, 0) + self.pushing

    def take(self, which: NDArray[Any] | slice) -> "Tries":
        """Some of them."""
        return replace(self, **{one.name: getattr(self, one.name)[which] for one in fields(self)})

    def cross(self, values: Mapping[str, Sequence[Any]]) -> "Tries":
        """Each with all combinations of other values for some attributes."""
        other = Tries.grid(values)
        named = {name for key in values for name in key.split(",")}
        mine = self.take(np.repeat(np.arange(len(self)), len(other)))
        return replace(mine, **{name: np.tile(getattr(other, name), len(self)) for name in named})

    def row(self, index: int) -> dict[str, int]:
        """One of them, for JSON."""
        return {one.name: int(getattr(self, one.name)[index]) for one in fields(self)}

    def actions(self, time: int, turns: Times) -> NDArray[np.int8]:
        """What is pressed in a decision, (n, 7).

        Args:
            time: which.
            turns: bins of the turn, (facings, decisions).
        """
        jump = self.jump
        after = time - jump
        walked = self.wait + self.walking
        direction = np.where((self.wait <= time) & (time < walked), self.walk, NONE)
        direction = np.where((-self.pushing <= after) & (after < 0), self.push, direction)
        steered = (self.steering_from <= after) & (after < self.steering_from + self.steering) & (after >= 0)
        direction = np.where(steered, self.steer, direction)
        made = np.empty((len(self), len(ARMED_BINS)), np.int8)
        made[:, :2] = KEYS[direction] + 1
        made[:, 2] = after == 0
        made[:, 3] = after >= self.lit
        middle = ARMED_BINS[4] // 2
        made[:, 4] = turns[self.facing, time] if time < turns.shape[1] else middle
        made[:, 5] = after == self.shot
        made[:, 6] = np.where(after <= self.shot, self.pitch, ARMED_BINS[6] - 1)
        return made


#: Decisions that he stands after walking.
STAND = 8


@dataclass(frozen=True)
class Results:
    """What became of schedules, (n,) each.

    Attributes:
        success: the marker was reached.
        seconds: when; NaN where it was not.
        miss: least distance to it at the ends of decisions, m.
    """

    success: Mask
    seconds: Floats
    miss: Floats


class Copies:
    """Copies of an episode, in each of which a schedule is played.

    Args:
        options: of the environment.
        sizes: of the batches that copies are played in, ascending.
    """

    def __init__(self, options: dict[str, Any], sizes: tuple[int, ...] = (640, 4_096)) -> None:
        make = {**options, **SMALL}
        self._batches: list[Any] = [
            gymnasium.make_vec(DISC_JUMP.id, num_envs=size, threads=1, **make).unwrapped for size in sizes
        ]
        self._at: list[bytes | None] = [None for _ in sizes]
        for batch in self._batches:
            batch.reset(seed=0)
        first = self._batches[0]
        self._layout = Layout.of(first.observation_layout)
        self.longest = int(np.ceil(first.options.time_limit / first.options.decision_seconds))
        self.radius = float(first.options.arrival_radius)

    def place(self, snapshot: bytes) -> None:
        """Put all copies to where the snapshot of one environment is."""
        self._snapshot = snapshot
        self._at = [None for _ in self._batches]

    def play(self, tries: Tries, turns: Times) -> Results:
        """Play schedules to success, the end of the episode, or a fall from below the marker's reach."""
        most = self._batches[-1].num_envs
        parts = [
            self._play(tries.take(slice(start, start + most)), turns) for start in range(0, len(tries), most)
        ]
        return Results(*(np.concatenate([getattr(one, f.name) for one in parts]) for f in fields(Results)))

    def _batch(self, count: int) -> Any:
        """The smallest batch that holds so many, its copies in place."""
        nth = next(n for n, batch in enumerate(self._batches) if batch.num_envs >= count)
        batch = self._batches[nth]
        at = self._at[nth]
        if at is None:
            place(batch, self._snapshot, range(batch.num_envs))
            self._at[nth] = batch.snapshot()
        else:
            batch.restore(at)
        return batch

    def _play(self, tries: Tries, turns: Times) -> Results:
        count = len(tries)
        batch = self._batch(count)
        actions = np.zeros((batch.num_envs, len(ARMED_BINS)), np.int64)
        actions[:, :2], actions[:, 4], actions[:, 6] = 1, ARMED_BINS[4] // 2, ARMED_BINS[6] - 1
        success, running = np.zeros(count, np.bool_), np.ones(count, np.bool_)
        seconds, miss = np.full(count, np.nan), np.full(count, np.inf)
        jump = tries.jump
        for time in range(self.longest):
            actions[:count] = tries.actions(time, turns)
            observations, _, terminated, truncated, info = batch.step(actions)
            seen = observations[:count]
            ended = running & (terminated | truncated)[:count]
            if ended.any():
                arrived = ended & np.asarray(info["is_success"])[:count]
                success |= arrived
                seconds[arrived] = np.asarray(info["time"])[:count][arrived]
            running &= ~ended
            above = self._layout.read(seen, "goal_height")[:, 0]
            apart = np.hypot(self._layout.read(seen, "goal_distance")[:, 0], above)
            miss = np.where(running, np.minimum(miss, apart), miss)
            falling = self._layout.read(seen, "velocity")[:, 2] < 0.0
            running &= ~(falling & (above > self.radius) & (time > jump + RISING))
            if not running.any():
                break
        return Results(success, seconds, np.where(success, 0.0, miss))

    def close(self) -> None:
        """Close the environments."""
        for batch in self._batches:
            batch.close()
