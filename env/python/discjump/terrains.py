"""Generated terrains, made once per process and shared: they are immutable and cost about 20 ms each."""

import copyreg
from functools import lru_cache
from typing import Any

from numpy.typing import NDArray

from discjump import _check
from discjump._native import Terrain
from discjump.solids import Solid

TRAINING_SEEDS = tuple(range(16))
"""Seeds of the default pool."""

SURFACES = ("triangles", "bilinear")
"""What may lie between the heights; the first is the game's."""


@lru_cache(maxsize=64)
def generated(seed: int, repeating: bool = False, surface: str = SURFACES[0]) -> Terrain:
    """`Terrain.raindance(seed, repeating=repeating, surface=surface)`; the 64 used last are kept.

    >>> generated(3) is generated(3)
    True
    """
    if surface == SURFACES[0]:
        return Terrain.raindance(seed, repeating=repeating)
    return generated(seed, repeating, SURFACES[0]).with_surface(surface)


def pool(seeds: object, repeating: bool = False, surface: str = SURFACES[0]) -> list[Terrain]:
    """The terrains of `seeds`, in their order.

    Args:
        seeds: a non-empty sequence of different integers from 0 to 2**64 - 1.
        repeating: the 512 m repeating cell instead of 2,048 m without repetition.
        surface: "triangles" or "bilinear".

    Raises:
        TypeError: `seeds` is no sequence of integers.
        ValueError: it is empty, has a seed twice or one out of range.
    """
    return [generated(seed, repeating, surface) for seed in checked_seeds(seeds)]


def checked_seeds(seeds: object) -> tuple[int, ...]:
    """`seeds` as a tuple of ints; raises as `pool` does.

    >>> checked_seeds([4, 4])
    Traceback (most recent call last):
    ValueError: terrain_seeds: expected different seeds, got 4 more than once
    """
    given = _check.sequence("terrain_seeds", seeds, "integers")
    checked = tuple(
        _check.integer(f"terrain_seeds[{i}]", seed, 0, _check.SEEDS - 1) for i, seed in enumerate(given)
    )
    if not checked:
        raise ValueError("terrain_seeds: expected at least one seed, got none")
    if len(set(checked)) < len(checked):
        twice = next(seed for i, seed in enumerate(checked) if seed in checked[:i])
        raise ValueError(f"terrain_seeds: expected different seeds, got {twice} more than once")
    return checked


def _reduced(terrain: Terrain) -> tuple[Any, tuple[Any, ...]]:
    """How to make a terrain again: copies and pickles of one have the same bits."""
    if terrain.seed is None:
        given = (terrain.heights, terrain.square_size, terrain.origin, terrain.edge, terrain.surface)
        return _from_heights, (*given, terrain.solids)
    for repeating in (False, True):
        bare = generated(terrain.seed, repeating, terrain.surface)
        if bare.digest() == terrain.digest():
            if bare.solids_digest() == terrain.solids_digest():
                return generated, (terrain.seed, repeating, terrain.surface)
            return _with_solids, (terrain.seed, repeating, terrain.surface, terrain.solids)
    raise ValueError(f"terrain: expected what its seed {terrain.seed} generates, got other bits")


def _from_heights(
    heights: NDArray[Any],
    square_size: float,
    origin: tuple[float, float],
    edge: str,
    surface: str,
    solids: list[Solid],
) -> Terrain:
    return Terrain.from_heights(heights, square_size, origin, edge, surface).with_solids(solids)


def _with_solids(seed: int, repeating: bool, surface: str, solids: list[Solid]) -> Terrain:
    return generated(seed, repeating, surface).with_solids(solids)


# gymnasium copies the keyword arguments of an environment, and workers of other processes get them pickled.
copyreg.pickle(Terrain, _reduced)
