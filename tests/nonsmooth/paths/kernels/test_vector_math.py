"""The elementary functions are accurate where the flows use them."""

import numba
import numpy as np
import pytest

from nonsmooth.paths.kernels import instructions
from nonsmooth.paths.kernels import vector_math as e

CASES = {
    # in units in the last place of the result, or of 1 where that is what the flows need
    "decay": (e.decay, lambda x: np.exp(-x), np.linspace(0, 90, 400_001), 1.0, 1.0),
    "expm1": (e.expm1, np.expm1, -np.geomspace(1e-12, 90, 400_001), None, 2.0),
    "log": (e.log, np.log, np.geomspace(2.0**-32, 1 - 2.0**-24, 400_001), None, 1.5),
    "log1p": (e.log1p, np.log1p, np.geomspace(1e-12, 1e12, 400_001), None, 2.0),
    "sine": (lambda x: e.sincos(x)[0], np.sin, np.linspace(-9, 9, 400_001), 1.0, 2.0),
    "cosine": (lambda x: e.sincos(x)[1], np.cos, np.linspace(-9, 9, 400_001), 1.0, 2.0),
}


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("name", CASES)
def test_accuracy(name, precision):
    """The functions agree with those of numpy in double precision."""
    function, exact, x, unit, allowed = CASES[name]
    jitted = numba.njit(function) if name in ("sine", "cosine") else function

    @numba.njit
    def sweep(x, out):
        for i in range(len(x)):
            out[i] = jitted(x[i])

    x = x.astype(precision)
    out = np.empty_like(x)
    sweep(x, out)
    reference = exact(x.astype(np.longdouble))
    scale = np.spacing(np.asarray(np.abs(reference) if unit is None else unit, dtype=precision))
    assert np.max(np.abs(out - reference) / scale) <= allowed


# function, points, and whether errors are in units in the last place of 1 and not of the result
ELEMENTARY = {
    "exp": (np.exp, np.linspace(-86, 88.7, 400_001), False),
    "log": (np.log, np.geomspace(1.2e-38, 3e38, 400_001), False),
    "sin": (np.sin, np.linspace(-1e4, 1e4, 400_001), True),
    "cos": (np.cos, np.linspace(-1e4, 1e4, 400_001), True),
    "atan": (np.arctan, np.linspace(-50, 50, 400_001), False),
    "sinh": (np.sinh, np.linspace(-88, 88, 400_001), False),
    "cosh": (np.cosh, np.linspace(-88, 88, 400_001), False),
    "tanh": (np.tanh, np.linspace(-12, 12, 400_001), False),
}
LARGEST = {"float32": 88.72, "float64": 709.78}  # e^x is finite


def applied(name, x):
    """Apply a function of formulas in a loop."""
    function = e.ELEMENTARY[name]

    @numba.njit
    def sweep(x, out):
        for i in range(len(x)):
            out[i] = function(x[i])

    out = np.empty(len(x), x.dtype if x.dtype.kind == "f" else float)
    sweep(x, out)
    return out


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("name", e.ELEMENTARY)
def test_functions_of_formulas(name, precision):
    """They agree with those of numpy in extended precision, also close to 0 and to overflow."""
    exact, x, of_one = ELEMENTARY[name]
    small = np.concatenate([np.geomspace(1e-12, 0.01, 10_001), np.linspace(0.01, 3, 200_001)])
    large = np.linspace(0.99, 1, 1001) * LARGEST[precision]
    x = np.concatenate([x, small, large, [] if name == "log" else -small]).astype(precision)
    reference = exact(x.astype(np.longdouble))
    scale = np.spacing(np.asarray(1.0 if of_one else np.abs(reference), dtype=precision))
    # half a unit for each of at most eight operations after a polynomial that is a sum of its
    # largest term, half a unit off, and of far smaller ones
    assert np.max(np.abs(applied(name, x) - reference) / scale) <= 4.0


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("name", e.ELEMENTARY)
def test_functions_of_formulas_at_the_ends(name, precision):
    """What is no number stays none, and infinities and zeros are those of numpy."""
    ends = np.array([np.nan, -np.inf, np.inf, -1e30, 1e30, 0.0, -0.0], dtype=precision)
    found = applied(name, ends)
    assert np.isnan(found[0])
    with np.errstate(all="ignore"):
        wanted = ELEMENTARY[name][0](ends)
    if name in ("sin", "cos"):
        assert np.all(np.abs(found[3:]) <= 1)
        found[3:5] = wanted[3:5]
    assert np.allclose(found, wanted, equal_nan=True, rtol=4 * np.finfo(precision).eps, atol=0)
    if name in ("sinh", "tanh", "atan"):
        assert np.array_equal(np.signbit(found[5:]), np.signbit(wanted[5:]))


def test_functions_of_integers():
    """A formula may have cos(2)."""
    assert applied("cos", np.array([2]))[0] == pytest.approx(np.cos(2), rel=1e-15)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_angle(precision):
    """Arctan2 in the upper half plane, axes and origin included."""
    rng = np.random.default_rng(1)
    y, x = np.abs(rng.normal(size=10_000)), rng.normal(size=10_000)
    y[:100], x[100:200], x[200:300] = 0, 0, 1e-6
    y, x = y.astype(precision), x.astype(precision)

    @numba.njit
    def sweep(y, x, out):
        for i in range(len(x)):
            out[i] = e.arctan2(y[i], x[i])

    out = np.empty_like(x)
    sweep(y, x, out)
    exact = np.arctan2(y.astype(float), x.astype(float))
    assert np.max(np.abs(out - exact)) < 2 * np.spacing(np.dtype(precision).type(np.pi))


def test_extrema_and_choice():
    """Extrema and choices are right; outside of compiled code numpy is asked for."""

    @numba.njit
    def choose(x, y):
        return (
            instructions.maximum(x, y),
            instructions.minimum(x, y),
            instructions.where(x > y, x, y),
            instructions.fma(x, y, y),
        )

    assert choose(2.0, -3.0) == (2.0, -3.0, 2.0, -9.0)
    with pytest.raises(TypeError, match="numpy"):
        e.log(1.0)
