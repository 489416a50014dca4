"""Solids through Python: made, placed, loaded, refused, copied; and ignored by scenes that model none."""

import copy
import pickle
import subprocess
import sys
import time
from typing import Any

import numpy as np
import pytest

import discjump
from discjump import SCENES, Solid, Terrain
from discjump.simulator import FIDELITIES

from .meshes import cube, slab, write_glb, write_obj
from .play import same_bits

FLAT = Terrain.from_heights(np.zeros((65, 65)), origin=(-256.0, -256.0))
CORNERS, FACES = cube()


def landed(terrain: Terrain, xy: tuple[float, float], fidelity: str = "reference") -> float:
    """Height at which a player who is dropped there stops."""
    sim = discjump.Simulator(terrain, scene="mission", fidelity=fidelity, threads=1)
    state = sim.state()
    state["position"] = (*xy, 40.0)
    sim.set_state(state)
    sim.step(sim.inputs(), 150)
    return float(sim.state()["position"][0, 2])


@pytest.mark.parametrize("fidelity", FIDELITIES)
@pytest.mark.parametrize(
    ("solid", "top"),
    [
        (Solid.box((6, 4, 3), (10, 20, 7)), 8.5),
        (Solid.box((6, 4, 3), (10, 20, 7), 1.2), 8.5),
        (Solid.hull(CORNERS, (10, 20, 7), scale=3.0), 10.0),
        (Solid.mesh(CORNERS, FACES, (10, 20, 7), 0.4, 2.0), 9.0),
    ],
    ids=["box", "turned box", "hull", "mesh"],
)
def test_shapes_stand_where_they_were_put(solid: Solid, top: float, fidelity: str) -> None:
    terrain = FLAT.with_solids([solid])
    # What was given is what is told.
    (told,) = terrain.solids
    for name in ("kind", "name", "position", "rotation", "scale"):
        assert getattr(told, name) == getattr(solid, name)
    same_bits(told.points, solid.points)
    same_bits(told.faces, solid.faces)
    # Who stops is put back to where the bump began: up to a slice of a metre above what stopped him.
    assert top - 1e-3 <= landed(terrain, (10.0, 20.0), fidelity) < top + 1.0
    assert -1e-3 <= landed(terrain, (30.0, 20.0), fidelity) < 1.0
    assert FLAT.solids == []


def test_a_yaw_turns_counter_clockwise() -> None:
    """A beam along +x, turned by 30 degrees, lies over (10 cos 30, 10 sin 30) and not over its mirror."""
    terrain = FLAT.with_solids([Solid.box((40.0, 1.0, 2.0), (0.0, 0.0, 5.0), np.pi / 6.0)])
    for sign, height in ((1.0, 6.0), (-1.0, 0.0)):
        x, y = 15.0 * np.cos(np.pi / 6.0), sign * 15.0 * np.sin(np.pi / 6.0)
        assert height - 1e-9 <= landed(terrain, (x, y)) < height + 1.0


@pytest.mark.parametrize("ending", ["obj", "glb"])
def test_files(tmp_path, ending: str) -> None:
    write = write_obj if ending == "obj" else write_glb
    vertices, faces = slab(6)
    path = write(tmp_path / f"slab.{ending}", vertices, faces)
    loaded = Solid.load(path, position=(5.0, 6.0, 7.0), yaw=0.5, scale=2.0)
    assert (loaded.kind, loaded.name) == ("mesh", f"slab.{ending}")
    assert Solid.load(str(path), name="deck").name == "deck"
    corners = loaded.points[loaded.faces.astype(int)]
    np.testing.assert_allclose(corners, vertices[faces], rtol=0.0, atol=1e-6)
    # The same solid as one of the arrays (of float32, as the GLB has them).
    given = vertices if ending == "obj" else vertices.astype(np.float32)
    same = Solid.mesh(given, faces, (5.0, 6.0, 7.0), 0.5, 2.0)
    heights = [landed(FLAT.with_solids([solid]), (6.0, 6.5)) for solid in (loaded, same)]
    assert heights[0] == heights[1] > 5.0


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("gone.obj", None, "readable"),
        ("mesh.stl", b"solid", r"\.obj, \.gltf or \.glb"),
        ("empty.obj", b"", "triangles"),
        ("words.obj", b"v 1 2 three\n", "OBJ"),
        ("far.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "OBJ"),
        ("words.glb", b"glTF", "glTF"),
        ("short.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff", "glTF"),
        ("empty.gltf", b"{}", "glTF"),
    ],
)
def test_bad_files_are_refused_by_name(tmp_path, name: str, content: bytes | None, message: str) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ValueError, match=rf"{name}.*{message}"):
        Solid.load(path)


