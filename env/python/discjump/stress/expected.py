"""Failures that are expected, with reason and limit: extremes that the specification cannot stand."""

from dataclasses import dataclass
from fnmatch import fnmatchcase

from discjump.stress.cases import Column
from discjump.stress.checks import Finding

REASONS = {
    "anyway": (
        "`anyway` makes a slice that hits all the same, untested: in creases it goes through the other face, "
        "and whoever is under the ground falls (core/docs/physics.md, 5.2). The tier exists to show it."
    ),
    "dips": (
        "The fix-up of `swept` is not swept: it ends below the other face of a crease, by less than two "
        "slices of a metre, until a contact at once pushes the player out (core/docs/tiers.md). "
        "`fixup_swept` sweeps it."
    ),
    "centre": (
        "`engine` asks the plane under the sphere's centre alone, every 0.3 m. A face steeper than 75 "
        "degrees rises by more than the sphere's radius in such a step, and a centre below it meets nothing: "
        "one falls out of the world."
    ),
    "trapezoid": (
        "`engine` moves along the mean of the speeds before and after the tick's forces, but asks the second "
        "whether it leads into the face. In long ticks the two part so far that a step goes through it."
    ),
    "tips": (
        "`fast` looks at the ground once a tick, where the move ends: a move over several edges may miss the "
        "tip of what it crosses. It ends above the ground all the same."
    ),
}
"""Why, in a sentence or two."""


@dataclass(frozen=True)
class Expectation:
    """A failure of a tier's check in some extremes (patterns of `extreme/case`)."""

    tier: str
    check: str
    extremes: tuple[str, ...]
    reason: str
    #: The worst that is expected, in the check's unit.
    limit: float = float("inf")
    #: Extremes of the suite's own grounds in which every precision and surface must fail so, or it is told.
    certain: tuple[str, ...] = ()

    def covers(self, column: Column, label: str) -> bool:
        """Whether a case of a column is meant."""
        return column.tier == self.tier and any(fnmatchcase(label, pattern) for pattern in self.extremes)


EXPECTATIONS = (
    Expectation(
        "anyway", "ground", ("*",), "anyway", certain=("crease 60", "crease 75", "crease 89", "pits")
    ),
    Expectation("swept", "ground", ("*",), "dips", limit=2.0, certain=("crease 75", "pits")),
    Expectation(
        "engine",
        "ground",
        ("slopes 75*", "spikes/*", "cliffs/*", "crease 8*", "pits/*", "heights/*", "own*"),
        "centre",
        certain=("slopes 75 to 89.99", "spikes"),
    ),
    Expectation("engine", "ground", ("tick lengths/*", "own tick*"), "trapezoid"),
    Expectation("fast", "path", ("*",), "tips", certain=("spikes",)),
)


def expected(column: Column, label: str, finding: Finding) -> Expectation | None:
    """The expectation that a finding meets, if any."""
    for expectation in EXPECTATIONS:
        if (
            expectation.check == finding.check
            and expectation.covers(column, label)
            and finding.worst <= expectation.limit
        ):
            return expectation
    return None


def certain(column: Column, extreme: str) -> list[Expectation]:
    """The failures that must be there in an extreme of the suite's own grounds."""
    return [e for e in EXPECTATIONS if e.tier == column.tier and extreme in e.certain]
