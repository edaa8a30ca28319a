"""The stationary mean of g: symmetry, closed forms, identities, Monte Carlo."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import nonsmooth as ns
from exact_gamma2 import random_linear
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.statistics.mean import exact_mean, mean_on_grids
from references import OBSTACLE


def test_zero_by_symmetry_and_along_paths():
    """Odd g and drift; and y cos x, the derivative of sin x."""
    assert ns.mean(OBSTACLE) == ns.Estimate(0.0, 0.0, "symmetry", 0.0)
    found = ns.mean(ns.Scene("friction", potential="x**2/2 + x", observable="y*cos(x)"))
    assert (found.value, found.error) == (0.0, 0.0)


@pytest.mark.parametrize("method", [None, "deterministic", "monte_carlo"])
def test_constants(method):
    """Exactly themselves, by every method."""
    assert ns.mean(ns.Scene("friction", observable="2 + y - y"), method=method).value == 2.0


def test_one_variable():
    """E y^2 of friction by quadrature."""
    scene = ns.Scene("friction", n=math.inf, observable="y**2")
    weight = [
        quad(lambda y, k=k: y**k * math.exp(-(y**2) - 2 * y), 0, 20, epsabs=0, epsrel=1e-13)[0]
        for k in (0, 2)
    ]
    found = ns.mean(scene)
    assert abs(found.value - weight[1] / weight[0]) <= found.error + 1e-12


@pytest.mark.parametrize("seed", range(3))
def test_obstacles_with_white_noise(seed):
    """The Gibbs measure: E [x^2 + a x + y^2] by quadrature, for lopsided potentials."""
    rng = np.random.default_rng(seed)
    n, damping, a = 10 ** rng.uniform(0, 4), rng.uniform(0.3, 3), rng.uniform(-1, 1)
    scene = ns.Scene(
        "obstacle", "white", n, damping, f"x**2/2 + {a}*x", f"x**2 + {a}*x + y**2 + 0.1"
    )

    def weight(x):
        energy = x**2 / 2 + a * x + n / 2 * max(abs(x) - 1, 0) ** 2
        return math.exp(-2 * damping * energy)

    total, part = (
        sum(
            quad(lambda x, f=f: f(x) * weight(x), *ends, epsabs=0, epsrel=1e-12)[0]
            for ends in ((-9, -1), (-1, 0), (0, 1), (1, 9))
        )
        for f in (lambda x: 1.0, lambda x: x**2 + a * x)
    )
    exact = part / total + 1 / (2 * damping) + 0.1
    found = ns.mean(scene)
    assert abs(found.value - exact) <= found.error < 1e-5
    loose = ns.mean(scene, tol=1e-2)
    assert abs(loose.value - exact) <= loose.error <= 1e-2


@pytest.mark.parametrize("g", ["tanh(exp(exp(exp(y))))", "exp(-exp(exp(exp(y))))"])
def test_what_no_number_of_digits_holds_is_refused(g):
    """Between its parts a formula may exceed all numbers."""
    scene = ns.Scene("friction", observable=g)
    for ask in (ns.mean, ns.asymptotic_variance):
        with pytest.raises(ns.NonsmoothError, match="too steep to be evaluated with 40 digits"):
            ask(scene)


def test_rigid_obstacles():
    """Between rigid walls without a potential x is uniform: E x^2 = 1/3."""
    found = ns.mean(ns.Scene("obstacle", n=math.inf, observable="x**2"), tol=1e-4)
    assert abs(found.value - 1 / 3) <= found.error <= 1e-4


@pytest.mark.parametrize("noise", ["white", pytest.param("langevin", marks=pytest.mark.slow)])
def test_linear_scenes(noise):
    """d(x y)/dt = y^2 + x y' and E[x y] = 0, so that E[y^2 + x (N - U')] = 0."""
    parameters = random_linear(np.random.default_rng(7), noise)
    slope = parameters["potential"].replace("x**2/2", "x")
    forcing = "eta" if noise == "langevin" else "0"
    scene = ns.Scene(**parameters, observable=f"y**2 + x*({forcing} - {slope})")
    value, error = mean_on_grids(scene, 1e-3)
    assert abs(value) <= error <= 1e-3


def test_the_derivative_of_the_energy_of_a_driven_velocity():
    """E[y y'] = 0 for friction with colored noise, noticed by its formula and found on grids."""
    scene = ns.Scene("friction", "langevin", observable="y*(eta - y - max(-1, min(1, 100*y)))")
    value, error = mean_on_grids(scene)
    assert abs(value) <= error < 1e-6
    assert exact_mean(scene) is None or exact_mean(scene).value == 0


def test_monte_carlo_agrees():
    """Within five standard errors and the error of the grids."""
    scene = ns.Scene("elasto_plastic", potential="x**2/2 + x/2", observable="x")
    solved = ns.mean(scene)
    for tol in (None, 2e-3):
        sampled = ns.mean(scene, tol, "monte_carlo", seed=2)
        assert abs(sampled.value - solved.value) <= 5 * sampled.error + solved.error
        assert sampled.method == "Monte Carlo"
    assert 3 * sampled.error < 4e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "noise"), [("obstacle", "langevin"), ("friction", "hamiltonian")]
)
def test_three_variables_agree_with_monte_carlo(model, noise):
    """Within five standard errors and the error of the grids."""
    scene = ns.Scene(model, noise, potential="x**2/2 + x/2", observable="y**2 + x")
    if model == "friction":
        scene = ns.Scene(model, noise, n=5, observable="y**2")
    solved, sampled = ns.mean(scene), ns.mean(scene, method="monte_carlo")
    assert abs(sampled.value - solved.value) <= 5 * sampled.error + solved.error


def test_what_is_out_of_reach_is_refused_with_what_is_known():
    """On grids and by Monte Carlo."""
    scene = ns.Scene("elasto_plastic", potential="x**2/2 + x/2", observable="x")
    best = ns.mean(scene)
    with pytest.raises(ToleranceError, match="E g = ") as refused:
        ns.mean(scene, tol=1e-9, method="monte_carlo")
    found = refused.value.result
    assert abs(found.value - best.value) <= 5 * found.error + best.error


def test_a_small_mean_is_seen():
    """At p = 10^4 a drift of a thousandth moves int g past the threshold."""
    scene = ns.Scene("obstacle", observable="x - 0.001")
    assert abs(ns.mean(scene).value + 0.001) <= 1e-11
    with pytest.raises(SceneError, match=r"has the mean -0\.001; subtract"):
        ns.crossing_probability(scene, 0.6, [1.0], 1e4, method="asymptotic")


def test_of_the_noise_alone():
    """The solvers refuse it, Monte Carlo does not: E eta^2 = 1/2."""
    scene = ns.Scene("friction", "langevin", observable="eta**2")
    with pytest.raises(SceneError, match="noise alone"):
        ns.mean(scene, method="deterministic")
    found = ns.mean(scene)
    assert abs(found.value - 0.5) <= 5 * found.error
