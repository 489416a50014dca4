"""One test for each defect that was found and mended; each opens with what it caught."""

import subprocess
import sys

import numpy as np
import pytest

from discjump import Simulator, Terrain


def flat(squares: int = 8, size: float = 8.0) -> Terrain:
    """Level ground."""
    return Terrain.from_heights(np.zeros((squares + 1, squares + 1)), square_size=size, edge="clamp")


def test_terrains_are_pickled_after_a_plain_import() -> None:
    """`import discjump` alone knew no rule for pickling a terrain: workers got "cannot pickle"."""
    code = (
        "import pickle, discjump, numpy as np\n"
        "terrain = discjump.Terrain.from_heights(np.zeros((3, 3)))\n"
        "assert pickle.loads(pickle.dumps(terrain)).digest() == terrain.digest()\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_positions_of_a_state_are_points_wherever_they_lie() -> None:
    """A single row of a packed state counts as contiguous at any address, and was refused as misaligned."""
    terrain = flat()
    sim = Simulator(terrain, 4, threads=1)
    for k in range(4):
        position = sim.state()[k : k + 1]["position"]
        assert terrain.height(position[:, :2]).tolist() == [0.0]


@pytest.mark.parametrize("name", ["num_players", "players_per_world", "tick_ms", "threads"])
def test_huge_numbers_are_refused_by_name(name: str) -> None:
    """Numbers beyond 64 bits ended as "int too big to convert"."""
    for value in (2**32, 2**64, 10**30):
        with pytest.raises(ValueError, match=f"{name}: expected"):
            Simulator(flat(), **{name: value})  # type: ignore[arg-type]


def test_switches_and_seeds_are_checked_by_name() -> None:
    """`physics=0` was taken as none, `physics="x"` ended in an AttributeError, and any seed was taken."""
    for wrong in (0, "x", {"ski_bug": True}):
        with pytest.raises(TypeError, match=r"physics: expected a discjump\.Physics"):
            Simulator(flat(), physics=wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="seed: expected"):
        Simulator(flat(), seed="x")  # type: ignore[arg-type]


def test_ragged_points_are_refused_by_name() -> None:
    """numpy's own message came through, which does not know the argument."""
    with pytest.raises(ValueError, match="points: expected"):
        Simulator(flat(), 2, threads=1).explode([[0.0, 0.0], [1.0]])
