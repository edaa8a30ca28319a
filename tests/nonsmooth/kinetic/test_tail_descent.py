"""The law of paths that start far in the tails, until they come down to the bulk."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.special import ndtr

from nonsmooth.kinetic.tail_descent import NormalLaw, tail
from references import far


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


def test_points_of_a_law():
    """The points of a normal law cut off at a way have its moments."""
    law = NormalLaw(np.array([3.0, 1.0]), np.array([[0.25, 0.04], [0.04, 0.01]]))
    velocities, ways, weights = law.points(1.05)
    passed = ndtr(-0.5)
    hazard = np.exp(-0.125) / np.sqrt(2 * np.pi) / (1 - passed)
    assert law.passed(1.05) == pytest.approx(passed, rel=1e-12)
    assert weights @ ways == pytest.approx(1 - 0.1 * hazard, abs=1e-9)
    assert weights @ velocities == pytest.approx(3 - 0.4 * hazard, abs=1e-8)
