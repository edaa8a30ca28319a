"""gamma^2 on tensor grids against what is known exactly."""

from itertools import pairwise

import numpy as np
import pytest

import nonsmooth as ns
from exact_gamma2 import linear_reference, random_linear
from nonsmooth.errors import ToleranceError
from nonsmooth.grids import direct_solver
from nonsmooth.statistics import gamma2_on_grids
from references import GAMMA2_OBSTACLE, OBSTACLE


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("square", [False, True])
def test_two_variables_linear(seed, square):
    """The stated error is larger than the true one and smaller than the tolerance."""
    parameters = random_linear(np.random.default_rng(seed), "white")
    scene = ns.Scene(**parameters, observable="x**2" if square else "x")
    found = ns.asymptotic_variance(scene, tol=1e-5)
    assert abs(found.value - linear_reference(scene, square)) <= found.error
    assert found.error <= 1e-5 * found.value


@pytest.mark.slow
@pytest.mark.parametrize("square", [False, True])
def test_three_variables_linear(square):
    """The stated error of the alternating solver holds, with and without mirror symmetry."""
    parameters = random_linear(np.random.default_rng(3), "langevin")
    scene = ns.Scene(**parameters, observable="x**2" if square else "x")
    found = ns.asymptotic_variance(scene, tol=2e-2, method="deterministic")
    assert abs(found.value - linear_reference(scene, square)) <= found.error


@pytest.mark.slow
def test_residuals_that_one_iterate_meets_say_nothing():
    """Four variables, linear: one iteration gains two digits, so that a tenth changes nothing."""
    rng = np.random.default_rng(107)
    rng.random()
    scene = ns.Scene(**random_linear(rng, "hamiltonian"), observable="x")
    value, error = gamma2_on_grids.gamma2(scene, 1e-2)
    assert abs(value - linear_reference(scene, False)) <= error <= 1e-2 * value


def test_cost_grows_smoothly_with_the_digits(monkeypatch):
    """Each digit takes at most four times the grid points of the one before, and errors hold.

    The walls are too far to be reached: gamma^2 of x is sigma^2 over the squared stiffness.
    """
    scene = ns.Scene("obstacle", ns.White(0.4), damping=0.8, potential="15*x**2", observable="x")
    sizes = []
    factorise = direct_solver.SparseFactors.__init__

    def counted(factors, matrix):
        sizes.append(matrix.shape[0])
        factorise(factors, matrix)

    monkeypatch.setattr(direct_solver.SparseFactors, "__init__", counted)
    work = []
    for tol in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        sizes.clear()
        found = ns.asymptotic_variance(scene, tol, "deterministic")
        work.append(sum(sizes))
        assert abs(found.value - 0.16 / 900) <= found.error <= tol * found.value
    assert all(fine <= 4 * coarse for coarse, fine in pairwise(work))


def test_forcing_balance_of_the_elasto_plastic_model():
    """gamma^2[U' + C_b y] is the white forcing's spectrum at 0 (the forcing balance)."""
    scene = ns.Scene("elasto_plastic", n=50, potential="x**2/2", observable="x + y")
    found = ns.asymptotic_variance(scene, tol=1e-5)
    assert abs(found.value - 1) <= found.error


def test_forcing_balance_of_friction():
    """gamma^2[C_b y + a_n'] = 1 / theta^2 under the Ornstein-Uhlenbeck forcing."""
    scene = ns.Scene(
        "friction", ns.OrnsteinUhlenbeck(2.0), n=20, observable="y + max(min(20*y, 1), -1)"
    )
    found = ns.asymptotic_variance(scene, tol=1e-5)
    assert abs(found.value - 0.25) <= found.error


def test_plastic_strain_has_the_growth_rate_of_the_displacement():
    """Int (y - g) = X(T) - X(0) is bounded; the two observables share no term."""
    a, b = (
        ns.asymptotic_variance(
            ns.Scene("elasto_plastic", n=100, potential="x**2/2", observable=g), tol=1e-5
        )
        for g in ("y", "plastic_strain_rate")
    )
    assert abs(a.value - b.value) <= a.error + b.error


def test_published_value_of_the_obstacle():
    """gamma^2 is the published one within its error and the rounding of the digits."""
    found = ns.asymptotic_variance(OBSTACLE)
    assert abs(found.value - GAMMA2_OBSTACLE) <= found.error + 5e-10


@pytest.mark.slow
def test_non_smooth_limit_of_the_elasto_plastic_model():
    """gamma_n^2 = gamma_inf^2 + c / n + O(n^-2): three finite n agree with n = inf."""
    scene = ns.Scene("elasto_plastic", potential="x**2/2")
    finite = [ns.asymptotic_variance(scene.with_n(n), tol=1e-5) for n in (1e3, 1e4)]
    limit = ns.asymptotic_variance(scene.with_n(np.inf), tol=1e-5)
    extrapolated = finite[1].value + (finite[1].value - finite[0].value) / 9
    # the neglected term is (c / n)^2 ~ (0.06 / 1e3)^2 / gamma^2 relative
    allowed = limit.error + 1.2 * finite[1].error + 0.2 * finite[0].error + 1e-6 * limit.value
    assert abs(limit.value - extrapolated) <= allowed


@pytest.mark.slow
def test_a_bounded_integral_is_refused():
    """G = y between walls: gamma^2 = 0 cannot have a relative error."""
    with pytest.raises(ToleranceError, match="error of"):
        gamma2_on_grids.gamma2(ns.Scene("obstacle", potential="x**2/2", observable="y"), tol=1e-3)


@pytest.mark.parametrize(
    "question",
    [
        lambda scene: ns.asymptotic_variance(scene, 0.1, method="deterministic"),
        lambda scene: ns.crossing_probability(scene, 1.0, [1.0], 10.0, "deterministic", tol=0.1),
    ],
    ids=["gamma2", "crossing"],
)
def test_contacts_beyond_the_grid_are_refused(question):
    """The walls are hit with a probability that rounds to 0, which is not 0 exactly."""
    scene = ns.Scene("obstacle", ns.White(0.2), potential="4*x**2", observable="contact_force")
    with pytest.raises(ToleranceError, match="is 0 as far as grids reach"):
        question(scene)
