"""What must hold of every tick, whatever the ground, the players, their keys, the tier and the scene."""

import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import discjump
from discjump.simulator import ARMORS, SCENES, SIMULATOR_FIDELITIES, WEAPONS

from .article import ARMORS as SUITS

TICKS = 40
SIDE = 128.0
"""Period of the random maps, m."""
WORLDS = 4

#: How deep below the ground a tick may end, m, by core/docs/tiers.md: `swept` dips by less than 2 m, in
#: f32 the others by rounding; whoever gets under the ground in `engine` and `anyway` falls.
DIP = {"reference": 1e-9, "authentic": 2e-3, "swept": 2.0, "fast": 2e-3}

#: Kick and radius (core/docs/physics.md, section 6 and the appendix).
BLASTS = {"disc": (150.0, 7.5), "grenade": (150.0, 15.0), "mortar": (250.0, 20.0)}


@dataclass(frozen=True)
class Case:
    """A drawn situation. What `seed` gives of places and keys is too much to be drawn one by one."""

    seed: int
    ground: int
    edge: str
    tier: str
    scene: str
    per_world: int
    armor: str
    pack: bool
    weapon: str
    tick_ms: int
    ski_bug: bool | None


CASES = st.builds(
    Case,
    seed=st.integers(0, 2**32 - 1),
    ground=st.integers(0, 5),
    edge=st.sampled_from(["tile", "tile", "clamp", "void"]),
    tier=st.sampled_from(SIMULATOR_FIDELITIES),
    scene=st.sampled_from(sorted(SCENES)),
    per_world=st.sampled_from([1, 1, 2, 3, 7]),
    armor=st.sampled_from(ARMORS),
    pack=st.booleans(),
    weapon=st.sampled_from(WEAPONS),
    tick_ms=st.sampled_from([32, 32, 32, 1, 16, 33, 64, 100, 1000]),
    ski_bug=st.sampled_from([None, False, True]),
)


@functools.cache
def terrain(ground: int, edge: str, solids: bool) -> discjump.Terrain:
    """Level (0) to rough with slopes of 70 degrees (5); heights that float32 holds."""
    rng = np.random.default_rng(ground)
    heights = rng.uniform(0.0, 4.0 * ground, (17, 17)).astype(np.float32).astype(np.float64)
    heights[-1], heights[:, -1] = heights[0], heights[:, 0]
    made = discjump.Terrain.from_heights(heights, 8.0, (-0.5 * SIDE, -0.5 * SIDE), edge)
    if not solids:
        return made
    boxes = [
        discjump.Solid.box(
            rng.uniform(0.3, 12.0, 3),
            (*rng.uniform(-40.0, 40.0, 2), rng.uniform(0.0, 20.0)),
            rng.uniform(-3.0, 3.0),
            name=f"box {k}",
        )
        for k in range(12)
    ]
    return made.with_solids(boxes)


def simulator(case: Case, worlds: int = WORLDS, threads: int = 1) -> discjump.Simulator:
    return discjump.Simulator(
        terrain(case.ground, case.edge, case.scene == "mission"),
        worlds * case.per_world,
        case.scene,
        case.armor,
        case.pack,
        case.tier,
        discjump.Physics(ski_bug=case.ski_bug),
        case.tick_ms,
        threads,
        players_per_world=case.per_world,
        weapon=case.weapon,
    )


