"""The Rust statistics against numpy and SciPy, on generated terrain and on heights that are anything but."""

import numpy as np
import pytest

import discjump

from . import reference_statistics as reference

# Sums are added in another order, and arc functions differ in the last bits.
TOLERANCE = 1e-9


def noise(seed: int) -> reference.Array:
    """Rough unquantised ground without ties, unlike anything that the generator makes."""
    rng = np.random.default_rng(seed)
    rough = rng.normal(0.0, 1.0, (256, 256))
    smooth = np.fft.ifft2(np.fft.fft2(rng.normal(0.0, 300.0, (256, 256))) * low_pass(12.0)).real
    return np.asarray(rough + smooth + 100.0)


def low_pass(cut: float) -> reference.Array:
    mode = np.fft.fftfreq(256, 1 / 256)
    return np.asarray(np.exp(-(np.hypot(*np.meshgrid(mode, mode)) ** 2) / (2 * cut**2)))


def assert_equal(found: dict[str, float], expected: dict[str, float]) -> None:
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=TOLERANCE, abs=TOLERANCE), name


@pytest.mark.parametrize("repeating", [False, True])
@pytest.mark.parametrize("seed", [0, 7, 123_456_789])
def test_generated_terrain(seed: int, repeating: bool) -> None:
    terrain = discjump.Terrain.raindance(seed, repeating=repeating)
    heights = np.asarray(terrain.heights)
    found = terrain.statistics()
    assert_equal(found, reference.terrain_statistics(heights))
    mission = terrain.mission
    assert mission is not None
    expected = reference.mission_statistics(
        heights, mission["flags"], mission["bridge_centre"], mission["bridge_ends"]
    )
    assert_equal(found, expected)
    if repeating:
        assert reference.repetition(heights) >= 0.95


@pytest.mark.parametrize("seed", range(3))
def test_any_heights(seed: int) -> None:
    heights = noise(seed)
    closed = np.pad(heights, (0, 1), mode="wrap")
    found = discjump.Terrain.from_heights(closed, square_size=8.0).statistics()
    assert_equal(found, reference.terrain_statistics(heights))


def test_seamless_and_not_negative() -> None:
    heights = np.asarray(discjump.Terrain.raindance(3).heights)
    assert heights.shape == (257, 257)
    assert heights.min() >= 0.0
    assert np.array_equal(heights[0], heights[-1])
    assert np.array_equal(heights[:, 0], heights[:, -1])
    assert np.array_equal(heights * 64, np.round(heights * 64))
