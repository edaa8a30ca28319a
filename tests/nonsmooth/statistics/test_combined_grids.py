"""Functionals on combined grids: what is kept where a part of them fails."""

import math
from functools import partial

import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.statistics import tuning
from nonsmooth.statistics.combined_grids import combined


def on(functional):
    """Return what takes the residual last."""
    return lambda scene, grid: partial(functional, scene, grid)


def test_the_value_for_a_large_n_outlives_the_extrapolation():
    """Its distance to the limit is unknown, which its error says."""

    def functional(scene, grid, accuracy):
        if scene.n < tuning.GAMMA2_ON_GRIDS.stiff:
            raise ToleranceError("the iteration does not converge")
        return 2.0

    scene = ns.Scene("elasto_plastic", "langevin", n=math.inf)
    found = combined(scene, 1e-2, on(functional), lambda value, tol: tol * value)
    assert (found.value, found.error) == (2.0, math.inf)


def test_a_smaller_n_stands_for_the_limit_where_the_iteration_fails():
    """The rest of order 1/n is extrapolated from there."""
    largest = tuning.GAMMA2_ON_GRIDS.softer * tuning.GAMMA2_ON_GRIDS.stiff

    def functional(scene, grid, accuracy):
        if scene.n > largest:
            raise ToleranceError("the iteration does not converge")
        return 2.0 + 100 / scene.n

    scene = ns.Scene("elasto_plastic", "langevin", n=math.inf)
    found = combined(scene, 1e-2, on(functional), lambda value, tol: tol * value)
    assert found.scene.n == largest
    assert found.value == pytest.approx(2.0, abs=1e-12)
    assert 100 / largest <= found.error < 1e-2 * found.value


def test_a_residual_that_says_nothing_about_the_error_is_refused():
    """Where the third residual is not reached, a smaller n stands for the limit as well."""
    largest = tuning.GAMMA2_ON_GRIDS.softer * tuning.GAMMA2_ON_GRIDS.stiff
    residuals = set()

    def functional(scene, grid, accuracy):
        residuals.add(accuracy)
        if scene.n > largest and len(residuals) > 2:
            raise ToleranceError("the iteration does not converge")
        return 2.0 + 100 / scene.n

    scene = ns.Scene("elasto_plastic", "langevin", n=math.inf, potential="x**2/2")
    found = combined(scene, 1e-2, on(functional), lambda value, tol: tol * value)
    assert len(residuals) > 2
    assert abs(found.value - 2) <= found.error
