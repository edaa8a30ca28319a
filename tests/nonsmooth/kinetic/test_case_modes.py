"""The transform of the first passage from Case's modes."""

import numpy as np
import pytest

from nonsmooth.kinetic.case_modes import first_passage
from nonsmooth.kinetic.ordinates_line import ordinates
from references import MIRRORED, SKEWED


@pytest.mark.slow
@pytest.mark.parametrize("z", [0.7, 0.3 + 2j, -0.5 + 2j])
def test_transform_without_symmetry(z):
    """Converges in the degree, and the mirrored scene has the mirrored walls."""
    for levels in ((-0.3, 0.6), (-np.inf, 0.6)):
        values = [
            first_passage(ordinates(SKEWED, degree, 1.0), z, *levels) for degree in (7, 9, 13)
        ]
        assert abs(values[0] - values[2]) < 1e-6
        assert abs(values[1] - values[2]) < 1e-7
        swapped = first_passage(ordinates(MIRRORED, 9, 1.0), z, -levels[1], -levels[0])
        assert abs(swapped - values[1]) < 1e-9
