"""The expansion in p^(-1/2) of which the corrected formulas are made."""

import numpy as np
import pytest

from nonsmooth.boundary_layer.asymmetric_line import layer_constants
from nonsmooth.crossing.expansion import Expansion
from references import SKEWED_AND_STARTED


@pytest.mark.parametrize("interval", [(-0.3, 0.6), (-np.inf, 0.6), (-0.6, np.inf)])
def test_without_symmetry_is_a_distribution(interval):
    """Between 0 and 1, and monotone in T, at any p."""
    constants, _ = layer_constants(SKEWED_AND_STARTED)
    for p in (1e-2, 1.0, 30.0, 1e3):
        formula = Expansion(constants, *(np.sqrt(p) * np.array(interval)))
        for value in formula.orders(p * np.geomspace(1e-3, 1e3, 300)):
            assert np.all((value >= 0) & (value <= 1))
            assert np.all(np.diff(value) >= -1e-13)  # rounding of sums of eighty terms
