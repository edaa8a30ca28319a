"""Crossing, survival and first passage of Brownian motion against fifty digits."""

import mpmath
import numpy as np
import pytest
import xarray as xr

import nonsmooth as ns
from nonsmooth.crossing.brownian import asymptotic_crossing, brownian_exit, brownian_exit_density
from nonsmooth.errors import SceneError
from references import GAMMA2, W_STAR

FUNCTIONS = (ns.brownian_crossing, ns.brownian_survival, ns.brownian_first_passage_density)
ROUNDOFF = 2.0**-53
SMALLEST = mpmath.mpf(5e-324)  # 0 is for what is below every double
# Some units for the functions (erfcx at most nine), twice to thrice that for what is subtracted:
# a probability from 1 where the result is above 0.3, the bracket of images from the first one.
CONSTANT = 40
# An exponent z = pi^2/2 (T/L)/L carries two units for the rounded L = b - lower, two for the
# divisions, at most two for the constant and one for the product, and exp(-z) z times as many.
PER_EXPONENT = 8


def exact(b, T, lower):
    """Crossing, survival and density by whichever series converges fast, at fifty digits."""
    with mpmath.workdps(50):
        b, T, near = mpmath.mpf(b), mpmath.mpf(T), mpmath.mpf(min(b, -lower))
        r = mpmath.sqrt(2 * T)

        def rate(d):
            return d / mpmath.sqrt(2 * mpmath.pi * T**3) * mpmath.exp(-d * d / (2 * T))

        if np.isinf(lower) or mpmath.isinf(b):
            return mpmath.erfc(near / r), mpmath.erf(near / r), rate(near)
        width = b - mpmath.mpf(lower)
        z = mpmath.pi**2 * T / (2 * width**2)
        if z > 0.5:
            modes = [
                (n, mpmath.sin(n * mpmath.pi * near / width) * mpmath.exp(-n * n * z))
                for n in range(1, 2 * int(mpmath.sqrt(120 / z)) + 3, 2)
            ]
            survival = 4 / mpmath.pi * sum(mode / n for n, mode in modes)
            density = 2 * mpmath.pi / width**2 * sum(n * mode for n, mode in modes)
            return 1 - survival, survival, density
        # the difference to 1 of a survival of 1e-6 keeps 44 digits
        images = [
            ((-1) ** k, k * width + d)
            for k in range(3 + int(16 * r / width))
            for d in (near, width - near)
        ]
        crossing = sum(sign * mpmath.erfc(d / r) for sign, d in images)
        return crossing, 1 - crossing, sum(sign * rate(d) for sign, d in images)


def assert_exact(b, T, lower):
    """Compare all three functions at all places, to the error that their docstrings claim."""
    found = [function(b, T, lower) for function in FUNCTIONS]
    near, width = np.minimum(b, -lower), b - lower
    tail, decay = near**2 / (2 * T), np.pi**2 * T / (2 * width**2)
    for i in range(len(b)):
        truth = exact(b[i], T[i], lower[i])
        exponents = (tail[i], decay[i], tail[i] + decay[i])
        for function, value, true, exponent in zip(FUNCTIONS, found, truth, exponents, strict=True):
            message = f"{function.__name__}({b[i]!r}, {T[i]!r}, {lower[i]!r})"
            relative = (CONSTANT + PER_EXPONENT * exponent) * ROUNDOFF
            error = abs(mpmath.mpf(value[i]) - true)
            assert error <= relative * true + 4 * SMALLEST, message


def test_two_equal_levels_on_a_grid():
    """Relative accuracy for b and T from 1e-3 to 1e3, also where the series change, T = b^2."""
    b, T = (x.ravel() for x in np.meshgrid(np.logspace(-3, 3, 13), np.logspace(-3, 3, 13)))
    beside = np.array([0.3, 1.0, 7.0])
    b = np.concatenate([b, beside, beside, beside])
    T = np.concatenate([T, beside**2, np.nextafter(beside**2, 0), np.nextafter(beside**2, 99)])
    assert_exact(b, T, -b)


def test_unequal_and_single_levels_at_random():
    """Relative accuracy on [1e-3, 1e3]^3, 1e-12 from the start, and with one level only."""
    rng = np.random.default_rng(0)
    b, T, lower = 10 ** rng.uniform(-3, 3, (3, 2000))
    lower[:300] = np.inf
    b[300:450] = np.inf
    b[450:600] = 1e-12
    assert_exact(b, T, -lower)


def test_the_paper_s_series():
    """The probability is eq. (defFexplicit) as printed, where that converges well."""
    b, T, k = 0.7, 1.3, np.arange(20)
    terms = (-1.0) ** k / (2 * k + 1) * np.exp(-((2 * k + 1) ** 2) * np.pi**2 * T / (8 * b**2))
    assert float(ns.brownian_crossing(b, T)) == pytest.approx(
        1 - 4 / np.pi * terms.sum(), rel=1e-14
    )


def test_are_a_law_and_its_density():
    """W and 1 - W add up to 1, W increases from 0, and the density integrates to W."""
    T = np.linspace(0, 50, 2001)
    for lower in (None, -0.4, -np.inf):
        crossing, survival, density = (function(1.3, T, lower) for function in FUNCTIONS)
        assert (crossing[0], survival[0], density[0]) == (0, 1, 0)
        assert np.allclose(crossing + survival, 1, rtol=0, atol=2 * CONSTANT * ROUNDOFF)
        assert np.all(np.diff(crossing) >= -CONSTANT * ROUNDOFF)
        assert np.all(np.diff(survival) <= CONSTANT * ROUNDOFF)
        nodes, weights = np.polynomial.legendre.leggauss(60)
        later = ns.brownian_first_passage_density(1.3, 1 + nodes / 2, lower) @ weights / 2
        ends = ns.brownian_crossing(1.3, [0.5, 1.5], lower)
        assert later == pytest.approx(ends[1] - ends[0], rel=1e-12)
    assert np.all(np.diff(ns.brownian_crossing(np.linspace(0.2, 3, 50), 2.0)) < 0)


