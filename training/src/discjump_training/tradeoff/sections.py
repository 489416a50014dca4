"""All sections, in the order of the report."""

from discjump_training.tradeoff.apex import Apex
from discjump_training.tradeoff.errors import Errors
from discjump_training.tradeoff.instructions import Instructions
from discjump_training.tradeoff.outcomes import Outcomes
from discjump_training.tradeoff.section import Made, Panel, Section
from discjump_training.tradeoff.speed import Speed, speeds
from discjump_training.tradeoff.training import Training
from discjump_training.tradeoff.transfer import Transfer

_ALL: tuple[Section, ...] = (
    Speed(),
    Instructions(),
    Errors(),
    Outcomes(),
    Apex(),
    Transfer(),
    Training(),
)
SECTIONS: dict[str, Section] = {section.name: section for section in _ALL}
"""By name."""


def panels(made: dict[str, Made]) -> list[Panel]:
    """The picture of what was made of the sections; none without speeds."""
    if "speed" not in made:
        return []
    axis = speeds(made["speed"])
    return [
        panel
        for name, section in SECTIONS.items()
        if name in made
        for panel in section.panels(made[name], axis)
    ]
