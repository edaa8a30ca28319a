"""Polynomials on Gauss nodes of a normal variable, and which variables have them."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.grids.mesh import axes
from nonsmooth.grids.mesh.hermite import deviation, hermite
from nonsmooth.scenes.symbols import eta, y, zeta
from nonsmooth.statistics.gamma2_on_grids import gamma2

KANAI_TAJIMI = ns.KanaiTajimi(stiffness=2.0, damping=0.8, sigma=1.5)


@pytest.mark.parametrize("count", [6, 14, 30])
def test_the_linear_generator_has_whole_eigenvalues(count):
    """-z d/dz + s^2 d^2/dz^2 has the eigenvalues 0, -1, -2, ... on polynomials."""
    spread = 0.7
    axis = hermite(count, spread, 4.0)
    generator = -axis.nodes[:, None] * axis.slope.toarray() + spread**2 * axis.curvature.toarray()
    found = np.sort(np.linalg.eigvals(generator).real)[::-1]
    # products of `count` terms of the size of the largest eigenvalue
    assert np.allclose(found, -np.arange(count), atol=1e-13 * count**2)


def test_weights_and_densities_are_those_of_the_law():
    """The measure (1 + z) times a normal law has its density, wherever it is asked for."""
    axis = hermite(10, 0.7, 4.0)
    assert np.isclose(axis.weights @ axis.nodes**18, 0.7**18 * np.prod(np.arange(1, 18, 2.0)))
    points = np.array([-3.9, -0.3, 0.0, 2.0])
    normal = np.exp(-((points / 0.7) ** 2) / 2) / (np.sqrt(2 * np.pi) * 0.7)
    found = axis.densities(points) @ (axis.weights * (1 + axis.nodes))
    assert np.allclose(found, (1 + points) * normal, rtol=1e-10, atol=1e-12)


def test_only_smooth_linear_noise_has_polynomials():
    """Not the forcing of friction, nor a noise with another restoring force, nor the velocity."""
    plastic = ns.Scene("elasto_plastic", KANAI_TAJIMI, potential="x**2/2")
    # 2 E zeta^2 = sigma^2 / friction, of dz = (... - friction z) dt + sigma dW
    restoring = -float(plastic.noise.drift[zeta].diff(zeta))
    assert np.isclose(deviation(plastic, zeta), 1.5 / np.sqrt(2 * restoring))
    assert deviation(plastic, eta) is None
    assert deviation(plastic, y) is None
    assert deviation(ns.Scene("friction", "langevin"), eta) is None
    assert deviation(ns.Scene("obstacle", "langevin"), eta) is not None
    quartic = ns.Langevin(potential="eta**4/4", sigma=1.0)
    assert deviation(ns.Scene("obstacle", quartic), eta) is None
    assert deviation(ns.Scene("obstacle", "white"), y) is None


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    [
        ns.Scene("elasto_plastic", "langevin", n=10, potential="x**2/2", observable="y"),
        ns.Scene("obstacle", "langevin", n=10, potential="x**2/2 + x/2", observable="x"),
        ns.Scene("friction", KANAI_TAJIMI, n=10, observable="y"),
    ],
)
def test_elements_agree(scene, monkeypatch):
    """gamma^2 is the same on elements within the errors that both state."""
    value, error = gamma2(scene, 3e-3)
    monkeypatch.setattr(axes, "deviation", lambda scene, symbol: None)
    other, other_error = gamma2(scene, 3e-3)
    assert value != other
    assert abs(value - other) <= error + other_error
