"""The surface between the heights, triangles or bilinear: a property of terrains and an option of tasks."""

import copy
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

import discjump
from discjump import terrains
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.sb3 import make_vec_env

from .play import SHORT, random_actions, same_bits

RNG = np.random.default_rng(4)
ROUGH = RNG.uniform(0, 30, (9, 12))
TILING = np.pad(ROUGH, ((0, 1), (0, 1)), mode="wrap")
SIZE, ORIGIN = 8.0, (-40.0, 24.0)


def places(shape, beyond):
    """(n, 2): anywhere, on sides of squares, on vertices, and an ulp beside each."""
    low = np.array(ORIGIN) - beyond * SIZE
    span = (np.array(shape[::-1]) - 1 + 2 * beyond) * SIZE
    anywhere = low + RNG.random((4000, 2)) * span
    whole = np.array(ORIGIN) + np.round((anywhere - ORIGIN) / SIZE) * SIZE
    sides = np.where(RNG.random((4000, 2)) < 0.5, anywhere, whole)
    exact = np.concatenate([anywhere, whole, sides])
    return np.concatenate([exact, np.nextafter(exact, np.inf), np.nextafter(exact, -np.inf)])


def extended(heights, edge):
    """Heights with 4 squares more on every side, as the edge has them."""
    if edge == "tile":
        return np.pad(heights[:-1, :-1], ((4, 5), (4, 5)), mode="wrap")
    return np.pad(heights, 4, mode="edge")


def scipys(heights):
    """SciPy's interpolator of heights that begin 4 squares before the origin; "linear" is bilinear."""
    axes = [ORIGIN[1 - axis] + SIZE * (np.arange(heights.shape[axis]) - 4) for axis in (0, 1)]
    return RegularGridInterpolator(tuple(axes), heights, method="linear")


def scipys_normals(witness, points, hair):
    """In the square a hair to one side: along x and y the ground is straight from side to side."""
    corner = np.array(ORIGIN) + np.floor((points + 1e-12 * (np.array(hair) - 1) - ORIGIN) / SIZE) * SIZE
    slopes = np.empty_like(points)
    for axis in (0, 1):
        before, after = points.copy(), points.copy()
        before[:, axis], after[:, axis] = corner[:, axis], corner[:, axis] + SIZE
        # Across, the point itself: at most a hair outside the square, where heights are the same.
        slopes[:, axis] = (witness(after[:, ::-1]) - witness(before[:, ::-1])) / SIZE
    normals = np.column_stack([-slopes, np.ones(len(points))])
    return normals / np.linalg.norm(normals, axis=1)[:, None]


@pytest.mark.parametrize(("edge", "heights"), [("tile", TILING), ("clamp", ROUGH), ("void", ROUGH)])
def test_heights_and_normals_are_scipys(edge, heights):
    terrain = discjump.Terrain.from_heights(heights, SIZE, ORIGIN, edge, surface="bilinear")
    points = places(heights.shape, 3)
    size = (np.array(heights.shape[::-1]) - 1) * SIZE
    got, normals = terrain.height(points), terrain.normal(points)
    if edge == "void":
        # An ulp beside the rim rounds onto it.
        low, high = np.array(ORIGIN), np.array(ORIGIN) + size
        outside = ((points < low - 1e-9) | (points >= high)).any(axis=1)
        inside = ((points >= low) & (points < high - 1e-9)).all(axis=1)
        assert np.isnan(got[outside]).all()
        assert np.isnan(normals[outside]).all()
        points, got, normals = points[inside], got[inside], normals[inside]
    witness = scipys(extended(heights, edge))
    np.testing.assert_allclose(got, witness(points[:, ::-1]), rtol=0, atol=1e-12)
    # On a side, to rounding, the normal is that of either square.
    expected = [scipys_normals(witness, points, hair) for hair in np.ndindex(3, 3)]
    off = np.min([np.abs(normals - one).max(axis=1) for one in expected], axis=0)
    assert off.max() < 1e-11
    # Exactly on a side it is the one farther east or north.
    whole = (points == np.round(points)).all(axis=1)
    np.testing.assert_allclose(normals[whole], expected[4][whole], rtol=0, atol=1e-11)
    assert whole.sum() > 1000
    assert len(points) > 10_000


