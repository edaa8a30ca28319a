"""The Milne problem of two variables with odd g and drift, whose generator A is not self-adjoint.

At the upper threshold A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and
q ~ kappa - x - u as x -> -inf, where A u = -g. Functions are odd or even, so that they are
discretised on half of a tensor grid. `docs/methods/boundary_layer.md` has the derivation.
"""

import math

import numpy as np
import scipy.linalg

from nonsmooth.boundary_layer import tuning
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import direct_solver, fitted
from nonsmooth.refine import Refined, until_agreement
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import gamma2_on_grids


def applies(scene: Scene) -> bool:
    """Whether the scene has two state variables, a finite n, and odd g and drift."""
    return scene.dimension == 2 and not math.isinf(scene.n) and scene.is_odd()


def layer_constants(
    scene: Scene, tol: float | None = None
) -> tuple[LayerConstants, LayerConstants]:
    """Compute the constants of the order 1.

    Parameters
    ----------
    scene : Scene
        To which this `applies`.
    tol : float, optional
        Absolute error wanted of kappa and of the Poisson solution; 1e-3 unless given.

    Returns
    -------
    constants, errors : LayerConstants
        Each variable is refined alone, and the changes are added up. The error is twice the last
        change of each, and what the first refinements change together beyond that sum.

    Raises
    ------
    SceneError
        If gamma^2 is 0: int g does not behave like a Brownian motion.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    tol = tuning.TWO_VARIABLES.accuracy if tol is None else tol
    grid, best = fitted(scene, tuning.TWO_VARIABLES.depth, 0), math.nan
    # if refining both variables changes too much beyond the sum of the separate changes, start
    # again from a finer grid; `_solved` raises an error when the grid is too large
    while True:
        values, errors = _refined_from(scene, grid, tol, best)
        if errors.max() <= tol:
            break
        grid, best = grid.all_raised(), values[0]
    gamma2, uncertainty = gamma2_on_grids.gamma2(scene, tuning.TWO_VARIABLES.gamma2)
    kappa, u = map(float, values)
    kappa_error, u_error = map(float, errors)
    return (
        LayerConstants(gamma2 / 2, (kappa, kappa), u),
        LayerConstants(uncertainty / 2, (kappa_error, kappa_error), u_error),
    )


def _refined_from(scene, coarse, tol, best):
    """Refine each variable alone until it has settled; return the values of `_milne` and errors."""
    first, second = coarse.levels
    base = _solved(scene, coarse, best)
    values, errors, once = base, np.zeros(2), {}
    for symbol in coarse.levels:
        found, once[symbol] = _refined_along(scene, coarse, symbol, base, values[0], tol)
        values = values + found.value - base
        errors = errors + 2 * found.error
    # what the variables change together beyond the sum of what they change alone
    both = _solved(scene, coarse.raised(first).raised(second), values[0])
    together = both - once[first] - once[second] + base
    return values + together, errors + np.abs(together)


def _refined_along(scene, coarse, symbol, base, best, tol) -> tuple[Refined, np.ndarray]:
    """Refine one variable until it has settled; return also the values after one refinement."""
    solutions = []

    def solve(grid):
        solutions.append(base if grid is coarse else _solved(scene, grid, best))
        return solutions[-1]

    found = until_agreement(
        _ever_finer(coarse, symbol),
        solve,
        lambda levels: np.abs(levels[-1] - levels[-2]),
        lambda _, change: np.max(change) <= tol / tuning.TWO_VARIABLES.safety,
    )
    return found, solutions[1]


def _ever_finer(grid, symbol):
    """Resolve one variable better and better, without end; `_solved` refuses too large grids."""
    while True:
        yield grid
        grid = grid.raised(symbol)


def _solved(scene, grid, best):
    values = _milne(scene, grid)
    if values is None:
        raise ToleranceError(
            f"kappa = {best:.7g} does not settle on grids of {tuning.TWO_VARIABLES.largest} nodes; "
            "loosen tol"
        )
    return values


def _milne(scene: Scene, grid) -> np.ndarray | None:
    """Return kappa and the Poisson solution at the start, or None if the grid is too large."""
    axes, solve = direct_solver(scene, grid)
    everywhere = solve.fold(evaluate(scene.numerical_observable(), axes))
    kept = np.flatnonzero(
        np.abs(everywhere) > tuning.TWO_VARIABLES.zero * np.max(np.abs(everywhere))
    )
    if len(kept) > tuning.TWO_VARIABLES.largest:
        return None
    # masses of both mirror images together; upwinding may make them negative in the tails
    measure, g = 2 * solve.fold(solve.stationary()), everywhere[kept]
    source = np.zeros((len(everywhere), len(kept)))
    source[kept, np.arange(len(kept))] = g
    odd = np.linalg.solve(-solve.matrix(ODD).toarray(), source)
    whole = odd.sum(axis=1)
    u = whole[kept]
    diffusion = (measure[kept] * g) @ u
    scatter = math.sqrt(abs((measure @ everywhere**2) * (measure @ whole**2)))
    if diffusion < tuning.TWO_VARIABLES.standstill * scatter:
        raise SceneError(
            f"gamma^2 of g = {quoted(scene.observable)} is 0 in this scene, so that there is no "
            "extrapolation length; choose another observable, or method='monte_carlo'"
        )
    border = np.block(
        [[-solve.matrix(EVEN).toarray(), np.ones((len(measure), 1))], [measure, np.zeros(1)]]
    )
    even = np.linalg.solve(border, np.vstack([source, np.zeros((1, len(kept)))]))[kept]
    kappa = _extrapolated(g, measure, kept, odd[kept], even, u, diffusion)
    return np.array([kappa, start_row(scene, axes) @ solve.unfold(whole, ODD)])


def _extrapolated(g, measure, kept, odd, even, u, diffusion) -> float:
    """Solve the Milne problem at the nodes with g != 0 and return kappa.

    The solution is kappa - x - u and the modes that decay as x -> -inf: (e + o) exp(mu x) with
    -A o = mu g e and -A e = mu g o. They carry no flux, E[g o] = 0, which fixes the constant in e.
    1/mu^2 are the eigenvalues of one matrix on o, the product of the inverses of -A on odd and on
    even functions (`odd` and `even`), each applied to g times a function.
    """
    flow = measure[kept] * g
    constant = -(flow @ odd) / diffusion @ even
    even = even + constant
    # scaled as if A were self-adjoint
    smallest = tuning.TWO_VARIABLES.smallest_scale * np.max(np.abs(measure))
    masses = np.maximum(np.abs(measure), smallest)[kept]
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
    return (np.linalg.solve(matrix / size, rows * np.sign(g) * u) / size)[0].real
