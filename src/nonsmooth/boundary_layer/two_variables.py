"""The Milne problem of `milne` for two state variables, whose generator A is not self-adjoint.

Discretised on half of a tensor grid, functions being odd or even: drift and g are odd.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import fitted, solver
from nonsmooth.statistics.gamma2_on_grids import gamma2_by_combination

_DEPTH = 16.0  # the density outside the box is of the order exp(-16) of its maximum
_LARGEST = 3000  # nodes with g != 0: a minute
_STANDSTILL = 1e-3  # correlation of g and its Poisson solution, below which gamma^2 may be 0
_GROWTH = 1e-5  # relative error wanted of gamma^2
_SHARE = 8.0  # the last change of a variable is at most this part of the tolerance
_LEAST = 1e-10  # of the scale of a node, relative to the largest


@dataclass(frozen=True)
class Leading:
    """Constants of the corrected formula of order 1.

    Attributes
    ----------
    diffusion, length, poisson : float
        D = gamma^2/2, the extrapolation length kappa, and the Poisson solution of g at the start.
    """

    diffusion: float
    length: float
    poisson: float


def applies(scene):
    """Whether the scene has two state variables, a finite n, and odd g and drift."""
    return scene.dimension == 2 and not math.isinf(scene.n) and scene.is_odd()


def leading(scene, tol=1e-3):
    """Compute the constants of a scene to which this `applies`.

    Parameters
    ----------
    scene : Scene
    tol : float
        Absolute error wanted of kappa and of the Poisson solution.

    Returns
    -------
    constants, errors : Leading
        Each variable is refined alone, and the changes are added up. The error is twice the last
        change of each, and what the first refinements change together beyond that sum.

    Raises
    ------
    SceneError
        If gamma^2 is 0: int g does not behave like a Brownian motion.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    grid, best = fitted(scene, _DEPTH, 0), math.nan
    while True:
        values, errors = _refined_from(scene, grid, tol, best)
        if errors.max() <= tol:
            break
        grid, best = grid.all_raised(), values[0]
    gamma2, uncertainty = gamma2_by_combination(scene, _GROWTH)
    return (
        Leading(gamma2 / 2, *map(float, values)),
        Leading(uncertainty / 2, *map(float, errors)),
    )


def _refined_from(scene, coarse, tol, best):
    """Refine each variable alone until it has settled; returns what `_milne` does and the error."""
    first, second = coarse.levels
    base = _solved(scene, coarse, best)
    values, errors, once = base, np.zeros(2), {}
    for symbol in coarse.levels:
        grid, last, change = coarse, base, np.full(2, np.inf)
        while np.max(change) > tol / _SHARE:
            grid, previous = grid.raised(symbol), last
            last = _solved(scene, grid, values[0])
            once.setdefault(symbol, last)
            change = np.abs(last - previous)
        values = values + last - base
        errors = errors + 2 * change
    # what the variables change together beyond the sum of what they change alone
    both = _solved(scene, coarse.raised(first).raised(second), values[0])
    together = both - once[first] - once[second] + base
    return values + together, errors + np.abs(together)


def _solved(scene, grid, best):
    values = _milne(scene, grid)
    if values is None:
        raise ToleranceError(
            f"kappa = {best:.7g} does not settle on grids of {_LARGEST} nodes; loosen tol"
        )
    return values


def _milne(scene, grid):
    """Return kappa and the Poisson solution at the start, or None if the grid is too large.

    The solution is kappa - x - u and the modes that decay as x -> -inf: (e + o) exp(mu x) with
    -A o = mu g e and -A e = mu g o. They carry no flux, E[g o] = 0, which fixes the constant in e.
    1/mu^2 are the eigenvalues of one matrix on o.
    """
    axes, solve = solver(scene, grid)
    everywhere = solve.fold(evaluate(scene.numerical_observable(), axes))
    kept = np.flatnonzero(np.abs(everywhere) > 1e-13 * np.max(np.abs(everywhere)))
    if len(kept) > _LARGEST:
        return None
    # discrete masses, of both mirror images together: in the tails, upwind ones may be negative
    measure, g = 2 * solve.fold(solve.stationary()), everywhere[kept]
    flow = measure[kept] * g
    source = np.zeros((len(everywhere), len(kept)))
    source[kept, np.arange(len(kept))] = g
    odd = np.linalg.solve(-solve.matrix(ODD).toarray(), source)
    whole = odd.sum(axis=1)
    u = whole[kept]
    diffusion = flow @ u
    scatter = math.sqrt(abs((measure @ everywhere**2) * (measure @ whole**2)))
    if diffusion < _STANDSTILL * scatter:
        raise SceneError(
            f"gamma^2 of g = {scene.observable!r} is 0 in this scene, so that there is no "
            "extrapolation length; choose another observable, or method='monte_carlo'"
        )
    border = np.block(
        [[-solve.matrix(EVEN).toarray(), np.ones((len(measure), 1))], [measure, np.zeros(1)]]
    )
    even = np.linalg.solve(border, np.vstack([source, np.zeros((1, len(kept)))]))[kept]
    odd = odd[kept]
    constant = -(flow @ odd) / diffusion @ even
    even = even + constant
    # scaled as if A were self-adjoint
    masses = np.maximum(np.abs(measure), _LEAST * np.max(np.abs(measure)))[kept]
    scale = 1 / np.sqrt(masses * np.abs(g))
    without_flux = scipy.linalg.qr((flow * scale)[:, None])[0][:, 1:]
    product = without_flux.T @ ((odd @ even) * scale / scale[:, None]) @ without_flux
    squares, vectors = np.linalg.eig(product)
    odd_parts = scale[:, None] * (without_flux @ vectors)
    leaving = even @ odd_parts + np.sqrt(squares.astype(complex)) * (
        np.sign(g)[:, None] * odd_parts
    )
    rows = np.sqrt(masses)
    matrix = rows[:, None] * np.column_stack([np.ones(len(kept)), leaving])
    size = np.linalg.norm(matrix, axis=0)
    length = (np.linalg.solve(matrix / size, rows * np.sign(g) * u) / size)[0].real
    return np.array([length, start_row(scene, axes) @ solve.unfold(whole, ODD)])
