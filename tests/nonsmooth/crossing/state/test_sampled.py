"""Crossings of the state by Monte Carlo, against solved probabilities and other questions."""

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from references import FALSE_ALARM, FRICTION, OBSTACLE

HORIZONS = np.array([1.0, 3.0, 10.0])
SURE = stats.norm.isf(FALSE_ALARM / 2 / len(HORIZONS))


def off(run, exact):
    """Distance to the exact values, less the bias, in standard errors of both."""
    error = np.hypot(run["standard_error"], SURE / 3 * run["step_bias_error"])
    return (np.abs(run["probability"] - exact) - np.abs(run["step_bias"])) / error


@pytest.mark.parametrize(
    ("scene", "levels"),
    [
        (ns.Scene("elasto_plastic"), 1.0),
        (FRICTION, 0.7),
        (FRICTION, (-np.inf, 0.5)),
        (ns.Scene("friction", n=np.inf, damping=0.3, start={"y": 0.5}), (-0.2, 1.5)),
    ],
)
def test_velocity(scene, levels):
    """Bridges count the crossings within steps: the solved probabilities are met.

    Seen at the ends of steps only, a level would be 0.58 sigma sqrt(h) = 0.13 farther away, which
    takes a tenth from the probabilities; what is left is a tenth of that, at most.
    """
    exact = ns.state_crossing_probability(scene, "y", levels, HORIZONS)["probability"]
    run = ns.state_crossing_probability(
        scene, "y", levels, HORIZONS, paths=100_000, step=0.05, seed=1
    )
    assert np.max(off(run, exact)) < SURE
    assert np.max(np.abs(run["step_bias"])) < 1e-2


def test_displacement_is_the_integral_of_the_velocity():
    """Without a potential x = int y, whose crossings are solved by the kinetic equation."""
    exact = ns.crossing_probability(FRICTION, 0.5, HORIZONS, method="deterministic")["probability"]
    run = ns.state_crossing_probability(FRICTION, "x", 0.5, HORIZONS, paths=100_000, step=0.02)
    assert np.max(off(run, exact)) < SURE


def test_tolerance_is_met():
    """|error| <= tol at every horizon; a false alarm in 100 runs."""
    exact = ns.state_crossing_probability(FRICTION, "y", 0.7, HORIZONS)["probability"]
    for tol in (3e-2, 1e-2, 3e-3):
        run = ns.state_crossing_probability(
            FRICTION, "y", 0.7, HORIZONS, method="monte_carlo", tol=tol
        )
        assert np.max(np.abs(run["probability"] - exact)) < tol


def test_free_motion_of_a_linear_oscillator():
    """The bias of a smooth variable falls with the step; what is stated contains it.

    An excursion between steps is missed, so that too few cross, by more with longer steps.
    """
    runs = [
        ns.state_crossing_probability(OBSTACLE, "x", 1, [5.0], paths=50_000, step=step, seed=2)
        for step in (0.1, 0.0125)
    ]
    gap = float(runs[0]["probability"][0] - runs[1]["probability"][0])
    spread = SURE * np.hypot(*(float(run["standard_error"][0]) for run in runs))
    assert abs(gap) < spread + abs(float(runs[0]["step_bias"][0])) + 2e-3
    assert abs(runs[1]["step_bias"][0]) < abs(runs[0]["step_bias"][0])


def test_same_seed_same_bits():
    """On any number of threads."""
    runs = [
        ns.state_crossing_probability(
            FRICTION, "y", 1, HORIZONS, paths=3500, step=0.1, seed=7, threads=threads
        )
        for threads in (1, 2)
    ]
    assert runs[0].equals(runs[1])


def test_many_variables():
    """Four variables: earthquake noise and yield; crossings are fewer for higher levels."""
    scene = ns.Scene("elasto_plastic", "hamiltonian", potential="x**2/2")
    runs = [ns.state_crossing_probability(scene, "x", b, [5.0], tol=2e-2) for b in (0.5, 0.9)]
    assert 0 < runs[1]["probability"][0] < runs[0]["probability"][0] < 1
