"""The errors a user can cause and mend; the command line prints their text alone and exits with code 1."""


class TrainingError(Exception):
    """Something asked for cannot be done: the message names what was expected, what came and what to do."""


class RecipeError(TrainingError, ValueError):
    """A recipe has an unknown field, or a value of the wrong type or out of range."""


class ModelError(TrainingError, ValueError):
    """A model file is missing, damaged, or made for other observation or action spaces."""
