"""`discjump.knockback` against the plain Python curves, which have section 6's table behind them."""

import numpy as np
import pytest

import discjump

from .article import ARMORS
from .blast import DISC, min_box, power


@pytest.mark.parametrize("formula", ["tribes", "basic", "linear_boosted"])
@pytest.mark.parametrize("armor", ["light", "medium", "heavy"])
def test_knockback_curves(formula: str, armor: str) -> None:
    m = min_box(ARMORS[armor])
    distances = np.linspace(0.0, 10.0, 401)
    curve = discjump.knockback(distances, formula=formula, radius=DISC.radius, min_box=m)
    expected = [power(d, formula, DISC.radius, m) for d in distances]
    np.testing.assert_allclose(curve, expected, rtol=0.0, atol=1e-12)
