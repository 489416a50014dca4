"""Where an episode is put: the keys `start`, `goal` and `terrain_seed` of `reset(options=...)`."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from discjump import _check

KEYS = ("start", "goal", "terrain_seed")
GOALS: Mapping[str, tuple[int, ...]] = {"beacon": (2,), "marker": (2, 3), "stands": ()}
"""Numbers that a goal may be given by, for each kind of it (`TaskOptions.GROUNDS`)."""


class Placement(NamedTuple):
    """Where the next episodes are put; what is None is drawn."""

    start: NDArray[np.float64] | None = None
    """(num_envs, 2) or (num_envs, 3), m; rows of NaN are drawn."""
    goal: NDArray[np.float64] | None = None
    """(num_envs, 2) or, of markers, (num_envs, 3), m; rows of NaN are drawn."""
    terrain: NDArray[np.int64] | None = None
    """(num_envs,) indices into the pool."""


def parse(
    options: Mapping[str, Any] | None,
    pool: Sequence[int | None],
    num_envs: int,
    *,
    batched: bool,
    grounds: str = "beacon",
) -> Placement:
    """The placement that `options` asks for.

    Args:
        options: `start` (x, y) or (x, y, z) in m, `goal` (x, y), of a marker also (x, y, z), in m,
            `terrain_seed`; each may be left out, and is drawn then.
        pool: seeds of the terrains in the pool, None for one that was not generated.
        num_envs: rows of the result.
        batched: one row per environment is accepted too, (num_envs, 2) and the like; a row of NaN is drawn.
        grounds: kind of goal: `beacon`, `marker` or `stands`, where it is no place of one's own.

    Raises:
        TypeError, ValueError: naming the key, what was expected and what came.

    >>> parse({"goal": (100, 50)}, [0, 1], 2, batched=True).goal
    array([[100.,  50.],
           [100.,  50.]])
    >>> parse({"terrain_seed": 7}, [0, 1], 1, batched=False)
    Traceback (most recent call last):
    ValueError: options['terrain_seed']: expected one of the pool's seeds 0, 1, got 7
    """
    if options is None:
        return Placement()
    if not isinstance(options, Mapping):
        raise TypeError(f"options: expected a mapping, got {options!r} of type {type(options).__name__}")
    _check.known("options", options, (*KEYS, "reset_mask") if batched else KEYS)
    if not GOALS[grounds] and options.get("goal") is not None:
        raise ValueError(
            f"options['goal']: expected none where the goal is the enemy flag, got {options['goal']!r:.80}; "
            "the environment's argument flags=((x, y), (x, y)) says where the flags stand"
        )
    return Placement(
        _points("start", options.get("start"), (2, 3), num_envs, batched),
        _points("goal", options.get("goal"), GOALS[grounds], num_envs, batched),
        _terrain(options.get("terrain_seed"), pool, num_envs, batched),
    )


def _points(
    key: str, value: object, widths: tuple[int, ...], num_envs: int, batched: bool
) -> NDArray[np.float64] | None:
    if value is None:
        return None
    name = f"options[{key!r}]"
    shapes: list[tuple[int, ...]] = [(width,) for width in widths]
    if batched:
        shapes += [(num_envs, width) for width in widths]
    points = _check.array(name, value, shapes, "m")
    drawn = np.isnan(points).all(axis=-1, keepdims=True) if points.ndim == 2 else np.zeros(1, np.bool_)
    if not (np.isfinite(points) | drawn).all():
        raise ValueError(f"{name}: expected finite numbers in m, got {points.tolist()!r:.80}")
    return np.ascontiguousarray(np.broadcast_to(points, (num_envs, points.shape[-1])))


def _terrain(
    value: object, pool: Sequence[int | None], num_envs: int, batched: bool
) -> NDArray[np.int64] | None:
    if value is None:
        return None
    name = "options['terrain_seed']"
    if not batched or np.ndim(value) == 0:  # type: ignore[arg-type]
        return np.full(num_envs, _index(name, value, pool), np.int64)
    seeds = list(value)  # type: ignore[call-overload]
    if len(seeds) != num_envs:
        raise ValueError(f"{name}: expected one seed or {num_envs} of them, got {len(seeds)}")
    return np.array([_index(f"{name}[{i}]", seed, pool) for i, seed in enumerate(seeds)], np.int64)


def _index(name: str, value: object, pool: Sequence[int | None]) -> int:
    seed = _check.integer(name, value, 0, _check.SEEDS - 1)
    if seed not in pool:
        seeds = [str(known) for known in pool if known is not None]
        raise ValueError(
            f"{name}: expected one of the pool's seeds {', '.join(seeds) or '(it has none)'}, got {seed}"
        )
    return pool.index(seed)
