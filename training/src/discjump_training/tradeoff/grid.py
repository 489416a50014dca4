"""Configurations, which of them make sense, and how much work is asked for."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from discjump.accuracy.scripts import TICK_MS as GAME_TICK_MS
from discjump.simulator import FIDELITIES
from discjump.terrains import SURFACES

TICK_MS = (8, 16, 32, 64)
TIERS = FIDELITIES
FRAME_SKIPS = (1, 2, 4, 8)
DECISION_MS = 128
"""Time between two decisions of the task, 4 ticks of 32 ms: what outcomes and transfer keep."""
SHORTEST_DECISION_MS, LONGEST_DECISION_MS = GAME_TICK_MS, 256

LEFT_OUT = (
    "`frame_skip` is no part of a trajectory or an apex: their keys are written down beforehand. It counts "
    "where something decides: agent steps, outcomes and transfer.",
    f"Decisions of less than {SHORTEST_DECISION_MS} ms (8 ms x 1 and 2, 16 ms x 1) are left out: the game "
    f"reads its keys once in {SHORTEST_DECISION_MS} ms.",
    f"Decisions of more than {LONGEST_DECISION_MS} ms (64 ms x 8) are left out: at full rate a player turns "
    "through more than 34 degrees in that time, and the scripts cannot steer.",
    f"8 ms x 16 is added: outcomes of every tick length are played with a decision each {DECISION_MS} ms, or "
    "they would compare decisions instead of physics.",
    "An apex is reached over a plane, where both surfaces are the same.",
)
"""Which combinations are not measured, and why: for the report."""


@dataclass(frozen=True, order=True)
class Config:
    """One configuration of the physics."""

    tier: str
    tick_ms: int = GAME_TICK_MS
    surface: str = "triangles"

    @property
    def name(self) -> str:
        """In tables and pictures; triangles go without saying.

        >>> Config("fast", 16).name, Config("fast", 64, "bilinear").name
        ('fast 16 ms', 'fast 64 ms bilinear')
        """
        return f"{self.tier} {self.tick_ms} ms" + ("" if self.surface == "triangles" else f" {self.surface}")

    @classmethod
    def of(cls, row: dict[str, Any]) -> "Config":
        """That of a row of results."""
        return cls(row["tier"], row["tick_ms"], row["surface"])

    @property
    def keys(self) -> dict[str, Any]:
        """As the beginning of a row."""
        return {"tier": self.tier, "tick_ms": self.tick_ms, "surface": self.surface}

    @property
    def frame_skip(self) -> int:
        """Ticks from one decision of the task to the next.

        >>> [Config("fast", tick_ms).frame_skip for tick_ms in TICK_MS]
        [16, 8, 4, 2]
        """
        return DECISION_MS // self.tick_ms


TRUTH = Config("reference")
"""What errors are measured against."""
DEFAULT = Config("authentic")
"""What the environments are without options."""


@dataclass(frozen=True)
class Plan:
    """What is to be measured, and how much of it."""

    tiers: tuple[str, ...] = TIERS
    tick_ms: tuple[int, ...] = TICK_MS
    surfaces: tuple[str, ...] = SURFACES
    frame_skips: tuple[int, ...] = FRAME_SKIPS
    #: Situations of `errors`; all if empty.
    situations: tuple[str, ...] = ()
    #: Starts in each situation.
    starts: int = 256
    #: How long each is played, s.
    seconds: float = 20.0
    #: Episodes of the held-out course that a skier plays.
    episodes: int = 512
    #: Players of a simulator, and environments of a vector environment, against the clock.
    players: int = 4096
    num_envs: int = 4096
    #: Rounds in which every configuration is timed once.
    repeats: int = 9
    #: Length of one timing of agent steps, s.
    repeat_seconds: float = 0.1
    #: Training seeds in each physics, and decisions of a training.
    seeds: int = 5
    steps: int = 4_000_000
    #: Rounds in which every physics is trained in against the clock, and decisions of such a training.
    training_repeats: int = 3
    training_steps: int = 262_144
    #: Whether it runs, not how fast.
    quick: bool = False

    def configs(self) -> Iterator[Config]:
        """Every tier x tick length x surface."""
        for surface in self.surfaces:
            for tick_ms in self.tick_ms:
                for tier in self.tiers:
                    yield Config(tier, tick_ms, surface)

    def decisions(self, tick_ms: int) -> list[int]:
        """Ticks from one decision to the next that make sense at a tick length.

        >>> {tick_ms: Plan().decisions(tick_ms) for tick_ms in TICK_MS}
        {8: [4, 8, 16], 16: [2, 4, 8], 32: [1, 2, 4, 8], 64: [1, 2, 4]}
        """
        wanted = {skip for skip in self.frame_skips if _sensible(tick_ms * skip)}
        return sorted(wanted | {DECISION_MS // tick_ms})


QUICK = Plan(
    tick_ms=(16, 32, 64),
    frame_skips=(4,),
    situations=("ski", "crease", "blast"),
    starts=8,
    seconds=5.0,
    episodes=16,
    players=256,
    num_envs=64,
    repeats=3,
    repeat_seconds=0.005,
    seeds=2,
    steps=8_192,
    training_repeats=1,
    training_steps=8_192,
    quick=True,
)
"""Everything on a small grid: whether it runs."""


def _sensible(decision_ms: int) -> bool:
    return SHORTEST_DECISION_MS <= decision_ms <= LONGEST_DECISION_MS