def test_a_terrain_has_one_and_can_be_given_another():
    cut = discjump.Terrain.raindance(3)
    smooth = cut.with_surface("bilinear")
    assert (cut.surface, smooth.surface) == ("triangles", "bilinear")
    same_bits(smooth.heights, cut.heights)
    same_bits(smooth.mission, cut.mission)
    assert smooth.solids_digest() == cut.solids_digest()
    assert smooth.statistics() == cut.statistics()
    assert smooth.digest() != cut.digest()
    assert smooth.with_surface("triangles").digest() == cut.digest()
    assert discjump.Terrain.raindance(3, surface="bilinear").digest() == smooth.digest()
    assert terrains.generated(3, surface="bilinear").digest() == smooth.digest()
    assert 'surface "bilinear"' in repr(smooth)
    assert "surface" not in repr(cut)
    points = np.array(ORIGIN) + RNG.random((1000, 2)) * 500
    apart = np.abs(smooth.height(points) - cut.height(points))
    assert 0 < apart.max() < 5
    # At the vertices they are one.
    np.testing.assert_array_equal(
        smooth.height([[-1024.0, 512.0], [8.0, -16.0]]), cut.height([[-1024, 512], [8, -16]])
    )


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_copies_keep_it(again):
    own = discjump.Terrain.from_heights(ROUGH, edge="clamp", surface="bilinear")
    for one in (discjump.Terrain.raindance(5, surface="bilinear"), own, own.with_solids([])):
        other = again(one)
        assert (other.surface, other.digest()) == ("bilinear", one.digest())


@pytest.mark.parametrize(
    "make",
    [SkiEnv, lambda **o: SkiVectorEnv(2, **o), lambda **o: make_vec_env("discjump/Ski-v0", n_envs=2, **o)],
)
def test_refusals(make):
    smooth = discjump.Terrain.raindance(1, surface="bilinear")
    cut = smooth.with_surface("triangles")
    with pytest.raises(ValueError, match=r"surface: expected one of 'triangles', 'bilinear', got 'cubic'"):
        make(surface="cubic")
    with pytest.raises(TypeError, match=r"surface: expected one of .* got 3 of type int"):
        make(surface=3)
    with pytest.raises(ValueError, match=r"terrains\[1\]: expected surface 'bilinear' like terrains\[0\]"):
        make(terrains=[smooth, cut])
    with pytest.raises(
        ValueError, match=r"surface: expected 'bilinear', which the given terrains have, got 'tri"
    ):
        make(terrains=[smooth], surface="triangles")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: discjump.Terrain.raindance(0, surface="cubic"), "cubic"),
        (lambda: discjump.Terrain.from_heights(ROUGH, edge="clamp", surface="cubic"), "cubic"),
        (lambda: discjump.Terrain.raindance(0).with_surface(""), '""'),
    ],
)
def test_other_names_are_refused(make, message):
    with pytest.raises(ValueError, match=f'surface: expected "triangles" or "bilinear", got .*{message}'):
        make()


@pytest.mark.parametrize("surface", [1, None])
def test_what_is_no_name_is_refused(surface):
    with pytest.raises(TypeError, match="surface"):
        discjump.Terrain.raindance(0, surface=surface)


def test_every_way_to_make_environments_plays_the_same_on_it():
    vector: Any = gymnasium.make_vec("discjump/Ski-v0", num_envs=4, surface="bilinear", **SHORT).unwrapped
    own = [discjump.Terrain.raindance(seed, surface="bilinear") for seed in SHORT["terrain_seeds"]]
    rest = {name: value for name, value in SHORT.items() if name != "terrain_seeds"}
    given = SkiVectorEnv(4, terrains=own, surface="bilinear", **rest)
    single = [gymnasium.make("discjump/Ski-v0", surface="bilinear", **SHORT) for _ in range(4)]
    flat = make_vec_env("discjump/Ski-v0", n_envs=4, seed=0, surface="bilinear", **SHORT)
    cut = SkiVectorEnv(4, **SHORT)
    assert {env.options.surface for env in (vector, given)} == {"bilinear"}
    assert cut.options.surface == "triangles"
    observations = vector.reset(seed=0)[0]
    same_bits(given.reset(seed=0)[0], observations)
    same_bits(np.stack([env.reset(seed=k)[0] for k, env in enumerate(single)]), observations)
    same_bits(flat.reset(), observations)
    assert (cut.reset(seed=0)[0] != observations).any()
    for actions in random_actions(0, 20, 4):
        step = vector.step(actions)
        same_bits(given.step(actions)[:4], step[:4])
        same_bits(np.stack([env.step(a)[0] for env, a in zip(single, actions, strict=True)]), step[0])
        same_bits(flat.step(actions)[0], step[0])


def test_the_simulator_stands_on_it():
    terrain = discjump.Terrain.raindance(2, surface="bilinear")
    sim = discjump.Simulator(terrain, 64, fidelity="reference")
    state = sim.state()
    state["position"][:, :2] = np.array(terrain.play_area[0]) + RNG.random((64, 2)) * 800
    state["position"][:, 2] = terrain.height(state["position"][:, :2])
    sim.set_state(state)
    sim.step(sim.inputs(), 50)
    state = sim.state()
    feet = state["position"][:, 2] - terrain.height(state["position"][:, :2])
    assert state["touched"].all()
    assert np.abs(feet).max() < 1e-6
    np.testing.assert_allclose(state["jump_normal"], terrain.normal(state["position"][:, :2]), atol=1e-6)
