"""Derivatives of gamma^2 against differences of closed forms and of other solutions."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line.dry_friction import friction_variance
from references import FRICTION, OBSTACLE, PLASTIC

WEIGHTS = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60  # of a difference of the order 6


def difference(f, at, step):
    """Return the derivative by values at seven points and a bound of its error.

    The points are `step` times the parameter apart.

    The bound is the distance to the difference over twice the step, whose error is 64 times as
    large if the differences have converged.
    """
    near, far = (
        WEIGHTS @ [f(at * (1 + k * h)) for k in range(-3, 4)] / (at * h) for h in (step, 2 * step)
    )
    return near, abs(near - far)


@pytest.mark.parametrize("n", [2.0, 100.0, np.inf])
@pytest.mark.parametrize("damping", [0.3, 4.0])
def test_dry_friction_by_damping(n, damping):
    """The closed form of gamma^2, differentiated; 1e-11 is the rounding of its differences."""
    scene = ns.Scene("friction", n=n, damping=damping)
    slope = ns.asymptotic_variance_sensitivity(scene, "damping")
    exact, bound = difference(lambda c: friction_variance(n, c)[0], damping, 0.01)
    assert abs(slope.value - exact) <= slope.error + bound + 1e-11
    assert slope.error <= 1e-8 * abs(slope.value)


@pytest.mark.parametrize("n", [2.0, 100.0, 1e4])
def test_dry_friction_by_n(n):
    """The kink moves with n; gamma^2 falls as friction becomes dry."""
    slope = ns.asymptotic_variance_sensitivity(FRICTION.with_n(n), "n")
    exact, bound = difference(lambda m: friction_variance(m, 1.0)[0], n, 0.01)
    assert abs(slope.value - exact) <= slope.error + bound + 1e-14 / (0.01 * n)


def test_dry_friction_by_sigma():
    """In units sigma, C_b: y = sigma^2 z gives gamma^2(sigma, C) = sigma^6 gamma^2(1, C sigma^2).

    Here n = inf: time is measured in sigma^2. So d gamma^2 = 6 gamma^2 + 2 C d gamma^2 / dC.
    """
    scene = ns.Scene("friction", n=np.inf, damping=0.7)
    by_sigma, by_damping = (
        ns.asymptotic_variance_sensitivity(scene, name) for name in ("sigma", "damping")
    )
    gamma2 = ns.asymptotic_variance(scene)
    exact = 6 * gamma2.value + 2 * 0.7 * by_damping.value
    error = by_sigma.error + 6 * gamma2.error + 1.4 * by_damping.error
    assert abs(by_sigma.value - exact) <= error


@pytest.mark.slow
def test_an_agreement_of_grids_by_chance():
    """Derivatives on the first two grids differ by 5e-6, and both are off by 1e-4.

    What gamma^2 itself changes shows that grids are coarse.
    """
    well = "x**2/2 + 0.3*cos(2*x)"
    scene = ns.Scene("elasto_plastic", ns.White(1.4), 653.6, 0.7891, well, "x + y")
    loose, tight = (
        ns.asymptotic_variance_sensitivity(scene, "damping", tol) for tol in (1e-3, 2e-5)
    )
    assert abs(loose.value - tight.value) <= loose.error + tight.error


def test_linear_scene():
    """Without friction gamma^2 = (sigma / C_b)^2, exactly."""
    scene = ns.Scene("elasto_plastic", ns.White(0.6), damping=1.7)
    for name, exact in (("damping", -2 * 0.6**2 / 1.7**3), ("sigma", 2 * 0.6 / 1.7**2)):
        slope = ns.asymptotic_variance_sensitivity(scene, name)
        assert abs(slope.value - exact) <= slope.error


def test_observable_with_the_parameter_in_it():
    """The friction force is a function of n; its derivative is part of that of gamma^2."""
    scene = ns.Scene("friction", n=3.0, observable="friction_force")
    slope = ns.asymptotic_variance_sensitivity(scene, "n")
    exact, bound = difference(lambda n: ns.asymptotic_variance(scene.with_n(n)).value, 3.0, 0.01)
    assert abs(slope.value - exact) <= slope.error + bound + 1e-9


@pytest.mark.parametrize(
    ("scene", "parameter"),
    [
        pytest.param(PLASTIC.with_n(20), "damping", marks=pytest.mark.slow),
        pytest.param(PLASTIC.with_n(20), "n", marks=pytest.mark.slow),
        (OBSTACLE.with_n(20), "sigma"),
        pytest.param(ns.Scene("friction", "langevin", n=5), "n", marks=pytest.mark.slow),
        pytest.param(
            ns.Scene("friction", n=5, potential="x**2/2", observable="x"),
            "n",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_two_variables(scene, parameter):
    """Differences of gamma^2, each solved by itself to 1e-6."""
    slope = ns.asymptotic_variance_sensitivity(scene, parameter, tol=1e-4)
    at = scene.noise.sigma if parameter == "sigma" else getattr(scene, parameter)

    def solved(value):
        return ns.asymptotic_variance(
            scene.with_parameter(parameter, value), 1e-6, "deterministic"
        ).value

    steps = np.array([-0.1, -0.05, 0.05, 0.1])
    values = np.array([solved(at * (1 + step)) for step in steps])
    exact = np.array([1, -8, 8, -1]) @ values / (0.6 * at)
    # the difference over the outer points alone is of the order 2: four times as far as its half
    rough = (values[3] - values[0]) / (0.2 * at), (values[2] - values[1]) / (0.1 * at)
    bound = 0.1 * abs(rough[0] - rough[1]) + 3e-5 * values.max() / at
    assert abs(slope.value - exact) <= slope.error + bound


@pytest.mark.slow
def test_three_variables():
    """The combination technique, for the damping of friction under earthquake noise."""
    scene = ns.Scene("friction", "hamiltonian", n=5)
    slope = ns.asymptotic_variance_sensitivity(scene, "damping", tol=2e-2)
    values = [
        ns.asymptotic_variance(scene.with_parameter("damping", c), 1e-3, "deterministic").value
        for c in (0.9, 1.1)
    ]
    exact = (values[1] - values[0]) / 0.2
    assert abs(slope.value - exact) <= slope.error + 0.02 * abs(exact) + 0.01 * values[0]


def test_refusals():
    """Each is one line that names the offender."""
    with pytest.raises(SceneError, match="n = inf has no derivative"):
        ns.asymptotic_variance_sensitivity(FRICTION.with_n(np.inf), "n")
    with pytest.raises(SceneError, match="parameter is 'dampin'; did you mean 'damping'"):
        ns.asymptotic_variance_sensitivity(FRICTION, "dampin")
    with pytest.raises(ToleranceError, match=r"the derivative -0\.1563") as refused:
        ns.asymptotic_variance_sensitivity(FRICTION, "damping", tol=1e-15)
    assert refused.value.result.error < 1e-9


def test_a_derivative_along_paths_has_none():
    """Gamma^2 is 0 for g = y between walls, whatever the parameters."""
    scene = ns.Scene("obstacle", potential="x**2/2", observable="y")
    assert ns.asymptotic_variance_sensitivity(scene, "damping").value == 0
