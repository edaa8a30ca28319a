"""Functionals on combined grids: what is kept where a part of them fails."""

import math

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.statistics import tuning
from nonsmooth.statistics.combined_grids import combined


def test_the_value_for_a_large_n_outlives_the_extrapolation():
    """Its distance to the limit is unknown, which its error says."""

    def functional(scene, grid, accuracy):
        if scene.n < tuning.GAMMA2_ON_GRIDS.stiff:
            raise ToleranceError("the iteration does not converge")
        return 2.0

    scene = ns.Scene("elasto_plastic", "langevin", n=math.inf)
    found = combined(scene, 1e-2, functional, lambda value, tol: tol * value)
    assert (found.value, found.error) == (2.0, math.inf)