def test_a_file_cut_off_anywhere_is_refused(tmp_path) -> None:
    whole = write_glb(tmp_path / "whole.glb", CORNERS, FACES).read_bytes()
    path = tmp_path / "cut.glb"
    for length in range(0, len(whole) - 4, 7):
        path.write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"cut\.glb"):
            Solid.load(path)


def changed(index: tuple[int, ...], value: float) -> np.ndarray[Any, Any]:
    corners = CORNERS.copy()
    corners[index] = value
    return corners


OPEN = FACES[:-1]
INVERTED = FACES[:, ::-1]
ONE_TURNED = np.where(np.arange(12)[:, None] == 4, FACES[:, ::-1], FACES)


@pytest.mark.parametrize(
    ("solid", "message"),
    [
        (Solid.mesh(CORNERS, OPEN), "hole at face"),
        (Solid.mesh(CORNERS, INVERTED), "inside out"),
        (Solid.mesh(CORNERS, ONE_TURNED), "face 4 wound against|against face 4"),
        (Solid.mesh(changed((3, 1), np.nan), FACES), "vertices.*NaN.*vertex 3"),
        (Solid.mesh(changed((5, 2), np.inf), FACES), "vertices.*inf.*vertex 5"),
        (Solid.mesh(changed((5, 2), 2e6), FACES), "vertices.*vertex 5"),
        (Solid.mesh(CORNERS, np.where(FACES == 7, 8, FACES)), "below 8.*face"),
        (Solid.mesh(CORNERS, FACES[:0]), "at least one"),
        (Solid.mesh(CORNERS * [1.0, 1.0, 1e-9], FACES), "no area at face"),
        (Solid.mesh(np.repeat(CORNERS[:1], 8, axis=0), FACES), "no area at face"),
        (Solid.mesh(CORNERS, FACES, position=(0.0, 0.0, np.nan)), "position"),
        (Solid.mesh(CORNERS, FACES, position=(1000.0, 0.0, 0.0)), "on the map, x"),
        (Solid.mesh(CORNERS, FACES, position=(0.0, -1000.0, 0.0)), "on the map, y"),
        (Solid.hull(CORNERS[:4]), "volume"),
        (Solid.hull(CORNERS[:3]), "points"),
        (Solid.hull(np.full((9, 3), np.nan)), "NaN"),
        (Solid.box((1.0, 0.0, 1.0)), "size"),
        (Solid.box((1.0, np.inf, 1.0)), "size"),
    ],
)
def test_bad_solids_are_refused_by_number_and_name(solid: Solid, message: str) -> None:
    solid = Solid(
        solid.kind, "bad one", solid.points, solid.faces, solid.position, solid.rotation, solid.scale
    )
    with pytest.raises(ValueError, match=rf'solids\[1\] "bad one".*({message})'):
        FLAT.with_solids([Solid.box((1, 1, 1)), solid])


ARGUMENTS = [
    (lambda: Solid.box((1, 1)), ValueError, "size"),
    (lambda: Solid.box("big"), TypeError, "size"),
    (lambda: Solid.box((1, 1, 1), position=(0, 0)), ValueError, "position"),
    (lambda: Solid.box((1, 1, 1), yaw=float("nan")), ValueError, "yaw"),
    (lambda: Solid.box((1, 1, 1), yaw="north"), TypeError, "yaw"),  # type: ignore[arg-type]
    (lambda: Solid.box((1, 1, 1), name=3), TypeError, "name"),  # type: ignore[arg-type]
    (lambda: Solid.hull(CORNERS, scale=0.0), ValueError, "scale"),
    (lambda: Solid.hull(CORNERS, scale=True), TypeError, "scale"),
    (lambda: Solid.hull(CORNERS[:, :2]), ValueError, "points"),
    (lambda: Solid.hull([[1, 2, 3], [4, 5]]), ValueError, "points.*ragged"),
    (lambda: Solid.hull(None), ValueError, "points"),  # type: ignore[arg-type]
    (lambda: Solid.mesh([[1, 2, 3], [4, 5]], FACES), ValueError, "vertices.*ragged"),
    (lambda: Solid.mesh(CORNERS, [[0, 1, 2], [3]]), ValueError, "faces.*ragged"),
    (lambda: Solid.mesh(CORNERS, FACES.astype(float)), ValueError, "faces"),
    (lambda: Solid.mesh(CORNERS, FACES - 1), ValueError, "faces.*-1"),
    (lambda: Solid.mesh(CORNERS, FACES + 2**32), ValueError, "faces"),
    (lambda: Solid.mesh(CORNERS, FACES[0]), ValueError, "faces"),
    (lambda: Solid.load(3), TypeError, "path"),  # type: ignore[arg-type]
    (lambda: Solid.load("a\0.obj"), ValueError, "readable"),
]


