"""Inverted transforms of the first passage: where contours are laid."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing.first_passage import contours
from references import SKEWED


@pytest.mark.slow
def test_contours_end_where_crossings_are_negligible(monkeypatch):
    """Times before the first crossings get at most one contour at each level."""
    begins = []
    inverted = contours.inverted

    def recorded(*contour):
        found = inverted(*contour)
        begins.append(abs(found[0]))
        return found

    monkeypatch.setattr(contours, "inverted", recorded)
    times = [0.01, 0.1, 0.3, 1.0, 5.0, 10.0, 20.0]
    # this tolerance takes two levels
    found = ns.crossing_probability(SKEWED, 0.6, times, 0.01, method="deterministic", tol=1e-3)
    assert np.sum(np.array(begins) < 1e-15) <= 2
    assert np.all(found.probability[:2] == 0)
    assert np.all(found.probability_error[:2] >= 1e-14)
    assert found.probability[-1] > 0.1
