"""Hazard rates: the logarithmic derivative of the survival probability."""

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import SceneError
from references import FALSE_ALARM, FRICTION, GAMMA2


@pytest.mark.parametrize("threshold", [0.6, (-0.3, 0.9), (-np.inf, 0.6)])
def test_at_large_p_it_is_that_of_brownian_motion(threshold):
    """The density over the survival of W_star, closed forms, from early to late times."""
    upper, lower = (threshold, None) if threshold == 0.6 else (threshold[1], threshold[0])
    horizons = np.array([0.3, 1.0, 3.0, 10.0])
    found = ns.hazard_rate(FRICTION, threshold, horizons, p=1e12, method="asymptotic")
    clock = GAMMA2 * horizons
    density = GAMMA2 * ns.brownian_first_passage_density(upper, clock, lower)
    exact = density / ns.brownian_survival(upper, clock, lower)
    assert np.all(np.abs(found["hazard_rate"] - exact) <= found["hazard_rate_error"])
    assert np.all(np.abs(found["hazard_rate"] - exact) < 1e-4 * exact.max())
    assert np.all(found["hazard_rate_error"] < 0.01 * exact.max())


@pytest.mark.slow
def test_solved_hazard_integrates_to_log_survival_and_ends_at_the_leading_rate():
    """Log S by Simpson's rule over T; late, h is constant, the rate at which S decays."""
    horizons = np.linspace(4, 12, 9)
    found = ns.hazard_rate(FRICTION, 0.6, horizons, method="deterministic")
    run = ns.crossing_probability(FRICTION, 0.6, horizons, method="deterministic")
    weights = np.array([1, 4, 2, 4, 2, 4, 2, 4, 1]) / 3
    integral = float(weights @ found["hazard_rate"].values)
    exact = float(np.log(run["survival"][0] / run["survival"][-1]))
    # Simpson's rule: h settles within some times of its rate
    assert abs(integral - exact) < 1e-4 + float(weights @ found["hazard_rate_error"].values)
    late = ns.hazard_rate(FRICTION, 0.6, [30.0, 40.0], method="deterministic")["hazard_rate"]
    ends = ns.crossing_probability(FRICTION, 0.6, [30.0, 40.0], method="deterministic")["survival"]
    assert float(late[0]) == pytest.approx(float(np.log(ends[0] / ends[1]) / 10), rel=1e-4)
    assert np.all(found["hazard_rate_error"] < 1e-4)


@pytest.mark.slow
def test_sampled_hazard_agrees_with_the_corrected_formula():
    """Counts within a fifth of T, at p = 1000, where the formula is known to 1e-6."""
    horizons = [0.5, 1.0, 2.0, 8.0]
    asked = {"horizons": horizons, "p": 1000.0}
    sampled = ns.hazard_rate(FRICTION, 0.6, **asked, method="monte_carlo", paths=20_000, step=0.1)
    exact = ns.hazard_rate(FRICTION, 0.6, **asked, method="corrected", order=3)
    distance = np.abs(sampled["hazard_rate"] - exact["hazard_rate"])
    quantile = stats.norm.isf(FALSE_ALARM / 2 / len(horizons))
    assert np.all(distance <= quantile * sampled["hazard_rate_error"] + exact["hazard_rate_error"])
    assert np.all(sampled["hazard_rate_error"] < 0.5 * exact["hazard_rate"])  # no empty bound
    assert np.all(sampled["lower"] <= sampled["hazard_rate"])
    assert np.all(sampled["hazard_rate"] <= sampled["upper"])


def test_where_nothing_is_left_nothing_is_known():
    """All paths have crossed long before: the error is infinite, and no number is made up."""
    found = ns.hazard_rate(FRICTION, 0.05, [500.0], method="monte_carlo", paths=200, step=0.1)
    assert np.isinf(found["hazard_rate_error"][0])
    assert float(found["lower"][0]) == 0
    assert np.isinf(found["upper"][0])


def test_bad_requests_are_refused():
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match="threshold > 0"):
        ns.hazard_rate(FRICTION, 0.0, [1.0])
    with pytest.raises(SceneError, match="numbers that increase"):
        ns.hazard_rate(FRICTION, 0.6, [2.0, 1.0])


def test_a_jump_of_the_probability_is_within_the_error():
    """While it slides, the friction force is 1: a third of the paths arrive at 0.7 together.

    Before that the rate is 0. After it W of paths that are counted at close times gives 1.95 at
    0.72 and 1.37 at 0.75, which is good to a tenth.
    """
    scene = ns.Scene("friction", observable="friction_force", start={"y": 1.0})
    found = ns.hazard_rate(scene, 0.7, [0.65, 0.72, 0.75], method="monte_carlo", tol=1e-2)
    for known, lower, upper in zip((0.0, 1.95, 1.37), found.lower, found.upper, strict=True):
        assert lower <= 1.1 * known
        assert 0.9 * known <= upper < 30