def test_broadcasts_and_mirrors():
    """Arguments broadcast, and -W crosses the mirrored levels with the same probability."""
    upper, T = np.array([[0.5], [np.inf]]), np.array([0.0, 0.1, 3.0])
    for function in FUNCTIONS:
        values = function(upper, T, lower=-2.0)
        assert values.shape == (2, 3)
        assert np.array_equal(values[0], function(2.0, T, lower=-0.5))
        assert np.array_equal(values[1], function(2.0, T, lower=-np.inf))
        assert function(np.inf, 1.0) == (function is ns.brownian_survival)


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ((0.0, 1.0), "b > 0"),
        ((1.0, 1.0, 0.5), "lower level < 0"),
        ((1.0, -1.0), "horizon T >= 0"),
        ((1.0, np.inf), "finite horizon"),
        ((np.nan, 1.0), "b is nan"),
        ((1.0, 5e-324), "T is 5e-324; give numbers of sizes"),
        (([1.0, 2.0], [1.0, 2.0, 3.0]), "shapes that broadcast"),
        ((np.ones((10**5, 1)), np.ones(10**5)), "make 10000000000 values"),
    ],
)
def test_levels_on_the_wrong_side_are_refused(arguments, cure):
    """The start must be between the levels; the message says so."""
    for function in FUNCTIONS:
        with pytest.raises(SceneError, match=cure):
            function(*arguments)


@pytest.mark.parametrize(
    ("b", "T"),
    [
        (xr.DataArray(0.5), [0.5, 1.0]),
        (xr.DataArray([0.5], dims="b"), [0.5, 1.0]),
        (xr.DataArray([0.5, 1.0], dims="b"), [[0.5], [1.0]]),
        (xr.DataArray([0.5, 1.0], dims="b"), xr.DataArray([0.5, 1.0, 2.0], dims="b")),
        (xr.DataArray([1.0], [("b", [1])]), xr.DataArray([1.0], [("b", [2])])),
    ],
)
def test_lists_that_do_not_fit_labelled_ones_are_refused(b, T):
    """A dimension has one size and one set of coordinates, and the result a name for each."""
    for function in FUNCTIONS:
        for lower in (None, -2.0):
            with pytest.raises(SceneError, match=r"do not fit together: .*with its name"):
                function(b, T, lower)


def test_labels_do_not_hide_what_is_wrong():
    """Texts in a labelled array are refused as they are in a plain one."""
    for function in FUNCTIONS:
        with pytest.raises(SceneError, match="give numbers"):
            function(xr.DataArray(["a"], dims="b"), 1.0)


def test_known_value():
    """The limit of figure 2b at T = 2."""
    gamma = np.sqrt(GAMMA2)
    assert float(ns.brownian_crossing(0.6 / gamma, 2.0)) == pytest.approx(W_STAR, abs=5e-8)


@pytest.mark.parametrize("threshold", [0.6, (-0.9, 0.6), (-np.inf, 0.6), (-0.9, np.inf)])
def test_error_of_the_limit_is_inherited_from_gamma(threshold):
    """First order: the change by gamma^2, T times the density; no more than all at gamma^2 = 0."""
    lower, upper = (-0.6, 0.6) if threshold == 0.6 else threshold
    T = np.array([0.5, 2.0])
    value, error = asymptotic_crossing(threshold, T, 0.14, 1e-6)
    gamma = np.sqrt(0.14)
    assert np.allclose(value, ns.brownian_crossing(upper / gamma, T, lower / gamma), rtol=1e-14)
    density = ns.brownian_first_passage_density(upper, 0.14 * T, lower)
    assert np.allclose(error, 1e-6 * T * density, rtol=1e-4)
    unknown = asymptotic_crossing(threshold, T, 0.14, 0.2)[1]
    assert np.all(np.isfinite(unknown))
    assert np.all(unknown >= value)


@pytest.mark.parametrize("lower", [-0.4, -1.3, -np.inf])
def test_exits_by_either_level_add_up(lower):
    """Exits by either level add up to the crossing; at T = inf they are the martingale's."""
    T = np.concatenate([[0.0], np.geomspace(1e-2, 1e3, 60)])
    above = brownian_exit(1.3, T, lower)
    below = brownian_exit(-lower, T, -1.3)
    assert np.allclose(above + below, ns.brownian_crossing(1.3, T, lower), rtol=0, atol=1e-14)
    assert np.all(np.diff(above) >= -1e-15)
    if np.isfinite(lower):
        assert above[-1] == pytest.approx(lower / (lower - 1.3), rel=1e-14)


@pytest.mark.parametrize(("b", "lower"), [(0.5, -0.7), (2.0, -0.1), (0.5, -np.inf)])
def test_exit_density(b, lower):
    """The density is the slope of the probability, on either side of T = L^2."""
    T = np.array([0.2, 1.0, 1.4, 4.5, 6.0])
    step = 1e-5 * T
    slope = (brownian_exit(b, T + step, lower) - brownian_exit(b, T - step, lower)) / (2 * step)
    assert brownian_exit_density(b, T, lower) == pytest.approx(slope, rel=1e-6, abs=1e-9)
