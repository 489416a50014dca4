"""Types of options that several commands take."""

import math

import click


class FiniteRange(click.FloatRange):
    """A `click.FloatRange` that refuses NaN too, which is neither below nor above any limit."""

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """The number; fails where it is out of range or none."""
        number = float(super().convert(value, param, ctx))  # type: ignore[arg-type]
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self._describe_range()}.", param, ctx)
        return number
