"""A card per task: what an agent meets there, from the code itself.

words     what numbers of observations, actions and rewards mean
card      the card of a task, as Markdown
command   `discjump card`
"""

from discjump.cards.card import card

__all__ = ["card"]
