"""Moments and paths under an envelope, against linear oscillators, whose moments are integrals."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

import nonsmooth as ns
from nonsmooth.errors import SceneError
from references import FALSE_ALARM, FRICTION

TIMES = np.array([0.5, 1.5, 4.0])
SURE = stats.norm.isf(FALSE_ALARM / 2 / 20)
# friction is n y up to |y| = 1000: it adds n to the damping
DAMPED = ns.Scene("friction", n=1e-3, damping=0.799, start={"y": 1.5})
COLORED = ns.Scene("friction", ns.OrnsteinUhlenbeck(sigma=2.0), n=1e-3, damping=0.999)


def envelope(t):
    """Return `ENVELOPE` at a time."""
    return t * np.exp(1 - t) + 0.2


ENVELOPE = "t*exp(1 - t) + 0.2"


def variances(response, sigma):
    """Variance of the sum of the responses to the noise of all times before."""
    return np.array(
        [
            quad(lambda u, t=t: (sigma * envelope(u) * response(t - u)) ** 2, 0, t, epsabs=1e-12)[0]
            for t in TIMES
        ]
    )


CASES = [
    (DAMPED, 1.5 * (1 - np.exp(-0.8 * TIMES)) / 0.8, lambda r: (1 - np.exp(-0.8 * r)) / 0.8),
    (COLORED, 0 * TIMES, lambda r: 1 - (1 + r) * np.exp(-r)),
]


@pytest.mark.parametrize(("scene", "mean", "response"), CASES)
def test_moments_of_linear_oscillators(scene, mean, response):
    """Mean and variance of int g are off by the stated bias and the standard errors."""
    exact = {"mean": mean, "variance": variances(response, scene.noise.sigma)}
    run = ns.simulate(scene, 4.0, step=0.1, paths=60_000, times=TIMES, seed=3, envelope=ENVELOPE)
    for name, known in exact.items():
        spread = SURE * np.hypot(run[f"{name}_error"], run[f"{name}_bias_error"])
        # the order of the step is 2 up to a tenth of the bias
        assert np.all(np.abs(run[name] - run[f"{name}_bias"] - known) <= spread + 1e-4)
    assert np.all(np.abs(run["variance_bias"]) < 0.02 * exact["variance"])


def test_paths_of_a_linear_oscillator():
    """Velocity and int g have their variances; all begin at the start."""
    run = ns.simulate(
        DAMPED, 4.0, step=0.05, paths=20_000, times=TIMES, keep="paths", envelope=ENVELOPE
    )
    assert list(run.data_vars) == ["y", "delta"]
    assert np.all(run.isel(time=0)["y"] == 1.5)
    for name, response in (("y", lambda r: np.exp(-0.8 * r)), ("delta", CASES[0][2])):
        ratio = run[name].isel(time=slice(1, None)).var("path") / variances(response, 1.0)
        assert np.all(np.abs(ratio - 1) < SURE * np.sqrt(2 / 20_000) + 5e-3)


def test_a_tolerance_is_met():
    """Of `simulate`, relative, and of `variance`, per time; a false alarm in 100 runs."""
    exact = variances(CASES[0][2], 1.0)
    run = ns.simulate(DAMPED, 4.0, tol=0.03, times=TIMES, envelope=ENVELOPE)
    assert abs(float(run["variance"][-1]) - exact[-1]) < 0.03 * exact[-1]
    run = ns.variance(DAMPED, TIMES, 1e-2, envelope=ENVELOPE)
    assert run.attrs["method"] == "monte_carlo"
    assert np.all(np.abs(run["v"] - exact) < 1e-2 * TIMES)
    assert np.all(np.abs(run["w"] - CASES[0][1]) < 4 * run["w_error"])


def test_a_constant_envelope_is_another_intensity():
    """The solved variance of half the noise."""
    exact = ns.variance(ns.Scene("friction", ns.White(0.5)), TIMES)["v"]
    run = ns.variance(FRICTION, TIMES, 3e-3, envelope="0.5")
    assert np.all(np.abs(run["v"] - exact) < 3e-3 * TIMES)
    constant = ns.Scene("friction", observable="2")
    run = ns.variance(constant, TIMES, envelope="0.5")
    assert np.array_equal(run["w"], 2 * TIMES)
    assert not run["v"].any()


def test_refusals():
    """Solvers and schemes that do not take it, and what is no envelope."""
    rigid = FRICTION.with_n(np.inf)
    for ask, told in (
        (lambda: ns.variance(FRICTION, [1], method="deterministic", envelope="t"), "no parameter"),
        (lambda: ns.simulate(rigid, 1, scheme="dry_friction", envelope="t"), "no envelope"),
        (lambda: ns.simulate(FRICTION, 1, step=0.1, paths=9, envelope="-t"), "not negative"),
    ):
        with pytest.raises(SceneError, match=told):
            ask()
