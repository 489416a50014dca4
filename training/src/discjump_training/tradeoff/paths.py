"""Paths of any configuration, and how far they are from others.

Keys are functions of time: `discjump.accuracy` draws them in ticks of 32 ms, and other tick lengths play
them resampled (`discjump.accuracy.scripts.resampled`). Paths are compared every 64 ms, a multiple of all
tick lengths.
"""

from typing import Any

import numpy as np

from discjump.accuracy.grounds import Floats
from discjump.accuracy.measure import Path, run, spread
from discjump.accuracy.plays import Play
from discjump.accuracy.scripts import TICK_MS as GAME_TICK_MS
from discjump.accuracy.situations import SITUATIONS
from discjump_training.tradeoff.grid import TRUTH, Config, Plan

SAMPLE_MS = 64
"""From one comparison to the next, ms."""
SECONDS = (1.0, 5.0, 20.0)
"""When errors are told, s: at the nearest sample, 1.024, 4.992 and 19.968 s."""
LIMITS = (0.01, 0.1, 1.0)
"""Position errors, m, of which it is told when they were first exceeded."""
SEED = 0
"""Draws starts and keys."""
NUDGED = "nudged"
"""No tier but the yardstick: the truth from a start `discjump.accuracy.measure.NUDGE` aside."""
TOLD = {
    "truth": "from the truth",
    "own": "from `reference` with the same tick and surface",
    "movement": "of the movement alone: the tier in float64, from `reference` with the same tick and surface",
    "digits": "of the digits alone: the tier in float32, from itself in float64",
}
"""What errors are distances from. The last two share out `own`."""


class Paths:
    """Plays a situation in any configuration; remembers what others are compared with.

    Args:
        plan: how many starts, and for how long.
    """

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._situation = ""
        self._plays: list[Play] = []
        self._kept: dict[Config, Path] = {}

    def of(self, situation: str, config: Config, precision: str | None = None) -> Path:
        """Positions (samples, starts, 3) and speeds (samples, starts), every `SAMPLE_MS`.

        Args:
            situation: by name.
            config: in which it is played.
            precision: "float64", or None for the tier's own.
        """
        if situation != self._situation:
            ticks = samples(self._plan.seconds) * SAMPLE_MS // GAME_TICK_MS
            self._plays = SITUATIONS[situation].plays(SEED, self._plan.starts, ticks)
            self._situation, self._kept = situation, {}
        if config in self._kept:
            return self._kept[config]
        every = SAMPLE_MS // config.tick_ms
        plays = [_in(config, play) for play in self._plays]
        paths = [run(play, config.tier, every, precision) for play in plays]
        path = Path(
            np.concatenate([one.position for one in paths], axis=1),
            np.concatenate([one.speed for one in paths], axis=1),
        )
        if config.tier == TRUTH.tier:
            self._kept[config] = path
        return path


def _in(config: Config, play: Play) -> Play:
    """A play, written for triangles and the game's tick, on another surface and in another tick."""
    terrain = play.terrain
    if config.surface != terrain.surface:
        play = play.on(terrain.with_surface(config.surface))
    return play.at(config.tick_ms)


def compared(paths: Paths, situation: str, config: Config) -> list[dict[str, Any]]:
    """A row for each of `TOLD` that there is: `reference` has float64 alone, the yardstick the truth."""
    path, truth = paths.of(situation, config), paths.of(situation, TRUTH)
    pairs = {"truth": (path, truth)}
    if config.tier != NUDGED:
        own = paths.of(situation, Config(TRUTH.tier, config.tick_ms, config.surface))
        pairs["own"] = (path, own)
        if config.tier != TRUTH.tier:
            exact = paths.of(situation, config, "float64")
            pairs |= {"movement": (exact, own), "digits": (path, exact)}
    return [
        {"situation": situation, **config.keys, "error": error} | figures(*pair)
        for error, pair in pairs.items()
    ]


def figures(path: Path, truth: Path) -> dict[str, Any]:
    """Errors at `SECONDS` as far as they were played, and when `LIMITS` were passed."""
    position = np.linalg.norm(path.position - truth.position, axis=-1)
    speed = np.abs(path.speed - truth.speed)
    seconds = (len(position) - 1) * SAMPLE_MS / 1000
    return {
        "at": [
            {
                "seconds": told_seconds,
                "position": spread(position[sample]),
                "speed": spread(speed[sample]),
                "over": {f"{limit:g}": float((position[sample] > limit).mean()) for limit in LIMITS},
            }
            for told_seconds, sample in told(seconds)
        ],
        "until": {f"{limit:g}": until(first_passage(position, limit), seconds) for limit in LIMITS},
    }


def first_passage(errors: Floats, limit: float) -> Floats:
    """When errors first exceed a limit.

    Args:
        errors: (samples, n), every `SAMPLE_MS`, from the start on.
        limit: in the unit of the errors.

    Returns:
        (n,), s; infinite where they never do.

    >>> first_passage(np.array([[0.0, 0.0], [2.0, 0.5], [0.0, 0.9]]), 1.0).tolist()
    [0.064, inf]
    """
    over = errors > limit
    passed: Floats = np.where(over.any(axis=0), over.argmax(axis=0) * SAMPLE_MS / 1000, np.inf)
    return passed


def until(passed: Floats, end: float) -> dict[str, float | None]:
    """Times of which all that lie beyond the end are unknown.

    Args:
        passed: (n,), s; infinite where it did not happen before the end.
        end: s.

    Returns:
        share: of those who got there; median: s, None where fewer than half did; restricted_mean: mean of
        the time, or of the end where it did not happen, s.

    >>> until(np.array([1.0, 2.0, np.inf]), 20.0)["median"], until(np.array([1.0, np.inf]), 20.0)["median"]
    (2.0, 1.0)
    >>> until(np.array([1.0, np.inf, np.inf]), 20.0)
    {'share': 0.3333333333333333, 'median': None, 'restricted_mean': 13.666666666666666}
    """
    # The time at which half of the starts had got there, as Kaplan and Meier have it.
    middle = float(np.quantile(passed, 0.5, method="inverted_cdf"))
    return {
        "share": float(np.isfinite(passed).mean()),
        "median": middle if np.isfinite(middle) else None,
        "restricted_mean": float(np.minimum(passed, end).mean()),
    }


def samples(seconds: float) -> int:
    """How many samples a time takes.

    >>> [samples(seconds) for seconds in SECONDS]
    [16, 78, 312]
    """
    return round(seconds * 1000 / SAMPLE_MS)


def told(seconds: float) -> list[tuple[float, int]]:
    """Those of `SECONDS` that were played, with their samples.

    >>> told(4.992)
    [(1.0, 16), (5.0, 78)]
    """
    return [(at, samples(at)) for at in SECONDS if samples(at) <= samples(seconds)]
