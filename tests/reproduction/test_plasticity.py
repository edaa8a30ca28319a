"""The example of the permanent deformation."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from reproduction.plasticity import relaxation_time, yielding_oscillator

GROUND = {"stiffness": 6.25, "damping": 3.0, "sigma": 3.0}
OSCILLATOR = {"n": 100, "damping": 0.1, "potential": "x**2/2"}


def test_the_deformation_is_the_displacement_less_the_elastic_part():
    """int_0^t y = X(t) + permanent deformation on every path; the left by the trapezoidal rule."""
    scene = yielding_oscillator(GROUND, OSCILLATOR)
    assert scene.state == ("zeta", "eta", "y", "x")
    times = 0.01 * np.arange(1, 4001)
    run = ns.simulate(scene, 40.0, step=0.01, paths=20, seed=1, times=times, keep="paths")
    displacement = np.trapezoid(run["y"], run["time"], axis=1)
    assert np.allclose(displacement, run["x"][:, -1] + run["delta"][:, -1], atol=2e-3)
    assert float(np.abs(run["delta"][:, -1]).max()) > 1


def test_bad_parameters_are_refused():
    """Parameters that make no scene or no noise are refused in one line."""
    with pytest.raises(SceneError, match=r"stiffness of the noise is -1\.0; give a positive"):
        yielding_oscillator(GROUND | {"stiffness": -1.0}, OSCILLATOR)
    with pytest.raises(SceneError, match=r"damping is 0\.0; give a positive"):
        yielding_oscillator(GROUND, OSCILLATOR | {"damping": 0.0})


def test_relaxation_time_is_that_of_the_free_vibration():
    """The slowest eigenvalue of x'' + C_b x' + x = 0 has the real part -C_b/2."""
    for damping in (0.02, 0.1, 1.0):
        slowest = np.linalg.eigvals([[0, 1], [-1, -damping]]).real.max()
        assert relaxation_time({"damping": damping}) == pytest.approx(-1 / slowest)
