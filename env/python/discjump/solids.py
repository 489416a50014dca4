"""Solids: bases, bridges, towers and walls that stand on a terrain.

    terrain = terrain.with_solids([*terrain.solids, Solid.box((4, 4, 10), position=(0, 0, 40))])

Only scenes that model solids look at them (`mission`). See core/docs/solids.md for what is accepted.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discjump import _check, _native

#: Farthest that anything may stand from the origin along an axis, m; also the largest scale.
_FAR = 1e6


@dataclass(frozen=True, eq=False)
class Solid:
    """One solid: a shape in its own coordinates, and where it stands. Metres, z up.

    Make one with `Solid.box`, `Solid.hull`, `Solid.mesh` or `Solid.load`. Whether it is a closed body is
    checked by `Terrain.with_solids`.
    """

    #: "box", "hull" or "mesh".
    kind: str
    #: What errors call it.
    name: str
    #: float64 (n, 3): the sides of a box (n = 1), the points of a hull, the vertices of a mesh.
    points: NDArray[np.float64]
    #: uint32 (m, 3): vertex numbers of a mesh's triangles, counter-clockwise as seen from outside.
    faces: NDArray[np.uint32]
    #: Where the shape's origin stands.
    position: tuple[float, float, float]
    #: A unit quaternion (x, y, z, w).
    rotation: tuple[float, float, float, float]
    #: Same along all axes; applied first, then the rotation, then the position.
    scale: float

    def __post_init__(self) -> None:
        """Take arrays of whatever the fields were given."""
        if not isinstance(self.name, str):
            raise TypeError(f"name: expected a str, got {type(self.name).__name__}")
        object.__setattr__(self, "points", np.asarray(self.points, np.float64).reshape(-1, 3))
        object.__setattr__(self, "faces", np.asarray(self.faces, np.uint32).reshape(-1, 3))
        object.__setattr__(self, "position", tuple(self.position))
        object.__setattr__(self, "rotation", tuple(self.rotation))

    @staticmethod
    def box(
        size: ArrayLike, position: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0, *, name: str = "box"
    ) -> Solid:
        """A box by its full sides (3,), its middle at `position`, turned by `yaw` rad counter-clockwise.

        >>> Solid.box((16, 128, 1), position=(0, 0, 60)).kind
        'box'
        """
        sides = _check.array("size", size, [(3,)], "m")
        return Solid("box", name, sides[None], np.zeros((0, 3), np.uint32), *_placed(position, yaw, 1.0))

    @staticmethod
    def hull(
        points: ArrayLike,
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        scale: float = 1.0,
        *,
        name: str = "hull",
    ) -> Solid:
        """The convex hull of points (n, 3), n >= 4."""
        corners = _rows("points", points)
        return Solid("hull", name, corners, np.zeros((0, 3), np.uint32), *_placed(position, yaw, scale))

    @staticmethod
    def mesh(
        vertices: ArrayLike,
        faces: ArrayLike,
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        scale: float = 1.0,
        *,
        name: str = "mesh",
    ) -> Solid:
        """A closed mesh: vertices (n, 3), and triangles (m, 3) of vertex numbers, counter-clockwise."""
        given = _check.numbers("faces", faces, "integers of shape (m, 3)")
        if given.dtype.kind not in "iu" or given.ndim != 2 or given.shape[1] != 3:
            raise ValueError(
                f"faces: expected integers of shape (m, 3), got {given.dtype} of shape {given.shape}"
            )
        if given.size and (given.min() < 0 or given.max() > np.iinfo(np.uint32).max):
            raise ValueError(f"faces: expected vertex numbers from 0, got {given.min()} to {given.max()}")
        corners = _rows("vertices", vertices)
        return Solid("mesh", name, corners, given.astype(np.uint32), *_placed(position, yaw, scale))

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        scale: float = 1.0,
        *,
        name: str | None = None,
    ) -> Solid:
        """The mesh of an OBJ or glTF file (.obj, .gltf, .glb); `scale` makes metres of its units.

        Raises:
            ValueError: unreadable, or not what its ending promises.
        """
        if not isinstance(path, str | os.PathLike):
            raise TypeError(f"path: expected a path, got {type(path).__name__}")
        vertices, faces = _native.load_mesh(os.fspath(path))
        called = Path(path).name if name is None else name
        points = np.asarray(vertices, np.float64).reshape(-1, 3)
        indices = np.asarray(faces, np.uint32).reshape(-1, 3)
        return Solid("mesh", called, points, indices, *_placed(position, yaw, scale))


def _placed(
    position: ArrayLike, yaw: float, scale: float
) -> tuple[tuple[float, float, float], tuple[float, float, float, float], float]:
    x, y, z = (float(c) for c in _check.array("position", position, [(3,)], "m"))
    half = 0.5 * _check.real("yaw", yaw, -1e6, 1e6, "rad")
    factor = _check.real("scale", scale, 0.0, _FAR, "", open_low=True)
    return (x, y, z), (0.0, 0.0, math.sin(half), math.cos(half)), factor


def _rows(name: str, value: ArrayLike) -> NDArray[np.float64]:
    array = _check.numbers(name, value, "numbers of shape (n, 3) in m")
    if array.dtype.kind not in "iuf" or array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: expected numbers of shape (n, 3) in m, got {array.dtype} {array.shape}")
    return array.astype(np.float64)
