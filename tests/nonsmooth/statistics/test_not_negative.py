"""gamma^2 and v are never negative, and where they are 0 the stated error holds."""

import re

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError


@pytest.mark.parametrize("model", ["friction", "elasto_plastic", "obstacle"])
@pytest.mark.parametrize("method", [None, "deterministic", "monte_carlo"])
def test_a_constant_has_no_variance(model, method):
    """Exactly, whatever the formula is before it is simplified."""
    scene = ns.Scene(model, observable="2 + y - y")
    found = ns.asymptotic_variance(scene, method=method)
    assert (found.value, found.error) == (0.0, 0.0)
    moments = ns.variance(scene, [0.1, 3.0], method=method)
    assert not any(np.any(moments[name]) for name in ("w", "w_error", "v", "v_error"))


COBOUNDARIES = [
    ("obstacle", "{a}*y", "x**2/2"),
    ("obstacle", "{a}*x*y", "x**2/2 + 0.3*cos(3*x)"),
    ("obstacle", "y/(1 + {a}*x**2)", "x**2/2"),
    ("friction", "{a}*y", "{a}*x**2/2"),
]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("model", "g", "U"), COBOUNDARIES)
def test_derivatives_of_bounded_functions_are_refused(seed, model, g, U):
    """int_0^t g stays bounded, so that gamma^2 = 0; the best value is that within its error."""
    rng = np.random.default_rng(seed)
    a, n, damping = rng.uniform(0.5, 2), 10 ** rng.uniform(0, 3), rng.uniform(0.5, 2)
    g, U = (formula.format(a=round(a, 3)) for formula in (g, U))
    scene = ns.Scene(model, n=n, damping=damping, potential=U, observable=g)
    with pytest.raises(ToleranceError, match="stays bounded") as refused:
        ns.asymptotic_variance(scene, 1e-2, "deterministic")
    value, error = map(
        float, re.findall(r"gamma.2 = (\S+) has an error of ([^,]+),", str(refused.value))[0]
    )
    assert 0 <= value <= error < 1e-3


@pytest.mark.parametrize(
    ("damping", "sigma"), [(1.0, 1.0), (1e-3, 1.0), (1e3, 1.0), (1.0, 1e-3), (1.0, 1e3)]
)
def test_early_and_late_times_of_extreme_scenes(damping, sigma):
    """With its kink far away friction is an Ornstein-Uhlenbeck process, of which v is known."""
    scene = ns.Scene("friction", ns.White(sigma), n=1e-6, damping=damping)
    z = np.array([1e-12, 1e-9, 1e-6, 1e-4, 0.1, 1.0, 100.0])
    rate = damping + 1e-6
    found = ns.variance(scene, z / rate, tol=1e-8 * (sigma / rate) ** 2)
    exact = z - 2 * -np.expm1(-z) + -np.expm1(-2 * z) / 2
    early = z < 1e-3  # where the terms above cancel; the rest of the series is below 1e-8 of it
    exact[early] = (z**3 / 3 - z**4 / 4 + 7 * z**5 / 60)[early]
    exact *= sigma**2 / rate**3
    assert np.all(np.abs(found["v"] - exact) <= found["v_error"] + 1e-11 * exact)
    assert np.all(found["v"] >= 0)


@pytest.mark.slow
@pytest.mark.parametrize(("n", "damping"), [(1.0, 1e-3), (np.inf, 1.0)])
def test_strong_noise_rounds_more(n, damping):
    """Elements next to the kink are short against the velocity; v grows by gamma^2 per time."""
    scene = ns.Scene("friction", ns.White(1e3), n=n, damping=damping)
    gamma2 = ns.asymptotic_variance(scene, 1e-9)
    time = 60 / ns.spectral_gap(scene).value
    found = ns.variance(scene, [time, 2 * time], tol=gamma2.value)
    slope = float(found["v"][1] - found["v"][0]) / time
    assert abs(slope - gamma2.value) <= float(found["v_error"].sum()) / time + gamma2.error
