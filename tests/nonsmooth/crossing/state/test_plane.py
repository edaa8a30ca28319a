"""First passage of two variables, against the kinetic equation, one variable and Monte Carlo."""

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from references import FALSE_ALARM, FRICTION, OBSTACLE, PLASTIC

HORIZONS = np.array([1.0, 3.0, 10.0])


def solved(scene, variable, levels, tol):
    """Solve for the probabilities."""
    return ns.state_crossing_probability(
        scene, variable, levels, HORIZONS, method="deterministic", tol=tol
    )


@pytest.mark.slow
def test_displacement_is_the_integral_of_the_velocity():
    """Without a potential x = int y, whose crossings are solved in quite another way.

    The kinetic equation is right to 1e-7.
    """
    exact = ns.crossing_probability(FRICTION, 0.5, HORIZONS, method="deterministic")["probability"]
    run = solved(FRICTION, "x", 0.5, 1e-3)
    assert np.all(np.abs(run["probability"] - exact) <= run["probability_error"])
    assert np.all(run["probability_error"] <= 1e-3)


@pytest.mark.slow
def test_velocity_does_not_see_a_weak_spring():
    """With U = 1e-6 x^2 / 2 the velocity is that of one variable, up to 1e-6 of the distance x."""
    weak = ns.Scene("elasto_plastic", n=20, potential="5e-7*x**2")
    exact = ns.state_crossing_probability(ns.Scene("elasto_plastic"), "y", 1.2, HORIZONS)
    run = solved(weak, "y", 1.2, 1e-3)
    gap = np.abs(run["probability"] - exact["probability"])
    assert np.all(gap <= run["probability_error"] + 1e-5)


@pytest.mark.parametrize(("damping", "sigma", "level"), [(2.0, 1.0, 3.0), (2.75, 0.8, 2.03)])
def test_far_levels_stay_where_they_are(damping, sigma, level):
    """Levels farther out than the grid must otherwise reach: an Ornstein-Uhlenbeck velocity.

    Moved inwards to where the density is exp(-13), the level was crossed a hundred times as often.
    """
    parameters = {"noise": ns.White(sigma), "damping": damping}
    levels = (-np.inf, level)
    exact = ns.state_crossing_probability(
        ns.Scene("elasto_plastic", **parameters), "y", levels, HORIZONS
    )
    weak = ns.Scene("elasto_plastic", n=20, potential="5e-7*x**2", **parameters)
    run = solved(weak, "y", levels, 1e-3)
    assert np.all(np.abs(run["probability"] - exact["probability"]) <= run["probability_error"])


@pytest.mark.parametrize(
    ("scene", "variable", "levels"),
    [
        pytest.param(PLASTIC.with_n(20), "y", 1.2, marks=pytest.mark.slow),
        (PLASTIC.with_n(20), "x", 0.7),
        pytest.param(OBSTACLE.with_n(np.inf), "x", 1.0, marks=pytest.mark.slow),
        pytest.param(OBSTACLE, "y", (-np.inf, 1.3), marks=pytest.mark.slow),
        pytest.param(ns.Scene("friction", "langevin", n=5), "y", 0.3, marks=pytest.mark.slow),
        (ns.Scene("friction", ns.KanaiTajimi(2.0, 0.5)), "eta", (-0.6, 0.9)),
    ],
)
def test_paths(scene, variable, levels):
    """Counted paths agree, within their errors and those that are stated."""
    run = solved(scene, variable, levels, 1e-2)
    counted = ns.state_crossing_probability(
        scene, variable, levels, HORIZONS, paths=50_000, step=0.02, seed=3
    )
    sure = stats.norm.isf(FALSE_ALARM / 2 / len(HORIZONS))
    allowed = run["probability_error"] + np.abs(counted["step_bias"])
    allowed += sure * np.hypot(counted["standard_error"], counted["step_bias_error"])
    assert np.all(np.abs(run["probability"] - counted["probability"]) <= allowed)


def test_loose_tolerances_cost_paths_only():
    """What is asked loosely is counted, which takes a second."""
    run = ns.state_crossing_probability(PLASTIC, "x", 0.7, HORIZONS, tol=1e-2)
    assert run.attrs["method"] == "monte_carlo"


@pytest.mark.slow
def test_tight_tolerance():
    """3e-5 is met, and the loose answer's error contains the tight one."""
    loose, tight = (solved(PLASTIC.with_n(5), "x", 0.7, tol) for tol in (1e-3, 3e-5))
    gap = np.abs(loose["probability"] - tight["probability"])
    assert np.all(gap <= loose["probability_error"])


@pytest.mark.slow
def test_early_fronts_are_followed():
    """At early times a front leaves the level; 1e-4 is met, and paths agree."""
    scene = ns.Scene("friction", n=3.5, damping=0.1, potential="0.7*x**2/2")
    question = scene, "x", (-np.inf, 1.0), [0.4, 3.0, 4.5]
    run = ns.state_crossing_probability(*question, method="deterministic", tol=1e-4)
    counted = ns.state_crossing_probability(*question, step=0.02, paths=100_000, seed=5)
    sure = stats.norm.isf(FALSE_ALARM / 2 / len(question[-1]))
    allowed = run["probability_error"] + np.abs(counted["step_bias"])
    allowed += sure * np.hypot(counted["standard_error"], counted["step_bias_error"])
    assert np.all(np.abs(run["probability"] - counted["probability"]) <= allowed)
    assert np.all(run["probability_error"] <= 1e-4)
