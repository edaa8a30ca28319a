"""The Poisson solution fitted to a short simulation."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.control_variate import poisson_slope
from nonsmooth.paths.tilted import poisson
from references import FRICTION


def test_slope_is_that_of_the_equation():
    """For one variable u' is known by quadrature; a polynomial of degree 7 is within a few %."""
    guide, exact = poisson.fitted(FRICTION, 0.05, 1), poisson_slope(FRICTION)
    y = np.linspace(-exact.reach, exact.reach, len(exact.values))
    fitted = guide.coefficients[1] @ guide.basis.values(y[None])
    off = np.sum((fitted - exact.values) ** 2 * exact.density)
    assert off < 0.03 * np.sum(exact.values**2 * exact.density)


@pytest.mark.parametrize("n", [100, np.inf])
@pytest.mark.parametrize("model", ["elasto_plastic", "obstacle"])
def test_martingale_carries_the_variance(model, n):
    """gamma^2 of the martingale is within 15 % of that of the solver, at n = inf of n = 1e4.

    The polynomials explain 96 to 99 %; the step of 0.05 and 4000 stretches add a few per cent.
    """
    scene = ns.Scene(model, potential="x**2/2", n=n)
    gamma2 = ns.asymptotic_variance(scene.with_n(min(n, 1e4)), tol=1e-3).value
    assert poisson.fitted(scene, 0.05, 1).gamma ** 2 == pytest.approx(gamma2, rel=0.15)


def test_refuses_what_does_not_spread():
    """The integral of the velocity between obstacles is a displacement, which stays bounded."""
    scene = ns.Scene("obstacle", potential="x**2/2", observable="y")
    with pytest.raises(SceneError, match="does not spread"):
        poisson.fitted(scene, 0.05, 1)


def test_refuses_paths_that_diverge():
    """As from a potential that is not confining."""
    scene = ns.Scene("obstacle", potential="-1e3*x**2", observable="x")
    with pytest.raises(SceneError, match="the simulation diverged"):
        poisson.fitted(scene, 0.05, 1)
