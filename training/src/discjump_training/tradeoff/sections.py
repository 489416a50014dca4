"""All sections, in the order of the report."""

from discjump_training.tradeoff.apex import Apex
from discjump_training.tradeoff.errors import Errors
from discjump_training.tradeoff.outcomes import Outcomes
from discjump_training.tradeoff.section import Section
from discjump_training.tradeoff.speed import Speed

_ALL: tuple[Section, ...] = (Speed(), Errors(), Outcomes(), Apex())
SECTIONS: dict[str, Section] = {section.name: section for section in _ALL}
"""By name."""
