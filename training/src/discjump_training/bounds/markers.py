"""Which markers of a course the search reaches: an enumeration of schedules for each episode.

A schedule is open loop, played from the episode's own start:

1. turn so that one of the eight directions that keys can press points at the marker (facings: the least turn;
   the marker ahead; the marker behind),
2. wait: until the feet touch the ground, or until the player rests there (no key: friction brakes him),
3. walk into one of the eight directions and stand for 8 decisions,
4. press one of the eight directions right before the jump,
5. jump, light the jets, fire once: all counted from the decision of the jump,
6. in the air press one of the eight directions for a while. Jets burn to the end.

Stages, each played only where those before it did not reach the marker; lengths and times in decisions of
64 ms:

| stage | where from | jump | steer | schedules |
| --- | --- | --- | --- | --- |
| `stand` | wait for touch, rest | push A; lit -2, 0, 1, 2; shot 0, 1, 2 | none | 600 |
| `walk` | rest; walk 8 directions for 8, 16, 24 | push A; lit 0, 2; shot 1, 2 | none | 2400 |
| `far` | rest; walk 8 directions for 32, 48, 64 | push A; lit 0, 2; shot 1, 2 | none | 2400 |
| `steer` | those of the best 24 so far | theirs | B | 3840 |
| `aim` | the best 12 so far; marker ahead, behind | lit, shot as in `stand`; -88, -66 | none | 576 |
| `again` | the best 24 of all that do not steer | theirs | B | 3840 |

Push A: none, or 8 directions for 1, 2, 3. Steer B: 8 directions from 0, 8, 16, 32, 64 for 4, 8, 16, 32. Where
nothing else is said the view turns least and the pitch is -88 degrees.
The best are those that pass nearest to the marker, of those that do not steer.

Not tried: a second disc or a second jump after landing, runs on skis to gain speed, jets that are put out in
between, other pitches, turns later than at the beginning, more than one direction in the air. What is reached
can be reached; what is not may still be reachable.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from tqdm import tqdm

from discjump.envs.tasks import DISC_JUMP
from discjump_training.baselines.sight import angle
from discjump_training.bounds.tries import KEYS, NONE, SMALL, Copies, Results, Times, Tries
from discjump_training.courses import Course
from discjump_training.policy import ARMED_BINS, Layout

STAGES = ("stand", "walk", "far", "steer", "aim", "again")
DIRECTIONS = range(len(KEYS) - 1)
PUSHES = [(NONE, 0), *((way, length) for length in (1, 2, 3) for way in DIRECTIONS)]
WALKS = {
    "walk": [(way, length) for length in (8, 16, 24) for way in DIRECTIONS],
    "far": [(way, length) for length in (32, 48, 64) for way in DIRECTIONS],
}
STEERS = [
    (way, begin, length) for way in DIRECTIONS for begin in (0, 8, 16, 32, 64) for length in (4, 8, 16, 32)
]
LIT, SHOT = [-2, 0, 1, 2], [0, 1, 2]
#: Facings: least turn, the marker ahead, the marker behind.
FACINGS = 3
#: Decisions that are waited for rest at most, and speed of who rests, m/s.
PATIENCE, REST = 48, 0.3
KEPT, AIMED = 24, 12


@dataclass(frozen=True)
class Found:
    """What the search found for an episode.

    Attributes:
        episode: row of the course.
        stage: that reached the marker; None: none did.
        seconds: until it was reached by the soonest schedule of that stage; None where it was not.
        miss: least distance to the marker of all schedules, m; 0 where it was reached.
        schedules: that were played.
        schedule: the soonest, or the nearest.
        marker_height: over the start, m.
    """

    episode: int
    stage: str | None
    seconds: float | None
    miss: float
    schedules: int
    schedule: dict[str, int]
    marker_height: float


def search(
    course: Course, episodes: int | None = None, options: dict[str, Any] | None = None, *, quiet: bool = True
) -> list[Found]:
    """Search schedules for the first episodes of a course.

    Args:
        course: of the disc-jump task.
        episodes: how many; all by default.
        options: of the environment, beside the course's terrains.
        quiet: no progress bar.
    """
    seeds = [int(seed) for seed in course.seeds(episodes)]
    made = {"terrain_seeds": list(course.terrain_seeds), **(options or {})}
    env: Any = gymnasium.make_vec(DISC_JUMP.id, num_envs=len(seeds), threads=1, **{**made, **SMALL})
    inner = env.unwrapped
    observations, _ = env.reset(seed=seeds, options=course.placement(range(len(seeds))))
    layout = Layout.of(inner.observation_layout)
    heights = (inner.goals() - inner.state()["position"])[:, 2]
    snapshots = [inner.snapshot(row) for row in range(len(seeds))]
    turns = [turning(one, inner.options) for one in angle(layout.read(observations, "goal_direction"))]
    waits = rest(inner, turns)
    env.close()
    copies = Copies(made)
    found = []
    for row in tqdm(range(len(seeds)), unit=" episodes", disable=quiet, smoothing=0):
        copies.place(snapshots[row])
        found.append(one_episode(copies, row, waits[row], turns[row], float(heights[row])))
    copies.close()
    return found


def one_episode(
    copies: Copies, row: int, waits: tuple[int, int], turns: Times, marker_height: float
) -> Found:
    """Play the stages in copies of an episode until one reaches the marker.

    Args:
        copies: placed.
        row: of the course.
        waits: decisions until the feet touch the ground, and until the player rests.
        turns: bins of the turn by facing, (facings, decisions).
        marker_height: over the start, m.
    """
    tried: list[tuple[Tries, Results]] = []
    for stage in STAGES:
        tries = plan(stage, waits, tried)
        results = copies.play(tries, turns)
        tried.append((tries, results))
        if results.success.any():
            index = int(np.nanargmin(results.seconds))
            return Found(
                row,
                stage,
                round(float(results.seconds[index]), 3),
                0.0,
                sum(len(one) for one, _ in tried),
                tries.row(index),
                round(marker_height, 3),
            )
    nearest = min(tried, key=lambda one: float(one[1].miss.min()))
    index = int(nearest[1].miss.argmin())
    return Found(
        row,
        None,
        None,
        round(float(nearest[1].miss[index]), 3),
        sum(len(one) for one, _ in tried),
        nearest[0].row(index),
        round(marker_height, 3),
    )


def plan(stage: str, waits: tuple[int, int], tried: list[tuple[Tries, Results]]) -> Tries:
    """The schedules of a stage.

    Args:
        stage: one of `STAGES`.
        waits: as for `one_episode`.
        tried: stages before it.
    """
    if stage == "stand":
        wait = sorted(set(waits))
        return Tries.grid({"wait": wait, "push,pushing": PUSHES, "lit": LIT, "shot": SHOT})
    if stage in WALKS:
        ground: dict[str, Sequence[Any]] = {
            "wait": [waits[1]],
            "walk,walking": WALKS[stage],
            "push,pushing": PUSHES,
        }
        return Tries.grid({**ground, "lit": [0, 2], "shot": [1, 2]})
    if stage == "aim":
        unsteered = _best([one for one in tried if not one[0].steering.any()], AIMED)
        return unsteered.cross({"facing": [1, 2], "lit": LIT, "shot": SHOT, "pitch": [0, 1]})
    unsteered = _best([one for one in tried if not one[0].steering.any()], KEPT)
    return unsteered.cross({"steer,steering_from,steering": STEERS})


def _best(tried: list[tuple[Tries, Results]], count: int) -> Tries:
    """Those that passed nearest to the marker."""
    where = [
        (float(miss), nth, index) for nth, one in enumerate(tried) for index, miss in _nearest(one, count)
    ]
    chosen = sorted(where)[:count]
    parts = [tried[nth][0].take(np.array([index])) for _, nth, index in chosen]
    names = parts[0].__dataclass_fields__
    return Tries(**{name: np.concatenate([getattr(one, name) for one in parts]) for name in names})


def _nearest(one: tuple[Tries, Results], count: int) -> list[tuple[int, float]]:
    order = np.argsort(one[1].miss, kind="stable")[:count]
    return [(int(index), float(one[1].miss[index])) for index in order]


def turning(bearing: float, options: Any) -> Times:
    """Bins of the turn for each facing, (facings, decisions).

    Args:
        bearing: of the marker, rad.
        options: of the task.
    """
    most = ARMED_BINS[4] // 2
    step = options.turn_rate * options.decision_seconds / most
    eighth = np.pi / 4
    wanted = [bearing - eighth * np.rint(bearing / eighth), bearing, bearing - np.copysign(np.pi, bearing)]
    rows = []
    for wish in wanted:
        left = int(np.rint(wish / step))
        row = []
        while left:
            row.append(int(np.clip(left, -most, most)))
            left -= row[-1]
        rows.append(row)
    longest = max(1, *map(len, rows))
    return np.array([[*row, *[0] * (longest - len(row))] for row in rows], np.int64) + most


def rest(env: Any, turns: list[Times]) -> list[tuple[int, int]]:
    """Decisions after which each player touches the ground, and after which he rests, with no key pressed;
    at most `PATIENCE`, and not before he has made the least turn. The environments are played on.
    """
    count = len(turns)
    least = np.array([int((one[0] != ARMED_BINS[4] // 2).sum()) for one in turns])
    touch, still = np.full(count, PATIENCE), np.full(count, PATIENCE)
    nothing = np.array([1, 1, 0, 0, ARMED_BINS[4] // 2, 0, ARMED_BINS[6] - 1], np.int64)
    for time in range(1, PATIENCE):
        env.step(np.tile(nothing, (count, 1)))
        state = env.state()
        touched = state["touched"]
        touch = np.where(touched, np.minimum(touch, time), touch)
        resting = touched & (np.linalg.norm(state["velocity"], axis=1) < REST)
        still = np.where(resting, np.minimum(still, time), still)
    return [(int(max(a, b)), int(max(c, b))) for a, b, c in zip(touch, least, still, strict=True)]
