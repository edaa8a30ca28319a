"""The spectral gap of the generator, the rate at which correlations decay (Theorem thm2)."""

import math
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import scipy.sparse.linalg as spla

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.grids import tensor_grid, tuning
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.line import eigenfunctions

_WANTED = 6  # eigenvalues computed; the slowest pair may be complex
_FIT, _FINEST = 1, 8  # levels: where the box is fitted, and the last
_SHARE = 1e-2  # of the tolerance, for the iteration
# relative; against linear scenes it comes to 2e-12, and what moves eigenvalues that coincide apart
# to 2e-13
_ROUNDING, _BACKWARD = 2e-11, 5e-13


def spectral_gap(scene, tol=1e-6):
    """Smallest real part of the non-zero eigenvalues of -A_n.

    Parameters
    ----------
    scene : Scene
        With one or two state variables and a finite n.
    tol : float
        Requested relative error.

    Returns
    -------
    Estimate
        The error is the difference of two grids, what the edge of the box does, and rounding. If
        three grids converge, it is the difference of the last two times the root of the larger of
        the last two factors by which differences fall: errors fall by such a factor, too.

    Raises
    ------
    SceneError
        If the state has more variables, or n is infinite and the state two variables.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    began = time.perf_counter()
    if scene.is_line:
        solve, levels = _of_polynomials, (8, 12, 16, 20, 24)
    elif scene.dimension == 2 and not math.isinf(scene.n):
        grid = tensor_grid.fitted(scene, tensor_grid.depth_for(tol), _FIT)

        def solve(scene, level, margin=0.0):
            levels = dict.fromkeys(grid.levels, level)
            return _on(scene, replace(grid, levels=levels, margin=margin), _SHARE * tol)

        levels = range(_FINEST + 1)
    else:
        raise SceneError(
            f"the spectral gap is computed for one or two state variables and, for two, a finite "
            f"n, not for ({', '.join(scene.state)}) at n = {scene.n:g}; measure the decay of "
            "correlations by Monte Carlo"
        )
    found, changes = [solve(scene, levels[0])[0]], []
    unseen = iter(levels)  # on which the effect of the box has not been measured
    for level in levels[1:]:
        value, rounding = solve(scene, level)
        changes.append(max(abs(value - found[-1]), rounding))
        found.append(value)
        fall = max((b / a for a, b in pairwise(changes[-3:])), default=1.0)
        error = changes[-1] * math.sqrt(min(fall, 1.0)) + rounding
        while error <= tol * value:
            if scene.dimension == 1:
                beyond = 0.0
            else:
                coarse = next(unseen)
                beyond = 2 * abs(
                    solve(scene, coarse, tuning.TENSOR_GRIDS.margin)[0] - found[coarse]
                )
            if error + beyond <= tol * value:
                seconds = time.perf_counter() - began
                return Estimate(value, error + beyond, "spectral elements", seconds)
            if coarse == level:
                break
    raise ToleranceError(
        f"the spectral gap {value:.10g} has an error of {error:.1e}, above tol = {tol:g} "
        "relative; loosen tol"
    )


def _of_polynomials(scene, degree):
    # where the mesh need not reach out to the starting point
    rate = float(eigenfunctions.spectrum(scene.with_start({}), degree).rates[1])
    return rate, rate * _ROUNDING


def _on(scene, grid, accuracy):
    """Invert -A on functions modulo constants, odd and even ones apart; rate and its error."""
    _, solver = tensor_grid.solver(scene, grid)
    slowest = []
    for parity in (ODD, EVEN) if solver.mirrored else (EVEN,):
        size = solver.matrix(parity).shape[0]
        inverse = spla.LinearOperator(
            (size, size), lambda values, parity=parity: solver.solve(values, parity)[0], dtype=float
        )
        start = np.cos(np.arange(size))  # the same in every run
        # the slowest of those wanted is known far better than the fastest
        largest = spla.eigs(inverse, k=_WANTED, v0=start, tol=accuracy, return_eigenvectors=False)
        rates = 1 / largest[np.abs(largest) > 1e-12]
        slowest.append(min((rate.real, _moved(rates, rate)) for rate in rates))
    rate, moved = min(slowest)
    return float(rate), float(moved + accuracy * rate)


def _moved(rates, rate):
    """Bound how far rounding moves an eigenvalue: the farther, the closer it is to another one."""
    gap = np.sort(np.abs(rates - rate))[1] / abs(rate)
    return abs(rate) * (_ROUNDING + _BACKWARD / max(gap, math.sqrt(_BACKWARD)))
