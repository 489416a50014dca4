"""Tiers, grounds, starts, and runs of a simulator."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.simulator import Simulator

Floats = NDArray[np.float64]
State = NDArray[np.void]

TICK_MS = 32
"""The game's."""


@dataclass(frozen=True)
class Tier:
    """A fidelity in one of its arithmetics."""

    fidelity: str
    #: None: the tier's own.
    precision: str | None = None

    @property
    def name(self) -> str:
        """What tables call it."""
        return f"{self.fidelity} f64" if self.precision == "float64" else self.fidelity

    @property
    def double(self) -> bool:
        """Whether it computes in float64."""
        return self.fidelity == "reference" or self.precision == "float64"

    @property
    def model(self) -> str:
        """`article` or `engine`."""
        return "engine" if self.fidelity == "engine" else "article"


TIERS = (
    Tier("reference"),
    Tier("authentic"),
    Tier("swept"),
    Tier("fast"),
    Tier("engine", "float64"),
    Tier("engine"),
)
"""All but `anyway`, which is `authentic` with other contacts and not to be played; both of `engine`, whose
movement has no other float64."""


def twin(tier: Tier) -> Tier | None:
    """The same movement in float64; None for one that is.

    >>> twin(Tier("authentic")), twin(Tier("fast")).name, twin(Tier("reference"))
    (Tier(fidelity='reference', precision=None), 'fast f64', None)
    """
    if tier.double:
        return None
    return Tier("reference") if tier.fidelity == "authentic" else Tier(tier.fidelity, "float64")


def level(height: float = 0.0) -> Terrain:
    """Level ground, 8 km square."""
    return Terrain.from_heights(np.full((3, 3), height), 4096.0, (-4096.0, -4096.0), "clamp")


def incline(degrees: float) -> Terrain:
    """A plane through the origin in squares of 8 m that falls towards +y: 4 km long, 32 m wide."""
    y = 8.0 * np.arange(513) - 2048.0
    heights = np.repeat(-np.tan(np.radians(degrees)) * y[:, None], 5, axis=1)
    return Terrain.from_heights(heights, 8.0, (-16.0, -2048.0), "clamp")


def start(sim: Simulator, fields: Mapping[str, Any]) -> None:
    """Overwrite fields of all players."""
    state = sim.state()
    for name, value in fields.items():
        state[name] = value
    sim.set_state(state)


def play(
    tier: Tier,
    terrain: Terrain,
    fields: Mapping[str, Any],
    keys: Mapping[str, Any],
    ticks: int,
    *,
    tick_ms: int = TICK_MS,
    **more: Any,
) -> Iterator[State]:
    """States of all players: at the start, and after each tick with the same keys held.

    Args:
        fields: of the state; `position` of shape (n, 3) is one of them.
        keys: of the input.
        more: arguments of the simulator.
    """
    sim = make(tier, terrain, len(fields["position"]), tick_ms=tick_ms, **more)
    start(sim, fields)
    inputs = sim.inputs()
    for name, value in keys.items():
        inputs[name] = value
    yield sim.state()
    for _ in range(ticks):
        sim.step(inputs)
        yield sim.state()


def after(
    tier: Tier,
    terrain: Terrain,
    fields: Mapping[str, Any],
    keys: Mapping[str, Any],
    ticks: int,
    *,
    tick_ms: int = TICK_MS,
    **more: Any,
) -> State:
    """As `play`, the last state alone."""
    sim = make(tier, terrain, len(fields["position"]), tick_ms=tick_ms, **more)
    start(sim, fields)
    inputs = sim.inputs()
    for name, value in keys.items():
        inputs[name] = value
    sim.step(inputs, ticks=ticks)
    return sim.state()


def make(tier: Tier, terrain: Terrain, num_players: int, **more: Any) -> Simulator:
    """A simulator of a tier, on one thread."""
    return Simulator(
        terrain, num_players, fidelity=tier.fidelity, precision=tier.precision, threads=1, **more
    )


def exact32(values: Any) -> Floats:
    """Rounded to float32 numbers: then every tier starts alike."""
    rounded: Floats = np.asarray(values, np.float32).astype(np.float64)
    return rounded
