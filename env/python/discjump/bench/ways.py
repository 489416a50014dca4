"""The ways in, as cases: the simulator alone, the ski task from Rust, gymnasium, stable-baselines3.

Random keys and actions, drawn beforehand: drawing them is no part of a step. `lanes` is the number of players
side by side; None leaves the choice to the package.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump._native import TaskBatch, Terrain, time_environments, time_players, time_resets
from discjump.bench.clock import Ready, Unavailable, loop
from discjump.envs.callables import Transition
from discjump.envs.observations import Observations
from discjump.envs.options import SkiOptions
from discjump.simulator import Simulator
from discjump.solids import Solid
from discjump.terrains import generated

ENV_ID = "discjump/Ski-v0"
SETS = 8
"""Sets of keys or actions, taken in turn: few, so that they stay in cache as fresh ones would."""
SEED = 7
"""Of the terrain."""
FIELD = 400.0
"""Side of the square that many solids stand in, m."""
FAR, NEAR = ((-600.0, -600.0), 400.0), ((200.0, 200.0), 400.0)
"""South-west corner and side of squares far from those solids and among them, m."""
WHOLE = ((-900.0, -900.0), 1800.0)


@contextmanager
def offered(lanes: int | None) -> Iterator[None]:
    """What is made inside may ask for lanes that this processor lacks.

    Raises:
        Unavailable: it did.
    """
    try:
        yield
    except ValueError as error:
        if lanes is not None and str(error).startswith("lanes"):
            raise Unavailable(f"this processor has no {lanes} lanes") from error
        raise


@dataclass(frozen=True)
class Players:
    """Players without a task who run, ski and jet at random, the trigger held: the same game each time."""

    count: int
    threads: int = 2
    lanes: int | None = None
    scene: str = "ski"
    fidelity: str = "authentic"
    precision: str | None = None
    tick_ms: int = 32
    surface: str = "triangles"
    armor: str = "light"
    ticks: int = 4
    square: tuple[tuple[float, float], float] = WHOLE
    solids: int | None = 0
    """Towers in a lattice; None: the terrain's own solids."""
    lift: float = 0.0
    """Height of the lowest over the ground, m."""
    calls: int = 64

    @property
    def units(self) -> int:
        """Player-ticks."""
        return self.count * self.ticks

    def make(self) -> Ready:
        """The simulator and its start."""
        terrain = generated(SEED, surface=self.surface)
        if self.solids is not None:
            terrain = terrain.with_solids(towers(terrain, self.solids))
        with offered(self.lanes):
            sim = Simulator(
                terrain,
                self.count,
                scene=self.scene,
                fidelity=self.fidelity,
                precision=self.precision,
                tick_ms=self.tick_ms,
                armor=self.armor,
                threads=self.threads,
                lanes=self.lanes,
            )
        rng = np.random.default_rng(0)
        start, (corner, side) = sim.state(), self.square
        xy = np.asarray(corner) + rng.uniform(0.0, side, (self.count, 2))
        start["position"][:, :2] = xy
        start["position"][:, 2] = terrain.height(xy) + self.lift + rng.uniform(0.0, 20.0, self.count)
        start["velocity"][:, :2] = rng.uniform(-30.0, 30.0, (self.count, 2))
        sim.set_state(start)
        fresh, keys, native = sim.snapshot(), self._keys(sim, rng), sim._native

        def timed(calls: int) -> float:
            sim.restore(fresh)
            return time_players(native, keys, self.ticks, calls)

        return Ready(timed, lanes=sim.lanes)

    def _keys(self, sim: Simulator, rng: np.random.Generator) -> bytes:
        sets = []
        for _ in range(SETS):
            inputs = sim.inputs()
            for key, low, high in (("forward", -1, 2), ("strafe", -1, 2), ("turn", -3, 4)):
                inputs[key] = rng.integers(low, high, self.count)
            inputs["jump"] = rng.random(self.count) < 0.75
            inputs["jet"] = rng.random(self.count) < 0.5
            inputs["fire"], inputs["pitch"] = True, -0.3
            sets.append(inputs.tobytes())
        return b"".join(sets)


@dataclass(frozen=True)
class Agents:
    """The ski task stepped from Rust: no Python in the loop."""

    num_envs: int
    frame_skip: int = 1
    threads: int = 2
    lanes: int | None = None
    terrains: int = 16
    time_limit: float = 60.0
    autoreset: str = "next_step"
    calls: ClassVar[int | None] = None

    @property
    def units(self) -> int:
        """Agent steps."""
        return self.num_envs

    def batch(self) -> TaskBatch:
        """The environments, reset."""
        options = SkiOptions(
            frame_skip=self.frame_skip,
            terrain_seeds=range(self.terrains),
            time_limit=self.time_limit,
        )
        with offered(self.lanes):
            batch = options.batch(self.num_envs, self.autoreset, self.threads, self.lanes)
        batch.reset(np.arange(self.num_envs, dtype=np.uint64))
        return batch

    def make(self) -> Ready:
        """The environments and actions of one byte."""
        batch, actions = self.batch(), random_actions(self.num_envs, np.int8)

        def timed(calls: int) -> float:
            return time_environments(batch, actions, calls)[0]

        return Ready(timed, batch.observation_size, batch.lanes)


