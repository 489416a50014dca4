"""Gymnasium ids as subjects: every id of ours that is registered, through its own vector environment."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump.simulator import FIDELITIES
from discjump.verify import draws, ways
from discjump.verify.interface import DISABLED, NEXT_STEP, SAME_STEP, Batch
from discjump.verify.parts import Column, Part, info_columns, take

NAMESPACE = "discjump"
SHOWN = ("state", "goals", "terrain_index")
"""What our vector environments show beside observations; a column each where there is such a name."""
WIDTHS = (1, 8, 16, 32)
IN_LANES = ("authentic", "swept", "fast")
"""Tiers that have lanes."""

SHORTENED: Mapping[str, Mapping[str, Any]] = {
    "discjump/DiscJump-v0": {"time_limit": 2.5, "marker_height": (10.0, 14.0)},
    "discjump/Route-v0": {"time_limit": 4.0, "start_distance": (10.0, 80.0), "arrival_radius": 6.0},
    "discjump/FlagRun-v0": {
        "time_limit": 7.0,
        "start_distance": (15.0, 60.0),
        "start_speed": 60.0,
        "flags": ((400.0, 300.0), (424.0, 303.0)),
        "arrival_radius": 12.0,
    },
}
"""Options of ids whose own episodes are long: with these all ways to end turn up within few decisions; on the
terrains of `POOL`."""
POOL = {"terrain_seeds": (0, 1)}

Make = Callable[..., Any]


def ids() -> list[str]:
    """The registered ids.

    >>> ids()
    ['discjump/DiscJump-v0', 'discjump/FlagRun-v0', 'discjump/Route-v0', 'discjump/Ski-v0'...]
    """
    return sorted(
        spec.id
        for spec in gymnasium.registry.values()
        if spec.namespace == NAMESPACE and spec.vector_entry_point is not None
    )


@dataclass(frozen=True)
class Environment:
    """A registered id in one fidelity tier."""

    id: str
    tier: str
    make: Make = gymnasium.make_vec
    """Takes the id and what `gymnasium.make_vec` takes."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Further arguments of the environment."""

    modes = (DISABLED, NEXT_STEP, SAME_STEP)
    steps = None
    digested = 12

    @property
    def name(self) -> str:
        """The id."""
        return self.id

    def batch(self, num: int, *, threads: int, lanes: int, mode: str) -> Batch:
        """So many environments."""
        return VectorBatch(
            self.make(
                self.id,
                num_envs=num,
                threads=threads,
                lanes=lanes,
                autoreset_mode=mode,
                fidelity=self.tier,
                **self.options,
            ),
            mode,
        )

    def widths(self) -> list[int]:
        """Lane widths of this processor, where the tier has lanes."""
        return [width for width in WIDTHS if self._has(width)] if self.tier in IN_LANES else [1]

    def _has(self, width: int) -> bool:
        try:
            self.batch(1, threads=1, lanes=width, mode=NEXT_STEP)
        except ValueError:
            return False
        return True

    def ways(self) -> Sequence[str]:
        """The other ways in."""
        return tuple(ways.WAYS)

    def way(self, name: str, num: int) -> Batch:
        """A batch by another way in."""
        return ways.WAYS[name](self.id, num, {"fidelity": self.tier, **self.options})

    def action(self, seed: int, decision: int, columns: Mapping[str, Column]) -> Any:
        """What the environment with this seed is told."""
        if not columns:
            return draws.drawn(self._one.single_action_space, seed, decision)
        return self._driver(seed, decision, columns["observation"][0])

    def describe(self, leaf: str) -> str:
        """The field of an observation's number."""
        if leaf.startswith("observation["):
            number = int(leaf[len("observation[") : -1])
            for known in self._layout:
                if known.slice.start <= number < known.slice.stop:
                    return str(known.name)
        return ""

    @cached_property
    def _one(self) -> Any:
        return self.make(self.id, num_envs=1, fidelity=self.tier, **self.options)

    @cached_property
    def _layout(self) -> Sequence[Any]:
        return getattr(self._one, "observation_layout", ())

    @cached_property
    def _driver(self) -> draws.Driver:
        return draws.driver(self._one.single_action_space, self._layout)

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in ("id", "tier", "make", "options")}


