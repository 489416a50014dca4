"""Meshes for the tests of solids, and files of them."""

import json
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Vertices = NDArray[np.float64]
Faces = NDArray[np.int64]


def cube(side: float = 2.0) -> tuple[Vertices, Faces]:
    """(8, 3) corners about the origin and (12, 3) faces, counter-clockwise as seen from outside."""
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) * 0.5 * side
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def slab(squares: int, size: float = 0.5, thickness: float = 2.0) -> tuple[Vertices, Faces]:
    """A closed wavy slab about the origin: about 4 squares^2 faces."""
    n = squares
    axis = (np.arange(n + 1) - 0.5 * n) * size
    x, y = np.meshgrid(axis, axis)
    top = np.stack([x, y, 3.0 * np.sin(x / 9.0)], axis=-1).reshape(-1, 3)
    side = np.arange(n)
    i, j = (grid.ravel() for grid in np.meshgrid(side, side))

    def at(i: NDArray[np.int64] | int, j: NDArray[np.int64] | int, lower: int) -> NDArray[np.int64]:
        return np.asarray(lower * (n + 1) ** 2 + j * (n + 1) + i)

    def quads(*corners: NDArray[np.int64]) -> Faces:
        a, b, c, d = corners
        return np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])

    faces = [
        quads(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0)),
        quads(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1)),
        quads(at(side + 1, 0, 0), at(side, 0, 0), at(side, 0, 1), at(side + 1, 0, 1)),
        quads(at(side, n, 0), at(side + 1, n, 0), at(side + 1, n, 1), at(side, n, 1)),
        quads(at(0, side, 0), at(0, side + 1, 0), at(0, side + 1, 1), at(0, side, 1)),
        quads(at(n, side + 1, 0), at(n, side, 0), at(n, side, 1), at(n, side + 1, 1)),
    ]
    return np.concatenate([top, top - [0.0, 0.0, thickness]]), np.concatenate(faces)


def write_obj(path: Path, vertices: Vertices, faces: Faces) -> Path:
    """Wavefront OBJ: z up, faces counted from 1."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_glb(path: Path, vertices: Vertices, faces: Faces) -> Path:
    """Binary glTF 2.0: y up, so a point (x, y, z) is written as (x, z, -y)."""
    points = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=-1).astype("<f4")
    numbers = faces.astype("<u4")
    body = points.tobytes() + numbers.tobytes()
    scene = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(body)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": numbers.nbytes},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": len(points),
                "type": "VEC3",
                "min": points.min(axis=0).tolist(),
                "max": points.max(axis=0).tolist(),
            },
            {"bufferView": 1, "componentType": 5125, "count": numbers.size, "type": "SCALAR"},
        ],
    }
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path