@dataclass(frozen=True)
class Vector:
    """`gymnasium.make_vec(...).step`."""

    num_envs: int
    frame_skip: int = 1
    threads: int = 2
    dtype: str = "int64"
    fidelity: str = "authentic"
    tick_ms: int = 32
    surface: str = "triangles"
    replaced: bool = False
    """Observation and reward go through Python."""
    calls: ClassVar[int | None] = None

    @property
    def units(self) -> int:
        """Agent steps."""
        return self.num_envs

    def make(self) -> Ready:
        """The environments, reset."""
        functions: dict[str, Any] = {"observation_fn": identity, "reward_fn": shaped} if self.replaced else {}
        envs = gymnasium.make_vec(
            ENV_ID,
            num_envs=self.num_envs,
            frame_skip=self.frame_skip,
            threads=self.threads,
            fidelity=self.fidelity,
            tick_ms=self.tick_ms,
            surface=self.surface,
            **functions,
        )
        observations, _ = envs.reset(seed=0)
        actions = random_actions(self.num_envs, np.dtype(self.dtype))
        return Ready(loop(envs.step, list(actions)), observations.shape[1])


@dataclass(frozen=True)
class Sb3:
    """The `VecEnv` of stable-baselines3."""

    num_envs: int
    frame_skip: int = 1
    threads: int = 2
    calls: ClassVar[int | None] = None

    @property
    def units(self) -> int:
        """Agent steps."""
        return self.num_envs

    def make(self) -> Ready:
        """The environments, reset."""
        try:
            from discjump.sb3 import make_vec_env
        except ImportError as error:
            raise Unavailable("not installed: pip install 'discjump[sb3]'") from error
        envs = make_vec_env(
            ENV_ID, n_envs=self.num_envs, seed=0, frame_skip=self.frame_skip, threads=self.threads
        )
        observations = envs.reset()
        actions = random_actions(self.num_envs, np.int64)
        return Ready(loop(envs.step, list(actions)), observations.shape[1])


@dataclass(frozen=True)
class Single:
    """`gymnasium.make(...).step`, with the wrappers that come by default; resets are counted in."""

    frame_skip: int = 1
    units: ClassVar[int] = 1
    calls: ClassVar[int | None] = None

    def make(self) -> Ready:
        """The environment, reset."""
        env = gymnasium.make(ENV_ID, frame_skip=self.frame_skip)
        observation, _ = env.reset(seed=0)

        def step(action: NDArray[Any]) -> None:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

        return Ready(loop(step, list(random_actions(1, np.int64)[:, 0])), observation.shape[0])


@dataclass(frozen=True)
class Resets:
    """Resets of one environment of a batch, the environments in turn."""

    num_envs: int
    gymnasium: bool = False
    """Through `VectorEnv.reset` with a mask; else from Rust."""
    units: ClassVar[int] = 1
    calls: ClassVar[int | None] = None

    def make(self) -> Ready:
        """The environments, reset."""
        if not self.gymnasium:
            batch = Agents(self.num_envs).batch()
            return Ready(lambda calls: time_resets(batch, calls))
        envs = gymnasium.make_vec(ENV_ID, num_envs=self.num_envs)
        envs.reset(seed=0)
        chosen = np.linspace(0, self.num_envs - 1, 64).astype(np.int64)
        masks = np.arange(self.num_envs) == chosen[:, np.newaxis]
        return Ready(loop(lambda mask: envs.reset(options={"reset_mask": mask}), list(masks)))


def identity(observations: Observations) -> NDArray[np.float32]:
    """The task's own observations."""
    return observations.array


def shaped(transition: Transition) -> NDArray[np.float64]:
    """The task's own rewards and a potential of the speed."""
    return transition.rewards + 0.01 * (transition.after["speed"] - transition.before["speed"])


def random_actions(num_envs: int, dtype: Any) -> NDArray[Any]:
    """(SETS, num_envs, 5) actions.

    >>> random_actions(3, np.int8).shape, random_actions(3, np.int8).max(axis=(0, 1)).tolist()
    ((8, 3, 5), [2, 2, 1, 1, 6])
    """
    return np.random.default_rng(0).integers(0, [3, 3, 2, 2, 7], (SETS, num_envs, 5)).astype(dtype)


def towers(terrain: Terrain, count: int) -> list[Solid]:
    """So many towers of 4 x 4 x 12 m in a lattice, on the ground."""
    side = max(1, int(np.ceil(np.sqrt(count))))
    k = np.arange(count)
    xy = 200.0 + FIELD * np.stack([k % side, k // side], 1) / side
    heights = terrain.height(xy).tolist()
    return [Solid.box((4, 4, 12), (x, y, z + 4)) for (x, y), z in zip(xy.tolist(), heights, strict=True)]
