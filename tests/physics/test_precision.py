"""Tiers in float64: against the plain Python model of the same name, and `authentic` against `reference`."""

import numpy as np
import pytest

import discjump
from discjump.simulator import FIDELITIES, SIMULATOR_FIDELITIES

from .pair import Pair
from .scripts import TEN_SECONDS, above, creased, random_keys, rolling

TERRAIN = rolling(33, 26)


def started(terrain: discjump.Terrain, fidelity: str, many: int, seed: int, spread: float) -> Pair:
    rng = np.random.default_rng(seed)
    return Pair(
        terrain,
        many,
        fidelity=fidelity,
        ski_bug=fidelity == "engine",
        position=above(terrain, rng.uniform(-spread, spread, (many, 2)), rng.uniform(0.0, 5.0, many)),
        velocity=rng.normal(0.0, 20.0, (many, 3)),
        yaw=rng.uniform(-np.pi, np.pi, many),
    )


@pytest.mark.parametrize("fidelity", ["swept", "anyway", "engine"])
def test_whole_runs(fidelity: str) -> None:
    """All fields in every tick of ten seconds, to 1e-6 m and 1e-6 m/s."""
    pair = started(TERRAIN, fidelity, 16, 2, 900.0)
    keys = random_keys(np.random.default_rng(3), 16)
    for _ in range(TEN_SECONDS):
        pair.step(next(keys))
    assert pair.contacts.sum() > 100


def test_creases() -> None:
    """Where `swept` shares out a tick in another way than `reference`."""
    pair = started(creased("ridges", 50), "swept", 9, 4, 30.0)
    keys = random_keys(np.random.default_rng(5), 9)
    for _ in range(TEN_SECONDS // 2):
        pair.step(next(keys))
    assert pair.most_contacts > 1


def played(
    scene: str, fidelity: str, precision: str | None, per_world: int = 1, ticks: int = 600
) -> discjump.Simulator:
    """Over a generated map's hills, its bridge and bases, with all keys at random, and everybody's discs."""
    many = 24
    terrain = discjump.Terrain.raindance(7)
    sim = discjump.Simulator(
        terrain, many, scene, fidelity=fidelity, precision=precision, players_per_world=per_world
    )
    rng, state = np.random.default_rng(6), sim.state()
    # float32 numbers, so that both precisions begin at the very same place.
    ends = np.array(terrain.mission["bridge_ends"][:, :2]) if terrain.mission else np.zeros((2, 2))
    spread = rng.uniform(-60.0, 60.0, (many, 2))
    state["position"] = above(terrain, ends[np.arange(many) % 2] + spread, 1.0)
    state["position"] = state["position"].astype(np.float32)
    state["velocity"] = rng.normal(0.0, 15.0, (many, 3)).astype(np.float32)
    sim.set_state(state)
    keys = random_keys(rng, many)
    for _ in range(ticks):
        inputs = next(keys)
        inputs["fire"], inputs["pitch"] = True, np.float32(-0.3)
        sim.step(inputs)
    return sim


@pytest.mark.parametrize("scene", list(discjump.SCENES))
def test_authentic_in_float64_is_reference_bit_for_bit(scene: str) -> None:
    double, truth = played(scene, "authentic", "float64"), played(scene, "reference", None)
    assert double.state_dtype == truth.state_dtype
    assert double.state().tobytes() == truth.state().tobytes()
    assert double.digest() == truth.digest()
    assert double.digest() != played(scene, "authentic", None).digest()


def test_also_with_others_in_the_world() -> None:
    double = played("mission", "authentic", "float64", 4, 200)
    assert double.digest() == played("mission", "reference", None, 4, 200).digest()


@pytest.mark.parametrize("fidelity", SIMULATOR_FIDELITIES)
def test_a_tier_has_its_own_precision_by_default(fidelity: str) -> None:
    own = "float64" if fidelity == "reference" else "float32"
    default, named = (played("disc_jump", fidelity, precision, ticks=100) for precision in (None, own))
    assert default.precision == named.precision == own
    assert default.snapshot() == named.snapshot()


@pytest.mark.parametrize("fidelity", FIDELITIES[1:])
def test_the_digits_are_what_differs(fidelity: str) -> None:
    """Five ticks of one movement in both precisions end some float32 roundings apart; ties come later."""
    single, double = (
        played("disc_jump", fidelity, precision, ticks=5) for precision in ("float32", "float64")
    )
    assert double.precision == "float64"
    assert double.state_dtype["velocity"].base == np.dtype("<f8")
    assert single.state_dtype["velocity"].base == np.dtype("<f4")
    assert double.lanes == 1
    apart = np.linalg.norm(single.state()["position"] - double.state()["position"], axis=1)
    assert 0.0 < np.median(apart) < 1e-3


def test_a_snapshot_is_of_one_precision() -> None:
    terrain = discjump.Terrain.from_heights(np.zeros((3, 3)))

    def made(fidelity: str, precision: str | None) -> discjump.Simulator:
        return discjump.Simulator(terrain, 2, fidelity=fidelity, precision=precision, threads=1)

    single, double = made("swept", None), made("swept", "float64")
    for there, here in ((single, double), (double, single), (double, made("reference", None))):
        before = here.snapshot()
        with pytest.raises(ValueError, match=r"snapshot.*another layout"):
            here.restore(there.snapshot())
        assert here.snapshot() == before
    double.step(double.inputs(), 5)
    other = made("swept", "float64")
    other.restore(double.snapshot())
    assert other.digest() == double.digest()


def test_bad_precisions() -> None:
    terrain = discjump.Terrain.from_heights(np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r'reference.*authentic.*float64.*got "float32"'):
        discjump.Simulator(terrain, fidelity="reference", precision="float32")
    with pytest.raises(ValueError, match=r"precision.*'float32'.*'float64'.*'double'"):
        discjump.Simulator(terrain, precision="double")
    with pytest.raises(TypeError, match="precision"):
        discjump.Simulator(terrain, precision=64)  # type: ignore[arg-type]
