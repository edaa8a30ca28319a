"""Crossings of the state by Monte Carlo, against solved probabilities and other questions."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import special, stats

import nonsmooth as ns
from nonsmooth.crossing.state import sampled
from nonsmooth.errors import SceneError
from nonsmooth.paths.absorption.survival import crossed
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


@pytest.mark.slow
def test_tolerance_is_met():
    """|error| <= tol at every horizon; a false alarm in 100 runs."""
    exact = ns.state_crossing_probability(FRICTION, "y", 0.7, HORIZONS)["probability"]
    for tol in (3e-2, 1e-2, 3e-3):
        run = ns.state_crossing_probability(
            FRICTION, "y", 0.7, HORIZONS, method="monte_carlo", tol=tol
        )
        assert np.max(np.abs(run["probability"] - exact)) < tol


def test_the_bias_of_a_long_step_does_not_decide(monkeypatch):
    """Stiff stops: the step falls by at most four at a time, and the tolerance is met.

    Taken for proportional to the step, the bias of the first one would ask for a tenth of it.
    """
    steps = []

    def counted(*arguments):
        steps.append(arguments[4].step)
        return crossed(*arguments)

    monkeypatch.setattr(sampled, "crossed", counted)
    scene = ns.Scene("obstacle", ns.White(0.6), damping=0.1, potential="x**2/2")
    loose, fine = (
        ns.state_crossing_probability(scene, "x", 1.375, [40.0], **options).isel(horizon=0)
        for options in ({"tol": 1.5e-2}, {"step": 0.0125, "paths": 20_000})
    )
    assert abs(loose["probability"] - fine["probability"]) < 1.5e-2 + fine["probability_error"]
    assert len(steps) > 2
    assert all(after >= before / 4 for before, after in pairwise(steps[:-1]))
    assert steps[-2] > steps[0] / 10


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


def test_constant_envelope_is_another_intensity():
    """S = 1/2 halves sigma: the solved probability is met; s = 1 changes no bit."""
    exact = ns.state_crossing_probability(
        ns.Scene("friction", ns.White(0.5)), "y", 0.4, HORIZONS, method="deterministic"
    )["probability"]
    run = ns.state_crossing_probability(
        FRICTION, "y", 0.4, HORIZONS, paths=100_000, step=0.02, envelope="0.5"
    )
    assert np.max(off(run, exact)) < SURE
    plain, same = (
        ns.state_crossing_probability(
            FRICTION, "y", 0.7, HORIZONS, paths=2000, step=0.1, envelope=envelope
        )
        for envelope in (None, "1")
    )
    assert plain.equals(same)


@pytest.mark.parametrize("k", [0.5, 2.0])
def test_growing_noise(k):
    """Hardly damped y from 0 is Brownian motion on the clock int s^2, also with a one-sided level.

    P(max y >= b) = erfc(b / sqrt(2 clock)), here s = t^k and the clock is t^(2k+1) / (2k+1); a
    damping of 1e-6 does not matter.
    """
    scene = ns.Scene("elasto_plastic", damping=1e-6)
    times = np.array([0.7, 1.0, 1.5])
    run = ns.state_crossing_probability(
        scene, "y", (-np.inf, 0.5), times, paths=100_000, step=0.02, envelope=f"t**{k}"
    )
    clock = times ** (2 * k + 1) / (2 * k + 1)
    assert np.max(off(run, special.erfc(0.5 / np.sqrt(2 * clock)))) < SURE


def test_envelope_is_sampled_only():
    """The solvers take stationary noise."""
    with pytest.raises(SceneError, match="no parameter 'envelope'"):
        ns.state_crossing_probability(
            FRICTION, "y", 1, HORIZONS, method="deterministic", envelope="t"
        )
