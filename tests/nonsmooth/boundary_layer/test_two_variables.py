"""kappa of two variables, where the generator is not self-adjoint."""

import mpmath
import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla

import nonsmooth as ns
from nonsmooth.boundary_layer import symmetric_line
from nonsmooth.boundary_layer.two_variables import layer_constants
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.generator import evaluate


@pytest.mark.slow
def test_ornstein_uhlenbeck():
    """A spring too weak to matter: the closed form of one variable, by the solver of two."""
    found, errors = layer_constants(ns.Scene("elasto_plastic", potential="1e-9*x**2"))
    line, _ = symmetric_line.layer_constants(ns.Scene("elasto_plastic", potential="0"))
    kappa = -float(mpmath.zeta(0.5)) / np.sqrt(2)
    kappa3 = -float(mpmath.zeta(1.5)) / 12 / np.sqrt(2)
    # the spring adds of the order of its stiffness
    for name, exact in (
        ("diffusion", 0.5),
        ("kappa", (kappa, kappa)),
        ("dispersion", 0.0),
        ("dipole", line.dipole),
        ("h", line.h),
        ("kappa3", kappa3),
    ):
        distance = np.max(np.abs(np.subtract(getattr(found, name), exact)))
        assert distance <= np.max(getattr(errors, name)) + 1e-7, name
    assert errors.kappa[1] <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.3, 1.0])
def test_solutions_of_different_boxes_and_grids_agree(damping):
    """Two tolerances lead to other boxes and grids; both results are within their errors.

    The modes of this scene are so far from orthogonal that by eigenvectors they lose all digits.
    """
    scene = ns.Scene("obstacle", damping=damping, potential="x**2/2", observable="x")
    coarse, fine = (ns.extrapolation_length(scene, tol) for tol in (1e-2, 2e-3))
    assert coarse.error <= 1e-2
    assert fine.error <= 2e-3
    assert abs(coarse.value - fine.value) <= coarse.error + fine.error


@pytest.mark.slow
def test_yielding_displacement():
    """The displacement crosses b when the plastic strain crosses b - 1, for it yields at x = 1.

    So all constants follow from each other, but for a length that is 1 longer. Exactly so at
    n = inf; at a finite n, x passes 1 by y/n, with y of order 1.
    """
    (total, errors), (plastic, inexact) = (
        layer_constants(
            ns.Scene("elasto_plastic", potential="x**2/2", n=1e4, observable=g), tol=1e-2
        )
        for g in ("y", "plastic_strain_rate")
    )
    nearly = 1e-4
    assert abs(total.kappa[1] - (plastic.kappa[1] - 1)) <= (
        errors.kappa[1] + inexact.kappa[1] + nearly
    )
    for name in ("diffusion", "dispersion", "kappa3"):
        distance = np.max(np.abs(np.subtract(getattr(total, name), getattr(plastic, name))))
        inherited = np.max(getattr(errors, name)) + np.max(getattr(inexact, name))
        assert distance <= inherited + nearly, name
    # early times and the start act together
    delay, other = (one.dipole[1] - one.h for one in (total, plastic))
    uncertain = sum(one.dipole[1] + one.h for one in (errors, inexact))
    assert abs(delay - other) <= uncertain + nearly


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    [
        ns.Scene("friction", "langevin", n=5),
        ns.Scene("obstacle", potential="x**2/2", n=5, observable="x"),
    ],
    ids=["friction", "obstacle"],
)
def test_the_dispersion_is_that_of_the_largest_eigenvalue(scene):
    """For small q the largest eigenvalue of A + q g is D q^2 + B q^4, up to q^6.

    Two values of q give B; the term of q^6 changes it by less than their ratio says.
    """
    constants, errors = layer_constants(scene, tol=0.1)
    grid = tensor_grid.fitted(scene, 16.0, 2)
    axes, solver = tensor_grid.direct_solver(scene, grid)
    g = evaluate(scene.numerical_observable(), axes)

    def fourth(q):
        matrix = solver.generator + q * sp.diags_array(g)
        largest = spla.eigs(matrix.tocsc(), k=1, sigma=1e-3)[0][0].real
        return largest / q**4 - constants.diffusion / q**2

    scale = 0.1 / np.sqrt(constants.diffusion)
    coarse, fine = fourth(2 * scale), fourth(scale)
    extrapolated = fine + (fine - coarse) / 3
    allowed = errors.dispersion + abs(fine - coarse) / 3 + errors.diffusion / scale**2
    assert abs(extrapolated - constants.dispersion) <= allowed


@pytest.mark.slow
def test_a_start_far_out():
    """At the start u is the mean of int g after a long time, also beyond the density's grids.

    The sample is off by less than 4.5 standard errors; false alarms 7e-6.
    """
    scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(1.0), n=10, start={"y": 30.0})
    constants, errors = layer_constants(scene, 0.1, higher=False)
    run = ns.simulate(scene, horizon=20.0, step=0.01, paths=4096, seed=3)
    allowed = errors.u + 4.5 * run["mean_error"][-1] + abs(run["mean_bias"][-1])
    assert abs(constants.u - run["mean"][-1]) < allowed
    assert allowed < 0.3


def test_bounded_observable():
    """Velocities whose integral stays bounded have gamma^2 = 0, and no extrapolation length."""
    with pytest.raises(ns.NonsmoothError, match="no extrapolation length"):
        ns.extrapolation_length(ns.Scene("obstacle", potential="x**2/2", observable="y"))
