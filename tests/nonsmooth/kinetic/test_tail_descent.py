"""First passage from starts far in the tails."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.special import ndtr

import nonsmooth as ns
from nonsmooth.kinetic.case_modes import first_passage, waves
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.tail_descent import NormalLaw, tail
from nonsmooth.kinetic.tail_equation import TailEquation, radau, reach


def far(start, **parameters):
    """Dry friction that starts far out."""
    return ns.Scene("friction", start={"y": start}, **parameters)


def deterministic(scene, threshold, horizons, tol=1e-7):
    """Values of the deterministic method."""
    return ns.crossing_probability(scene, threshold, horizons, method="deterministic", tol=tol)


def test_radau_is_exact_to_its_order():
    """The last stage integrates polynomials of degree 8, the others of degree 4."""
    nodes, matrix = radau(5)
    for k in range(9):
        exact = nodes ** (k + 1) / (k + 1)
        stages = slice(None) if k < 5 else slice(-1, None)
        assert np.allclose(matrix @ nodes**k, exact, rtol=0, atol=1e-13) or k >= 5
        assert np.allclose((matrix @ nodes**k)[stages], exact[stages], rtol=0, atol=1e-13)


@pytest.mark.parametrize("time", [1e-3, 9e-3, 1.1e-2, 0.3])
def test_law_of_the_flight(time):
    """The moments of a linear equation by matrix exponentials (Van Loan)."""
    law = tail(far(50.0, damping=0.8)).law(time)
    # (y, int y, 1) with dy = -(1 + C_b y) dt + dW
    linear = np.array([[-0.8, 0, -1], [1, 0, 0], [0, 0, 0]])
    noise = np.diag([1.0, 0, 0])
    mean = expm(linear * time) @ [50.0, 0, 1]
    block = expm(np.block([[-linear, noise], [np.zeros((3, 3)), linear.T]]) * time)
    covariance = block[3:, 3:].T @ block[:3, 3:]
    assert np.allclose(law.mean, mean[:2], rtol=1e-12)
    assert np.allclose(law.covariance, covariance[:2, :2], rtol=1e-9)


@pytest.mark.parametrize("threshold", [(-1.0, 1.0), (-1.0, np.inf), (-np.inf, 1.0)])
def test_march_against_modes(threshold):
    """At a depth of 15, where the modes have lost some digits: 1e-8 is left."""
    scene, z = far(3.0), np.array([0.5, 5.0, 3 + 5j, 0.5 + 20j])
    whole = ordinates(scene, 13, 0.1)
    expected = [first_passage(whole, w, *threshold) for w in z]
    out = tail(scene)
    bulk = ordinates(far(out.level), 11, 0.1)
    marched = TailEquation(out, out.law(0.0), *threshold, 11)
    found = [marched.mean(w, *waves(bulk, w, *threshold)) for w in z]
    assert np.max(np.abs(np.subtract(found, expected))) < 2e-8


def test_mean_over_the_normal_law():
    """From the end of the descent, times exp(-z t), it is the transform from the start."""
    out, z, threshold = tail(far(5.0)), 0.5 + 2j, (-3.0, 3.0)
    bulk = ordinates(far(out.level), 13, 0.1)
    at_once, later = (
        TailEquation(out, out.law(time), *threshold, 13).mean(z, *waves(bulk, z, *threshold))
        for time in (0.0, out.descent)
    )
    assert out.law(out.descent).passed(3.0) < 1e-15
    assert abs(at_once - np.exp(-z * out.descent) * later) < 1e-9  # what `NormalLaw` leaves out


def test_points_of_a_law():
    """Moments of a normal law cut off at a way."""
    law = NormalLaw(np.array([3.0, 1.0]), np.array([[0.25, 0.04], [0.04, 0.01]]))
    velocities, ways, weights = law.points(1.05)
    passed = ndtr(-0.5)
    hazard = np.exp(-0.125) / np.sqrt(2 * np.pi) / (1 - passed)
    assert law.passed(1.05) == pytest.approx(passed, rel=1e-12)
    assert weights @ ways == pytest.approx(1 - 0.1 * hazard, abs=1e-9)
    assert weights @ velocities == pytest.approx(3 - 0.4 * hazard, abs=1e-8)


def test_crossings_in_flight():
    """A start of depth 2600: a step, as wide as the normal law says; mirrored, the same."""
    horizons = [0.011, 0.012, 0.0121, 0.1, 100.0]
    found = deterministic(far(50.0), 0.6, horizons)
    # int y = 50 t - 51 t^2 / 2 + int W, but for t^3
    t = np.array(horizons[:3])
    rough = ndtr((50 * t - 25.5 * t**2 + 8.5 * t**3 - 0.6) / (t**1.5 / np.sqrt(3)))
    assert np.allclose(found.probability[:3], rough, rtol=0.05, atol=1e-7)
    assert np.all(found.probability[3:] == 1)
    assert np.all(found.probability_error <= 1e-7)
    mirrored = deterministic(far(-50.0), 0.6, horizons)
    assert np.allclose(mirrored.probability, found.probability, rtol=0, atol=1e-14)


def test_monte_carlo_from_afar():
    """The wall is next to where the flight ends; 4.5 standard errors: false alarm 7e-6."""
    found = deterministic(far(5.0), 2.0, [0.5], tol=1e-5)
    sample = ns.crossing_probability(far(5.0), 2.0, [0.5], paths=40_000, step=0.005, seed=3)
    bias = np.abs(sample.step_bias) + sample.step_bias_error
    gap = np.abs(sample.probability - found.probability)
    assert gap[0] < 4.5 * sample.probability_error[0] + bias[0]
    assert found.probability_error[0] <= 1e-5


def test_refused_where_g_changes_its_sign():
    """With the cure."""
    with pytest.raises(ns.NonsmoothError, match="monte_carlo"):
        deterministic(far(8.0, observable="y*(y**2 - 49)"), 0.6, [1.0])


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
    found = marched.mean(z, *waves(bulk, z, -0.2, 0.2))
    assert abs(found - first_passage(ordinates(scene, 13, 0.1), z, -0.2, 0.2)) < 2e-8
