"""The inverse Laplace transform on hyperbolas (Weideman and Trefethen 2007)."""

import numpy as np
import pytest
from scipy.special import erfc

from nonsmooth.crossing.first_passage.contours import hyperbola, inverted, through_saddle


@pytest.mark.parametrize(("ratio", "count", "rate"), [(1.01, 10, 2.0), (10.0, 24, 0.9)])
def test_inverts_to_the_declared_rate(ratio, count, rate):
    """exp(-sqrt z)/z is the transform of erfc(1/(2 sqrt t)); error exp(-rate count)."""
    contour = hyperbola(1.0, ratio, count).until(count)
    times = np.linspace(1.0, ratio, 7)
    value = contour.invert(np.exp(-np.sqrt(contour.nodes)) / contour.nodes, times)
    assert np.max(np.abs(value - erfc(0.5 / np.sqrt(times)))) < np.exp(-rate * count)


def test_a_saddle_point_keeps_relative_accuracy():
    """The same transform at t = 0.01, where erfc(5) = 1.5e-12: to ten digits, as spacing 1 says.

    The exponent z t - sqrt z - log z is stationary near z = 1/(4 t^2).
    """
    time, place = 0.01, 2500.0
    width = place / np.sqrt(place**0.5 / 4)  # the second derivative of -sqrt z is z^(-3/2) / 4
    contour = through_saddle(place, width, 1.0, 0.4)
    value = inverted(lambda z: np.exp(-np.sqrt(z)) / z, contour, np.array([time]), 1e-14)[0]
    assert value == pytest.approx(erfc(0.5 / np.sqrt(time)), rel=1e-9)
