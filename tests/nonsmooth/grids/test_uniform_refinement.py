"""Uniform refinement of a grid: the stated error holds."""

import pytest

import nonsmooth as ns
from nonsmooth.grids.tensor_grid import fitted
from nonsmooth.grids.uniform_refinement import refined
from references import PLASTIC


@pytest.mark.parametrize("n", [3.0, 300.0])
@pytest.mark.parametrize("tol", [3e-2, 1e-3, 1e-5])
def test_uniform_refinement_is_honest(n, tol):
    """gamma^2[U' + C_b y] = 1, the forcing balance, within the error, which is within tol."""
    scene = ns.Scene("elasto_plastic", n=n, potential="x**4/4 + x**2/2", observable="x**3 + x + y")
    found = ns.asymptotic_variance(scene, tol)
    assert abs(found.value - 1) <= found.error <= tol * found.value


@pytest.mark.parametrize(
    "values",
    [
        pytest.param((1.0, 1.0, 1.3, 1.31, 1.3104), id="the first two levels agree"),
        pytest.param((0.7, 1.02, 1.02, 1.03, 1.032), id="the next two agree"),
        pytest.param((1.01, 1.04, 0.998, 0.9995, 1.0), id="differences grow at first"),
        pytest.param((1.0, 1.0, 1.0, 1.0, 1.0), id="all agree"),
    ],
)
@pytest.mark.parametrize("tol", [0.2, 0.1, 0.03])
def test_an_agreement_by_chance_is_seen(values, tol):
    """The last value is the limit; before it no level gains more than a factor of 30."""

    def solve(grid):
        (level,) = set(grid.levels.values())
        return values[level], 0.0

    found = refined(fitted(PLASTIC, 10.0, 1), solve, lambda error, _: error / tol)
    assert found.met
    assert abs(found.value - values[-1]) <= found.error <= tol