class VectorBatch:
    """A gymnasium vector environment, seen as rows, which are the same in every autoreset mode."""

    def __init__(self, envs: Any, mode: str, hidden: frozenset[str] = frozenset()) -> None:
        self.envs, self.mode, self.hidden = envs, mode, hidden
        self.everyone = np.arange(envs.num_envs)

    def reset(self, seeds: Sequence[int | None] | None, mask: NDArray[np.bool_] | None = None) -> list[Part]:
        """Begin episodes."""
        options = {} if mask is None else {"options": {"reset_mask": mask}}
        observations, info = self.envs.reset(seed=None if seeds is None else list(seeds), **options)
        return [self._begun(None if mask is None else np.flatnonzero(mask), observations, info)]

    def step(self, actions: Column) -> list[Part]:
        """One decision, and the resets that an autoreset mode leaves to the caller."""
        observations, rewards, terminated, truncated, info = self.envs.step(actions)
        columns = {
            "observation": observations,
            "reward": rewards,
            "terminated": terminated,
            "truncated": truncated,
            **info_columns(info),
        }
        ended = np.flatnonzero(terminated | truncated)
        if self.mode == NEXT_STEP or not len(ended):
            return [Part(self.everyone, columns | self._shown(), self.hidden)]
        if self.mode == DISABLED:
            part = Part(self.everyone, columns | self._shown())
            mask = terminated | truncated
            observations, info = self.envs.reset(options={"reset_mask": mask})
            return [part, self._begun(ended, observations, info)]
        return self._same_step(columns, info, ended)

    def _same_step(
        self, columns: dict[str, Column], info: Mapping[str, Any], ended: NDArray[np.int64]
    ) -> list[Part]:
        """What was last is in `info`, for the step shows the next episode's first observation."""
        going = np.setdiff1d(self.everyone, ended)
        last = {name: columns[name] for name in ("reward", "terminated", "truncated")}
        last |= info_columns(info["final_info"])
        last = take(last, ended)
        last["observation"] = np.stack([info["final_obs"][index] for index in ended])
        shown = self._shown()
        return [
            Part(going, take(columns | shown, going)),
            Part(ended, last, frozenset(shown)),
            self._begun(ended, columns["observation"], info),
        ]

    def _begun(
        self, indices: NDArray[np.int64] | None, observations: Column, info: Mapping[str, Any]
    ) -> Part:
        num = len(self.everyone)
        columns = {
            "observation": observations,
            "reward": np.zeros(num),
            "terminated": np.zeros(num, np.bool_),
            "truncated": np.zeros(num, np.bool_),
            **info_columns(info),
            **self._shown(),
        }
        if indices is None:
            return Part(self.everyone, columns, self.hidden)
        return Part(indices, take(columns, indices), self.hidden)

    def _shown(self) -> dict[str, Column]:
        shown = {}
        for name in SHOWN:
            found = getattr(self.envs, name, None)
            if found is not None:
                shown[name] = np.asarray(found() if callable(found) else found)
        return shown

    def snapshot(self) -> bytes:
        """Everything, for `restore`."""
        found: bytes = self.envs.snapshot()
        return found

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot."""
        self.envs.restore(snapshot)

    def moved(self, index: int) -> bytes:
        """One environment, for `settle`."""
        found: bytes = self.envs.snapshot(index=index)
        return found

    def settle(self, snapshot: bytes, index: int) -> None:
        """Put one environment to where another was."""
        self.envs.restore(snapshot, index=index)


def subjects(chosen: Sequence[str], tiers: Sequence[str] = FIDELITIES) -> list[Environment]:
    """These ids in these tiers."""
    return [
        Environment(name, tier, options={**POOL, **SHORTENED[name]} if name in SHORTENED else {})
        for name in chosen
        for tier in tiers
    ]
