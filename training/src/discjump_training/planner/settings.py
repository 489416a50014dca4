"""What a planner is told, typed and checked."""

from dataclasses import dataclass, fields
from typing import Any

from discjump_training.errors import TrainingError

PROPOSALS = ("evolve", "cem", "mppi")
OBJECTIVES = ("task", "rewards")


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How hard, how far and in which way to plan.

    Raises:
        TrainingError: a field out of its range; the message names it, what was expected and what came.

    >>> Settings(candidates=1)
    Traceback (most recent call last):
    discjump_training.errors.TrainingError: candidates: expected an integer from 2 to 65536, got 1
    """

    candidates: int = 256
    """action sequences tried at once for each episode"""
    horizon: float = 4.0
    """how far a sequence reaches, s; rounded to whole decisions"""
    iterations: int = 4
    """times that new sequences are drawn from what the last ones taught, for each plan"""
    warm_up: int = 4
    """times as many iterations for an episode's first plan, which has nothing to begin with"""
    commit: int = 1
    """decisions played of a plan before the next plan is made"""
    proposal: str = "evolve"
    """how sequences are drawn: `evolve` (windows of the best ones changed), `cem` (from the categorical
    distribution of the best ones), `mppi` (the same, all weighted by the exponential of their score)"""
    elites: int = 16
    """best sequences that are kept from one iteration and one decision to the next"""
    hold: float = 0.5
    """time for which a drawn key or turn is held on average, s (`cem`, `mppi`)"""
    explore: float = 0.1
    """share of the uniform distribution in each categorical one (`cem`, `mppi`)"""
    temperature: float = 0.1
    """difference in score that weighs 1/e (`mppi`), in units of the objective"""
    guided: float = 0.25
    """share of the sequences that a model or script completes while they are simulated; 0 without one"""
    objective: str = "task"
    """what is wanted where no value network judges: `task` (its own objective), `rewards` (their sum)"""
    seed: int = 0
    """of all draws"""

    def __post_init__(self) -> None:
        """Check every field."""
        for name, low, high in (
            ("candidates", 2, 65_536),
            ("iterations", 1, 1_000),
            ("warm_up", 1, 100),
            ("commit", 1, 10_000),
            ("elites", 1, 1_024),
            ("seed", 0, 2**32 - 1),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
                raise TrainingError(f"{name}: expected an integer from {low} to {high}, got {value!r}")
        for name, least, most, unit in (
            ("horizon", 0.0, 120.0, " s"),
            ("hold", 0.0, 60.0, " s"),
            ("explore", 0.0, 1.0, ""),
            ("temperature", 0.0, 1e9, ""),
            ("guided", 0.0, 1.0, ""),
        ):
            value = getattr(self, name)
            number = isinstance(value, (int, float)) and not isinstance(value, bool)
            # A share may be nothing, a duration or a temperature may not.
            if (
                not number
                or not (least <= value if name in ("guided", "explore") else least < value)
                or value > most
            ):
                bracket = "[" if name in ("guided", "explore") else "("
                raise TrainingError(
                    f"{name}: expected a number in {bracket}{least:g}, {most:g}]{unit}, got {value!r}"
                )
        for name, known in (("proposal", PROPOSALS), ("objective", OBJECTIVES)):
            if (value := getattr(self, name)) not in known:
                raise TrainingError(f"{name}: expected one of {', '.join(known)}, got {value!r}")
        if self.elites >= self.candidates:
            raise TrainingError(
                f"elites: expected fewer than the {self.candidates} candidates, got {self.elites}"
            )

    def decisions(self, decision_seconds: float) -> int:
        """Length of a sequence, decisions.

        Raises:
            TrainingError: if the horizon is shorter than what is played of each plan.
        """
        count = max(1, round(self.horizon / decision_seconds))
        if count < self.commit:
            raise TrainingError(
                f"commit: expected at most {count} decisions, the horizon of {self.horizon:g} s, "
                f"got {self.commit}"
            )
        return count

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {field.name: getattr(self, field.name) for field in fields(self)}
