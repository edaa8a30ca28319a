"""Mean times to failure: the integral of the survival probability, by other ways."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from references import FRICTION, GAMMA2, KAPPA

SHIFTED = ns.Scene("friction", n=100, observable="y + 0.1*abs(y)")


@pytest.mark.parametrize(
    ("scene", "threshold"),
    [
        pytest.param(FRICTION, 0.6, marks=pytest.mark.slow),
        pytest.param(FRICTION, (-0.1, 1.5), marks=pytest.mark.slow),
        pytest.param(SHIFTED, (-0.3, 0.9), marks=pytest.mark.slow),
    ],
)
def test_mean_is_the_integral_of_survival(scene, threshold):
    """By a spline of S to where nothing is left, whose nodes are inverted to 1e-5."""
    times = np.concatenate([[1e-3], np.geomspace(0.05, 80, 100)])
    found = ns.mean_time_to_failure(scene, threshold)
    run = ns.crossing_probability(scene, threshold, times, method="deterministic", tol=1e-5)
    S = CubicSpline(times, run["survival"])
    last = float(run["survival"][-1])
    assert last < 1e-4
    rate = float(np.log(run["survival"][-10] / run["survival"][-1])) / (times[-1] - times[-10])
    # of the first thousandth nothing is lost; the errors of S; of the spline, less than 1e-4
    exact = times[0] + S.integrate(times[0], times[-1]) + last / rate
    allowed = np.trapezoid(run["survival_error"], times) + 1e-4
    assert abs(found.value - exact) < allowed + found.error
    assert found.error < 2e-6 * found.value


@pytest.mark.slow
def test_at_large_p_it_is_that_of_brownian_motion_between_moved_thresholds():
    """E tau = a b / gamma^2 for -a < 0 < b, here with kappa / sqrt(p) added to both; error 1/p."""
    for p in (1e2, 1e6):
        found = ns.mean_time_to_failure(FRICTION, (-0.3, 0.9), p=p)
        moved = (0.3 + KAPPA / np.sqrt(p)) * (0.9 + KAPPA / np.sqrt(p)) / GAMMA2
        # a dipole and the dispersion change the time by less than one relaxation time
        assert abs(found.value - moved) < 1 / p + found.error


def test_a_start_close_to_a_threshold():
    """The leading pole is far inside of the largest circle: rare paths take very long."""
    p = 1e6
    found = ns.mean_time_to_failure(FRICTION, (-0.01, 3.0), p=p, tol=0.02)
    moved = (0.01 + KAPPA / np.sqrt(p)) * (3.0 + KAPPA / np.sqrt(p)) / GAMMA2
    assert abs(found.value - moved) < 1 / p + found.error


def test_sampled_means_agree_with_solved_ones():
    """Within four stated errors, false alarms in 10^4 runs; one and two variables, both signs."""
    for scene, threshold, solved in (
        (FRICTION, 0.6, 6.0519465),
        (SHIFTED, (-0.3, 0.9), 5.4727),
        (ns.Scene("elasto_plastic", observable="plastic_strain_rate"), 0.6, 7.0392),
    ):
        found = ns.mean_time_to_failure(scene, threshold, method="monte_carlo", seed=4)
        assert abs(found.value - solved) < 4 * found.error
        assert found.error < 0.02 * solved


@pytest.mark.slow
def test_one_threshold_ahead_of_a_drift():
    """Wald: E int_0^tau g = E g E tau, and it is the level, or a little more than kappa beyond."""
    found = ns.mean_time_to_failure(SHIFTED, (-np.inf, 0.9), seed=1)
    drift = ns.mean(SHIFTED).value
    assert found.method == "monte_carlo"
    assert 0.9 / drift - 4 * found.error < found.value < (0.9 + 2 * KAPPA) / drift + 4 * found.error


@pytest.mark.slow
def test_two_variables_agree_with_the_integral_of_survival():
    """The transform at 0 against the inverted transform and steps in time, to 2e-3."""
    scene = ns.Scene("elasto_plastic", observable="plastic_strain_rate")
    found = ns.mean_time_to_failure(scene, 0.6)
    times = np.geomspace(6.5, 60, 30)
    run = ns.crossing_probability(scene, 0.6, times, method="deterministic", tol=1e-3)
    early = ns.crossing_probability(
        scene, 0.6, np.linspace(0.25, 6.5, 26), method="monte_carlo", tol=3e-3
    )
    S = np.concatenate([[1.0], early["probability"].values * -1 + 1])
    first = np.trapezoid(S, np.linspace(0, 6.5, 27))
    rest = CubicSpline(times, run["survival"]).integrate(times[0], times[-1])
    assert abs(found.value - first - rest) < found.error + 6.5 * 3e-3 + 60 * 2e-4


@pytest.mark.slow
def test_where_the_transform_fails_paths_answer():
    """Hardly damped, and a threshold that is crossed before elements resolve it: off by 70 %."""
    scene = ns.Scene(
        "obstacle", ns.White(0.62), n=96, damping=0.23, potential="x**2/4 + x**4/10", observable="x"
    )
    threshold = (-0.477, 0.475)
    with pytest.raises(ToleranceError):
        ns.mean_time_to_failure(scene, threshold, method="deterministic", tol=1e-3)
    found = ns.mean_time_to_failure(scene, threshold)
    assert found.method == "monte_carlo"
    assert found.error < 0.02 * found.value


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ({"threshold": (-np.inf, 0.6)}, r"E g = 0 does not point to it.*failure_time"),
        ({"threshold": 0.0}, "threshold > 0"),
        ({"threshold": 0.6, "method": "exact"}, "choose from deterministic, monte_carlo"),
        ({"threshold": 0.6, "method": "deterministic", "paths": 10}, "no step and no paths"),
        ({"threshold": 0.6, "tol": -1.0}, "tol is -1.0"),
    ],
)
def test_bad_requests_are_refused(arguments, cure):
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match=cure):
        ns.mean_time_to_failure(FRICTION, **arguments)


@pytest.mark.slow
def test_what_cannot_be_met_or_awaited_is_refused():
    """A tolerance below rounding, with the best value; a threshold that no path reaches."""
    with pytest.raises(ToleranceError, match="above tol") as refused:
        ns.mean_time_to_failure(FRICTION, 0.6, tol=1e-12)
    assert refused.value.result.value == pytest.approx(6.0519465, abs=1e-5)
    with pytest.raises(ToleranceError, match="have not crossed"):
        ns.mean_time_to_failure(FRICTION, 200.0, method="monte_carlo")
