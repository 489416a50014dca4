"""Terrains as plain data: generated ones by their seed, others with their heights."""

from typing import Any

from discjump import _native
from discjump.replays.bare.codec import Arrays
from discjump.replays.errors import ReplayError
from discjump.terrains import generated


def plain(terrain: _native.Terrain, arrays: Arrays, *, solids: bool) -> dict[str, Any]:
    """What `bare.build.terrain` makes the terrain of again; heights and solids go into `arrays`.

    Args:
        terrain: to be described.
        arrays: what is too large for a header is put here.
        solids: whether what stands on it matters.
    """
    made: dict[str, Any] = {"digest": terrain.digest(), "surface": terrain.surface}
    own = True
    if terrain.seed is None:
        name = _free("heights", arrays)
        arrays[name] = terrain.heights
        made |= {"heights": name, "square_size": terrain.square_size, "origin": list(terrain.origin)}
        made |= {"edge": terrain.edge}
        own = bool(terrain.solids)
    else:
        bare = _generated(terrain)
        made |= {"seed": terrain.seed, "repeating": bare[1]}
        own = bare[0].solids_digest() != terrain.solids_digest()
    made["solids"] = [_solid(one, arrays) for one in terrain.solids] if solids and own else None
    return made


def _generated(terrain: _native.Terrain) -> tuple[_native.Terrain, bool]:
    for repeating in (False, True):
        bare = generated(terrain.seed or 0, repeating, terrain.surface)
        if bare.digest() == terrain.digest():
            return bare, repeating
    raise ReplayError(f"terrain: expected what its seed {terrain.seed} generates, got other bits")


def _solid(solid: Any, arrays: Arrays) -> dict[str, Any]:
    points, faces = _free("points", arrays), _free("faces", arrays)
    arrays[points], arrays[faces] = solid.points, solid.faces
    return {
        "kind": solid.kind,
        "name": solid.name,
        "points": points,
        "faces": faces,
        "position": list(solid.position),
        "rotation": list(solid.rotation),
        "scale": solid.scale,
    }


def _free(name: str, arrays: Arrays) -> str:
    return next(f"{name}{k}" for k in range(len(arrays) + 1) if f"{name}{k}" not in arrays)
