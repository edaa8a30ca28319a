"""The equation of the first passage in the tails, marched down to the bulk."""

import numpy as np
import pytest
from scipy.optimize import brentq

from nonsmooth.errors import ToleranceError
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.tail_descent import tail
from nonsmooth.kinetic.tail_equation import TailEquation, front_rate, radau, reach
from references import far


def test_radau_is_exact_to_its_order():
    """The last stage integrates polynomials of degree 8, the others of degree 4."""
    nodes, matrix = radau(5)
    for k in range(9):
        exact = nodes ** (k + 1) / (k + 1)
        stages = slice(None) if k < 5 else slice(-1, None)
        assert np.allclose(matrix @ nodes**k, exact, rtol=0, atol=1e-13) or k >= 5
        assert np.allclose((matrix @ nodes**k)[stages], exact[stages], rtol=0, atol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("threshold", [(-1.0, 1.0), (-1.0, np.inf), (-np.inf, 1.0)])
def test_march_against_modes(threshold):
    """March and modes agree to 1e-8 at a depth of 15, where modes have lost some digits."""
    scene, z = far(3.0), np.array([0.5, 5.0, 3 + 5j, 0.5 + 20j])
    whole = ordinates(scene, 13, 0.1)
    expected = [modes(whole, w).first_passage(*threshold) for w in z]
    out = tail(scene)
    bulk = ordinates(far(out.level), 11, 0.1)
    marched = TailEquation(out, out.law(0.0), *threshold, 11)
    found = [marched.mean(w, *modes(bulk, w).waves(*threshold)) for w in z]
    assert np.max(np.abs(np.subtract(found, expected))) < 2e-8


def test_mean_over_the_normal_law():
    """The mean at the end of the descent, times exp(-z t), is the transform at the start."""
    out, z, threshold = tail(far(5.0)), 0.5 + 2j, (-3.0, 3.0)
    bulk = ordinates(far(out.level), 13, 0.1)
    at_once, later = (
        TailEquation(out, out.law(time), *threshold, 13).mean(z, *modes(bulk, z).waves(*threshold))
        for time in (0.0, out.descent)
    )
    assert out.law(out.descent).passed(3.0) < 1e-15
    assert abs(at_once - np.exp(-z * out.descent) * later) < 1e-9  # what `NormalLaw` leaves out


@pytest.mark.parametrize("begun", [0.0, 0.5])
def test_the_spread_of_arrivals(begun):
    """With linear drift and g it is that of the way at the time of arrival, over the velocity."""
    out, distance = tail(far(5.0)), 2.0
    arrival = brentq(lambda t: out.law(t).mean[1] - distance, 0, 1)
    law = out.law(arrival)
    exact = law.mean[0] / np.sqrt(law.covariance[1, 1])
    # the trapezoidal rule with 1001 points
    assert front_rate(out, out.law(begun * arrival), distance) == pytest.approx(exact, rel=1e-4)
    assert front_rate(out, out.law(0.0), 20.0) == front_rate(out, out.law(0.0), np.inf) == 0.0


def test_arrivals_that_hardly_differ_are_refused():
    """The noise spreads the time of arrival, 0.146, by a part of 0.006."""
    out = tail(far(5.0, observable="atan(y)"))
    with pytest.raises(ToleranceError, match="hardly differ"):
        front_rate(out, out.law(0.0), 0.2)


def test_the_longest_way():
    """Friction alone stops y: int y <= sup over the way down, by Chernoff above the mean way."""
    out = tail(far(10.0))
    fall = np.log(11.0 / (1 + out.level))
    assert 10.0 - out.level - fall < reach(out) < 40.0
    assert reach(tail(far(-10.0, observable="y + abs(y)"))) == 0.0


def test_g_that_vanishes_in_the_tail():
    """Nothing moves before the level is reached; the modes are those of a depth of 15."""
    scene, z = far(-3.0, observable="y + abs(y)"), 0.5 + 1j
    out = tail(scene)
    bulk = ordinates(far(-out.level, observable="y + abs(y)"), 11, 0.1)
    marched = TailEquation(out, out.law(0.0), -0.2, 0.2, 11)
    found = marched.mean(z, *modes(bulk, z).waves(-0.2, 0.2))
    assert abs(found - modes(ordinates(scene, 13, 0.1), z).first_passage(-0.2, 0.2)) < 2e-8
