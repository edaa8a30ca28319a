"""The elementary functions are accurate where the flows use them."""

import numba
import numpy as np
import pytest

from nonsmooth.paths.kernels import instructions
from nonsmooth.paths.kernels import vector_math as e
from nonsmooth.paths.kernels.single_precision import ELEMENTARY as OF_FORMULAS

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


# units in the last place of the result, or of 1; Cephes states one, quotients of two have two more
ELEMENTARY = {
    "exp": (np.exp, np.linspace(-87, 88.3, 400_001), None, 2.0),
    "log": (np.log, np.geomspace(1.2e-38, 3e38, 400_001), None, 1.5),
    "sin": (np.sin, np.linspace(-1e4, 1e4, 400_001), 1.0, 2.0),
    "cos": (np.cos, np.linspace(-1e4, 1e4, 400_001), 1.0, 2.0),
    "atan": (np.arctan, np.linspace(-50, 50, 400_001), None, 3.0),
    "sinh": (np.sinh, np.linspace(-88, 88, 400_001), None, 3.0),
    "cosh": (np.cosh, np.linspace(-88, 88, 400_001), None, 3.0),
    "tanh": (np.tanh, np.linspace(-12, 12, 400_001), None, 3.0),
}


def applied(name, x):
    """Apply a function of formulas in a loop."""
    function = OF_FORMULAS[name]

    @numba.njit
    def sweep(x, out):
        for i in range(len(x)):
            out[i] = function(x[i])

    out = np.empty_like(x)
    sweep(x, out)
    return out


@pytest.mark.parametrize("name", OF_FORMULAS)
def test_functions_of_formulas(name):
    """They agree with those of numpy in extended precision, also close to 0."""
    exact, x, unit, allowed = ELEMENTARY[name]
    small = np.geomspace(1e-12, 1, 10_001)
    x = np.concatenate([x, small, [] if name == "log" else -small]).astype("float32")
    reference = exact(x.astype(np.longdouble))
    scale = np.spacing(np.asarray(np.abs(reference) if unit is None else unit, dtype="float32"))
    assert np.max(np.abs(applied(name, x) - reference) / scale) <= allowed


@pytest.mark.parametrize("name", OF_FORMULAS)
def test_functions_of_formulas_at_the_ends(name):
    """What is no number stays none; huge arguments give what they give in numpy, or nearly."""
    ends = np.array([np.nan, -1e30, 1e30], dtype="float32")
    found = applied(name, ends)
    assert np.isnan(found[0])
    if name in ("sin", "cos"):
        assert np.all(np.abs(found[1:]) <= 1)
    else:
        with np.errstate(all="ignore"):
            assert np.allclose(found[1:], ELEMENTARY[name][0](ends[1:]), equal_nan=True, atol=1e-37)


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