def begin(sim: discjump.Simulator, case: Case) -> None:
    """The players of a world close to each other, at any speed; places that a far position holds exactly."""
    rng = np.random.default_rng(case.seed)
    many = WORLDS * case.per_world
    state = sim.state()
    centre = np.repeat(rng.uniform(-50.0, 50.0, (WORLDS, 2)), case.per_world, axis=0)
    xy = np.round((centre + rng.uniform(-5.0, 5.0, (many, 2))) * 1024.0) / 1024.0
    ground = terrain(case.ground, "clamp", False).height(xy)
    state["position"][:, :2] = xy
    state["position"][:, 2] = np.ceil((ground + rng.uniform(0.0, 6.0, many)) * 1024.0) / 1024.0
    direction = rng.normal(0.0, 1.0, (many, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    state["velocity"] = direction * (10.0 ** rng.uniform(-3.0, 3.0, (many, 1)))
    state["yaw"] = rng.uniform(-3.0, 3.0, many)
    state["energy"] = rng.uniform(0.0, SUITS[case.armor].max_energy, many).astype(np.float32)
    state["friction"] = rng.random(many)
    state["touched"] = rng.random(many) < 0.5
    sim.set_state(state)


def keys(case: Case) -> Iterator[NDArray[np.void]]:
    """Held for a few ticks each."""
    rng = np.random.default_rng(case.seed + 1)
    many = WORLDS * case.per_world
    inputs = np.zeros(many, discjump.INPUT)
    for tick in range(TICKS):
        if tick % 6 == 0:
            inputs["forward"], inputs["strafe"] = rng.integers(-1, 2, (2, many))
            inputs["jump"], inputs["jet"] = rng.random((2, many)) < 0.6
            inputs["fire"] = rng.random(many) < 0.6
            inputs["turn"] = rng.choice([0.0, 1.0, -3.0, 1000.0, -1000.0], many)
            inputs["pitch"] = rng.choice([0.0, -1.5, -0.7, 0.9, 1e300], many)
        yield inputs.copy()


def speeds(state: NDArray[np.void]) -> NDArray[np.float64]:
    metres: NDArray[np.float64] = np.linalg.norm(state["velocity"].astype(np.float64), axis=1)
    return metres


def most_gained(case: Case) -> tuple[float, float]:
    """Most that a tick adds to a speed, m/s: by itself, and for each burst in the world.

    A jump adds J/m, along its normal at most; gravity 20 dt; jets F/m dt, whichever way they point; walking
    F_g/m dt; a contact turns the velocity and adds 0.001 outwards, four times a tick at most. The Tribes form
    pushes hardest 1 + m from the box's centre, by (1 + m)(1 - 1/R) of kick over mass.
    """
    suit = SUITS[case.armor]
    dt = case.tick_ms / 1000.0
    forces = 20.0 + (suit.jet_force + suit.ground_force) / suit.mass
    own = suit.jump_impulse / suit.mass + forces * dt + 0.004
    kick, radius = BLASTS[case.weapon]
    box = min(2.0 * suit.half_width, suit.height)
    return own, kick / suit.mass * (1.0 + box) * (1.0 - 1.0 / radius)


@settings(max_examples=300)
@given(CASES)
def test_every_tick_leaves_possible_players(case: Case) -> None:
    sim = simulator(case)
    begin(sim, case)
    ground = terrain(case.ground, case.edge, False)
    own, burst = most_gained(case)
    worlds = np.arange(sim.num_players) // case.per_world
    before = sim.state()
    off = np.zeros(sim.num_players, bool)
    for tick, inputs in enumerate(keys(case)):
        sim.step(inputs)
        state = sim.state()
        where = f"tick {tick}"
        for name in state.dtype.names or ():
            assert np.isfinite(state[name]).all(), f"{where}: {name} {state[name]}"
        for shots in (sim.projectiles(), sim.blasts()):
            for name in shots.dtype.names or ():
                assert np.isfinite(shots[name]).all(), f"{where}: {name} {shots[name]}"
        assert (state["damage"] >= before["damage"]).all(), where
        assert (state["energy"] >= 0.0).all(), where
        assert (state["energy"] <= SUITS[case.armor].max_energy).all(), where
        assert ((state["friction"] >= 0.0) & (state["friction"] <= 1.0)).all(), where
        assert (np.abs(state["yaw"]) <= np.pi + 1e-6).all(), where
        bursts = np.bincount(worlds[sim.blasts()["player"]], minlength=WORLDS)[worlds]
        gained = speeds(state) - speeds(before)
        allowed = own + burst * bursts + 1e-4 + 1e-6 * speeds(before)
        assert (gained <= allowed).all(), f"{where}: gained {gained}, allowed {allowed}"
        if case.tier in DIP:
            # The distance to the face, not the height under it: a hair inside a wall is metres below its top.
            at = state["position"][:, :2]
            deep = (ground.height(at) - state["position"][:, 2]) * ground.normal(at)[:, 2]
            # A slice or sweep so many metres long is rounded by so much of them.
            slack = DIP[case.tier] + (1e-15 if case.tier == "reference" else 2e-7) * speeds(before)
            # Who was beyond a rim with nothing behind it may come back below the map.
            off |= np.isnan(deep)
            assert (off | (deep <= slack)).all(), f"{where}: {deep} m below the ground"
        before = state


def test_the_cases_are_not_idle() -> None:
    """Contacts, damage, bursts and bump limits do come about in what the properties are asked of."""
    touched, hurt, limits, bursts = 0, 0, 0, 0
    for seed in range(60):
        case = Case(seed, 5, "tile", "authentic", "mission", 3, "light", False, "disc", 32, None)
        sim = simulator(case)
        begin(sim, case)
        for inputs in keys(case):
            sim.step(inputs)
            bursts += len(sim.blasts())
            touched += int(np.count_nonzero(sim.state()["touched"]))
        hurt += int(np.count_nonzero(sim.state()["damage"]))
        limits += int(np.count_nonzero(sim.state()["bump_limits"]))
    counts = f"{touched} contacts, {hurt} of 720 hurt, {limits} at the bump limit, {bursts} bursts"
    assert touched > 1000, counts
    assert hurt > 200, counts
    assert limits > 2, counts
    assert bursts > 200, counts


def played(sim: discjump.Simulator, case: Case, copies: int = 1) -> None:
    for inputs in keys(case):
        sim.step(np.tile(inputs, copies))


@settings(max_examples=60)
@given(CASES, st.integers(1, 5))
def test_the_same_bits_again_in_any_batch_and_on_any_threads(case: Case, threads: int) -> None:
    sims = [simulator(case), simulator(case)]
    for sim in sims:
        begin(sim, case)
        played(sim, case)
    alone = sims[0].state().tobytes()
    assert sims[1].state().tobytes() == alone
    assert sims[1].digest() == sims[0].digest()
    copies = 1 + 600 // sims[0].num_players
    crowd = simulator(case, WORLDS * copies, threads)
    start = simulator(case)
    begin(start, case)
    crowd.set_state(np.tile(start.state(), copies))
    played(crowd, case, copies)
    assert crowd.state().tobytes() == alone * copies
    for name in ("projectiles", "blasts"):
        one, many = getattr(sims[0], name)(), getattr(crowd, name)()
        assert len(many) == copies * len(one)
        expected = np.tile(one, copies)
        expected["player"] += np.repeat(np.arange(copies), len(one)) * sims[0].num_players
        assert many.tobytes() == expected.tobytes(), name


@settings(max_examples=200)
@given(
    CASES.map(
        lambda case: replace(case, edge="tile", scene="ski" if case.scene == "mission" else case.scene)
    ),
    st.tuples(*[st.integers(-1_000_000, 1_000_000)] * 2),
)
def test_whole_tiles_away_is_the_same_bits(case: Case, tiles: tuple[int, int]) -> None:
    here, there = simulator(case), simulator(case)
    begin(here, case)
    state = here.state()
    offset = np.array(tiles) * SIDE
    state["position"][:, :2] += offset
    there.set_state(state)
    for inputs in keys(case):
        here.step(inputs)
        there.step(inputs)
    near, far = here.state(), there.state()
    for name in (near.dtype.names or ())[1:]:
        assert far[name].tobytes() == near[name].tobytes(), name
    assert far["position"][:, 2].tobytes() == near["position"][:, 2].tobytes()
    np.testing.assert_allclose(far["position"][:, :2] - offset, near["position"][:, :2], rtol=0.0, atol=1e-6)
    for name in ("velocity", "age", "player"):
        assert there.projectiles()[name].tobytes() == here.projectiles()[name].tobytes()


@pytest.mark.parametrize("tier", SIMULATOR_FIDELITIES)
def test_scenes_share_what_they_share(tier: str) -> None:
    """What a scene has more than `ski` changes no bit of the rest while nobody fires and nothing stands."""
    case = Case(7, 3, "tile", tier, "ski", 1, "light", False, "disc", 32, None)
    states: dict[str, Any] = {}
    for scene in SCENES:
        sim = discjump.Simulator(terrain(3, "tile", False), WORLDS, scene, fidelity=tier, threads=1)
        begin(sim, case)
        for inputs in keys(case):
            inputs["fire"] = False
            sim.step(inputs)
        states[scene] = sim.state()
    for scene, state in states.items():
        for name in states["ski"].dtype.names:
            assert state[name].tobytes() == states["ski"][name].tobytes(), f"{scene}, {name}"
