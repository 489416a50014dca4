"""The errors a user can cause and mend; the command line prints their text alone and exits with code 1."""

from collections.abc import Iterator
from contextlib import contextmanager

import click


class TrainingError(Exception):
    """Something asked for cannot be done: the message names what was expected, what came and what to do."""


class RecipeError(TrainingError, ValueError):
    """A recipe has an unknown field, or a value of the wrong type or out of range."""


class ModelError(TrainingError, ValueError):
    """A model file is missing, damaged, or made for other observation or action spaces."""


@contextmanager
def clean_errors() -> Iterator[None]:
    """Errors the user can mend are printed without a traceback; the exit code is 1."""
    try:
        yield
    except TrainingError as error:
        raise click.ClickException(str(error)) from error
