"""A fourth mechanical model, of which the library knows nothing, is solved and simulated.

With white noise the invariant density is exp(-2 C_b (y^2/2 + U_n(x))/sigma^2) up to a factor, as
for the obstacle model. Here it is integrated without the library.
"""

import math
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy
from scipy.integrate import quad

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.generator import evaluate
from nonsmooth.paths.schemes.strang import STRANG
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.symbols import x, y

EXAMPLE = Path(__file__).parents[2] / "examples" / "dead_zone.py"
GAP, STIFFNESS, DAMPING, SIGMA = 0.7, 6.0, 0.8, 1.1


@pytest.fixture(scope="module")
def dead_zone():
    """Return the example's function."""
    return runpy.run_path(str(EXAMPLE), run_name="example")["dead_zone"]


@pytest.fixture(scope="module")
def scene(dead_zone):
    """Return a function that makes a scene of an observable."""
    own = dead_zone(GAP, STIFFNESS)
    return lambda observable, model=own: ns.Scene(
        model, ns.White(SIGMA), damping=DAMPING, observable=observable
    )


def variance_of_x():
    """E x^2 under the Gibbs density, by quadrature."""

    def weight(x):
        potential = STIFFNESS / 2 * max(x - GAP, 0.0) ** 2
        return math.exp(-2 * DAMPING * potential / SIGMA**2)

    def integral(f):
        return sum(quad(f, *ends, epsabs=1e-13)[0] for ends in ((0, GAP), (GAP, 8.0)))

    return integral(lambda x: x * x * weight(x)) / integral(weight)


VARIANCE = {"x": variance_of_x(), "y": SIGMA**2 / (2 * DAMPING)}


def test_the_library_does_not_know_the_model(scene):
    """It has no name there; as an object it has a state, a symmetry and streams of its own."""
    assert not any("dead" in name for name in MODELS)
    assert scene("x").state == ("y", "x")
    assert scene("spring_force").is_odd()
    assert scene("x").identity != ns.Scene("obstacle", observable="x").identity
    assert not scene("x").mechanics.confines_displacement


def test_a_registered_model_is_its_name():
    """A scene of the object is the scene of the name, with the same random streams."""
    by_name, by_object = ns.Scene("obstacle"), ns.Scene(MODELS["obstacle"])
    assert by_name == by_object
    assert by_name.identity == by_object.identity


def test_paths_have_the_gibbs_variances(scene):
    """E x^2 and E y^2 of independent paths, within 4.5 standard errors."""
    end = ns.simulate(scene("x"), 30.0, step=0.05, paths=20_000, times=[30.0], keep="paths")
    for name, exact in VARIANCE.items():
        squares = end[name].values[:, -1] ** 2
        error = np.std(squares) / math.sqrt(len(squares))
        # the bias of the splitting at this step is below 1e-3
        assert abs(np.mean(squares) - exact) <= 4.5 * error + 1e-3, name


def test_grids_have_the_gibbs_variances(scene):
    """E x^2 and E y^2 of the stationary solution on a grid."""
    grid = tensor_grid.fitted(scene("x"), tensor_grid.depth_for(1e-8), 3)
    axes, solve = tensor_grid.solver(scene("x"), grid)
    masses = solve.stationary(1e-10)
    for symbol in (x, y):
        found = masses @ evaluate(symbol**2, axes) / masses.sum()
        assert found == pytest.approx(VARIANCE[symbol.name], rel=1e-6), symbol


def test_forces_balance(scene):
    """gamma^2 of the spring's force is that of the noise, sigma^2: an identity without a method."""
    solved = ns.asymptotic_variance(scene("spring_force"), tol=1e-5, method="deterministic")
    assert solved.value == pytest.approx(SIGMA**2, rel=1e-5)
    assert solved.error <= 1e-5 * solved.value
    sampled = ns.asymptotic_variance(scene("spring_force"), tol=0.03, method="monte_carlo")
    assert abs(sampled.value - SIGMA**2) <= 1.5 * sampled.error


def test_grids_and_paths_agree(scene):
    """gamma^2 of x by both methods, within one and a half times the error of Monte Carlo."""
    solved = ns.asymptotic_variance(scene("x"), tol=1e-4, method="deterministic")
    sampled = ns.asymptotic_variance(scene("x"), tol=0.03, method="monte_carlo")
    assert abs(sampled.value - solved.value) <= 1.5 * sampled.error + solved.error


@pytest.mark.slow
def test_a_spring_without_exact_flow_is_simulated_by_euler_maruyama(scene, dead_zone):
    """A spring that acts within the gap too; E y^2 = sigma^2/(2 C_b) whatever the potential."""
    model = dead_zone(GAP, STIFFNESS)
    always = replace(
        model, name="stiffening", penalty=replace(model.penalty, inner=sympy.Integer(1))
    )
    stiffening = scene("x", always)
    assert STRANG.handles(scene("x"))
    assert not STRANG.handles(stiffening)
    end = ns.simulate(stiffening, 10.0, step=0.005, paths=8000, times=[10.0], keep="paths")
    squares = end["y"].values[:, -1] ** 2
    error = np.std(squares) / math.sqrt(len(squares))
    # the bias of the step, of order 1, is below 2 per cent
    assert abs(np.mean(squares) - VARIANCE["y"]) <= 4.5 * error + 0.02 * VARIANCE["y"]


def test_what_is_no_model_is_refused(dead_zone):
    """A penalty that reads the velocity and moves the displacement; a spring that gives way."""
    model = dead_zone()
    with pytest.raises(SceneError, match="choose"):
        replace(model, argument=model.equation, equation=model.argument)
    with pytest.raises(SceneError, match="outer > 0"):
        replace(model, penalty=replace(model.penalty, outer=sympy.Integer(0)))
