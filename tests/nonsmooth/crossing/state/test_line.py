"""First passage of one variable: closed forms, limits, and errors that hold."""

import mpmath
import numpy as np
import pytest
from scipy import special

import nonsmooth as ns
from nonsmooth.errors import ToleranceError

LINEAR = ns.Scene("elasto_plastic")  # without a potential y is an Ornstein-Uhlenbeck process


def mode(rate, y):
    """Even eigenfunction of the Ornstein-Uhlenbeck generator."""
    return mpmath.hyp1f1(-rate / 2, mpmath.mpf(1) / 2, y * y)


def part(rate, b, t):
    """Return what an eigenfunction that vanishes at b adds to the survival probability from 0."""
    mass = mpmath.quad(lambda y: mode(rate, y) * mpmath.exp(-y * y), [0, b])
    norm = mpmath.quad(lambda y: mode(rate, y) ** 2 * mpmath.exp(-y * y), [0, b])
    return mass / norm * mpmath.exp(-rate * t)


def killed_ornstein_uhlenbeck(b, t):
    """P(max |Y| >= b up to t) of dY = -Y dt + dW from 0, by Kummer functions to 30 digits."""
    with mpmath.workdps(30):
        samples = [mpmath.mpf(k) / 5 for k in range(1, 900)]
        ends = [mode(rate, b) for rate in samples]
        rates = [
            mpmath.findroot(lambda r: mode(r, b), (left, right), solver="anderson")
            for left, right, before, after in zip(
                samples, samples[1:], ends, ends[1:], strict=False
            )
            if before * after < 0
        ]
        return float(1 - sum(part(rate, b, t) for rate in rates))


def test_ornstein_uhlenbeck():
    """The eigenvalues are the zeros of a Kummer function; the stated error holds, and is small."""
    times = [0.3, 1.0, 10.0]
    run = ns.state_crossing_probability(LINEAR, "y", 1.0, times)
    assert run.attrs["method"] == "deterministic"
    exact = [killed_ornstein_uhlenbeck(1, t) for t in times]
    assert np.all(np.abs(run["probability"] - exact) <= run["probability_error"])
    assert np.all(run["probability_error"] <= 1e-8)


def test_ornstein_uhlenbeck_to_its_mean():
    """From y_0 to 0 in t: erfc(y_0 / sqrt(exp(2 t) - 1)), by the reflection principle.

    The level 1e-9 stands for 0; it changes the probability by about 1e-9 times its slope, below 1.
    """
    scene = ns.Scene("elasto_plastic", start={"y": 0.8})
    times = np.array([0.1, 1.0, 4.0])
    run = ns.state_crossing_probability(scene, "y", (-1e-9, np.inf), times)
    exact = special.erfc(0.8 / np.sqrt(np.expm1(2 * times)))
    assert np.all(np.abs(run["probability"] - exact) <= run["probability_error"] + 1e-8)


@pytest.mark.parametrize("n", [np.inf, 1e6])
def test_dry_friction_to_rest(n):
    """Until it rests, dry friction with a tiny damping is Brownian motion with the drift -1.

    The first passage of a distance d is inverse Gaussian. Damping of 1e-6 changes the drift by 1e-6
    of the velocity, below 1e-5 up to t = 3.
    """
    d, times = 0.7, np.array([0.2, 1.0, 3.0])
    scene = ns.Scene("friction", n=n, damping=1e-6, start={"y": d})
    run = ns.state_crossing_probability(scene, "y", (-1e-9, 30.0), times, tol=1e-6)
    exact = special.ndtr((times - d) / np.sqrt(times)) + np.exp(2 * d) * special.ndtr(
        -(times + d) / np.sqrt(times)
    )
    assert np.max(np.abs(run["probability"] - exact)) < 2e-5


def test_colored_noise_itself():
    """The eta of a Langevin noise with sigma and rate is y of a linear scene in other units."""
    noise = ns.OrnsteinUhlenbeck(theta=2.0, sigma=0.7)
    scene = ns.Scene("friction", noise)
    run = ns.state_crossing_probability(scene, "eta", (-0.4, 0.9), [0.5, 5.0])
    unit = 0.7 / np.sqrt(2)
    same = ns.state_crossing_probability(LINEAR, "y", (-0.4 / unit, 0.9 / unit), [1.0, 10.0])
    error = run["probability_error"].values + same["probability_error"].values
    assert np.all(np.abs(run["probability"].values - same["probability"].values) <= error)


@pytest.mark.parametrize("k", range(8))
def test_error_holds_on_random_scenes(k):
    """A loose tolerance states an error that contains the value of a tight one."""
    rng = np.random.default_rng(k)
    lower, upper = -(10 ** rng.uniform(-1, 0.6)), 10 ** rng.uniform(-1, 0.6)
    scene = ns.Scene(
        "friction",
        n=rng.choice([2, 100, 1e4, np.inf]),
        damping=10 ** rng.uniform(-1, 1),
        start={"y": rng.uniform(lower, upper) * 0.9},
    )
    levels = (-np.inf, upper) if k % 3 == 0 else (lower, upper)
    loose, tight = (
        ns.state_crossing_probability(scene, "y", levels, np.geomspace(0.01, 100, 9), tol=tol)
        for tol in (1e-4, 1e-7)
    )
    gap = np.abs(loose["probability"] - tight["probability"])
    assert np.all(gap <= loose["probability_error"] + tight["probability_error"])


def test_a_level_far_in_the_tails_needs_no_elements():
    """A stiff spring of y keeps it from 1: the probability is 0, and soon known."""
    scene = ns.Scene("elasto_plastic", damping=1e6)
    found = ns.state_crossing_probability(scene, "y", 1.0, [1.0, 10.0], tol=1e-6)
    assert np.all(found["probability"] <= found["probability_error"])


@pytest.mark.parametrize("k", range(20))
def test_levels_that_are_never_reached(k):
    """At 12 to 60 standard deviations W < 1e-28: all that is found is rounding, and stated."""
    rng = np.random.default_rng(1000 + k)
    damping, sigma = 10 ** rng.uniform(-4, 9), 10 ** rng.uniform(-3, 3)
    scene = ns.Scene("elasto_plastic", damping=damping, noise=ns.White(sigma))
    level = rng.uniform(12, 60) * sigma / np.sqrt(2 * damping)
    times = np.sort(10 ** rng.uniform(-2, 3, 3)) / damping
    found = ns.state_crossing_probability(scene, "y", level, times, method="deterministic")
    assert np.all(found["probability"] <= found["probability_error"])


def test_a_potential_that_elements_do_not_resolve_is_refused():
    """In one line, before matrices are made."""
    noise = ns.Langevin("eta**4/4 - 100*eta**2/2", 0.1)
    scene = ns.Scene("friction", noise=noise)
    with pytest.raises(ns.NonsmoothError, match="use method='monte_carlo'"):
        ns.state_crossing_probability(scene, "eta", 20.0, [1.0], method="deterministic")


def test_starts_where_the_potential_rounds():
    """Refused at once by the solver, and answered by paths."""
    scene = LINEAR.with_start({"y": 1e9})
    with pytest.raises(ToleranceError, match="too far in the tails"):
        ns.state_crossing_probability(scene, "y", 2e9, [1.0], method="deterministic")
    found = ns.state_crossing_probability(scene, "y", 2e9, [1.0], tol=1e-2)
    assert found.attrs["method"] == "monte_carlo"
    assert found.probability[0] == 0