@pytest.mark.parametrize(("make", "kind", "message"), ARGUMENTS)
def test_bad_arguments(make: Any, kind: type[Exception], message: str) -> None:
    """Caught: rows of different lengths were refused by numpy, which does not know whose they are."""
    with pytest.raises(kind, match=message):
        make()


@pytest.mark.parametrize(
    ("solids", "message"),
    [
        (5, "solids: expected a sequence"),
        (None, "solids: expected a sequence"),
        (Solid.box((1, 1, 1)), "solids: expected a sequence"),
        ("abc", r"solids\[0\]"),
        ([Solid.box((1, 1, 1)), None], r"solids\[1\]: expected a discjump\.Solid"),
        ([Solid], r"solids\[0\]"),
    ],
)
def test_what_is_no_solid(solids: Any, message: str) -> None:
    """Caught: `with_solids([None])` was an AttributeError that named `kind` and no argument."""
    with pytest.raises(TypeError, match=message):
        FLAT.with_solids(solids)


def test_a_million_triangles() -> None:
    vertices, faces = slab(500)
    assert len(faces) > 1_000_000
    begun = time.perf_counter()
    terrain = FLAT.with_solids([Solid.mesh(vertices, faces, position=(0.0, 0.0, 20.0))])
    # Some 2.5 s on two cores of a shared machine.
    assert time.perf_counter() - begun < 60.0
    # On the slope of a wave between 17 and 23 m.
    assert 17.0 < landed(terrain, (0.0, 0.0)) < 23.0


MADE = [
    lambda: FLAT.with_solids([Solid.box((1, 2, 3), (1, 2, 3), 0.4), Solid.mesh(CORNERS, FACES, name="dé")]),
    lambda: Terrain.raindance(5).with_solids([]),
    lambda: (lambda t: t.with_solids([*t.solids, Solid.hull(CORNERS, (0, 0, 90))]))(Terrain.raindance(5)),
    lambda: Terrain.raindance(5),
]


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize("make", MADE, ids=["own", "none", "more", "mission"])
def test_copies_and_pickles_keep_their_solids(make: Any, again: Any) -> None:
    one = make()
    other = again(one)
    assert (other.digest(), other.solids_digest()) == (one.digest(), one.solids_digest())
    assert len(other.solids) == len(one.solids)
    for left, right in zip(one.solids, other.solids, strict=True):
        same_bits(left.points, right.points)
        assert left.rotation == right.rotation


def test_a_terrain_is_pickled_by_discjump_alone() -> None:
    """Caught: only a module that nobody had imported yet told how, so `import discjump` alone could not."""
    script = (
        "import pickle, discjump; one = discjump.Terrain.from_heights([[1.0, 1.0], [1.0, 1.0]]); "
        "print(pickle.loads(pickle.dumps(one)).digest() == one.digest())"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True"


@pytest.mark.parametrize("fidelity", FIDELITIES)
@pytest.mark.parametrize("scene", [name for name, scene in SCENES.items() if "solids" in scene.leaves_out])
def test_scenes_without_solids_ignore_them(scene: str, fidelity: str) -> None:
    """To the last bit, in the middle of one; its snapshots fit those of the bare map too."""
    walled = FLAT.with_solids([Solid.box((20.0, 4.0, 4.0)), Solid.box((200.0, 1.0, 60.0), (0, 10, 0))])
    sims = [discjump.Simulator(t, 2, scene, fidelity=fidelity, threads=1) for t in (FLAT, walled)]
    inputs = sims[0].inputs()
    inputs["forward"], inputs["jump"], inputs["jet"], inputs["fire"] = 1, True, True, True
    for sim in sims:
        sim.step(inputs, 60)
    assert sims[0].state().tobytes() == sims[1].state().tobytes()
    assert sims[0].digest() == sims[1].digest()
    sims[0].restore(sims[1].snapshot())
    with_solids = discjump.Simulator(walled, 2, "mission", fidelity=fidelity, threads=1)
    with_solids.step(inputs, 60)
    assert with_solids.state()["position"].tobytes() != sims[0].state()["position"].tobytes()
    with pytest.raises(ValueError, match="snapshot"):
        discjump.Simulator(FLAT, 2, "mission", fidelity=fidelity).restore(with_solids.snapshot())
