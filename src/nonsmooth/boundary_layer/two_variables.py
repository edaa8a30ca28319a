"""The Milne problem of two variables with odd g and drift, whose generator A is not self-adjoint.

At the upper threshold A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and
q ~ kappa - x - u as x -> -inf, where A u = -g. Functions are odd or even, so that they are
discretised on half of a tensor grid. `docs/methods/boundary_layer.md` has the derivation.
"""

import math
from dataclasses import replace

import numpy as np
import scipy.linalg

from nonsmooth.boundary_layer import tuning
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.combination_technique import combined
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import around_start, direct_solver, fitted
from nonsmooth.grids.tuning import COMBINATION_TECHNIQUE
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
        The error of kappa is what grids beyond those combined may add (`Combination.error`), and
        twice what a larger box changes.

    Raises
    ------
    SceneError
        If gamma^2 is 0: int g does not behave like a Brownian motion.
    ToleranceError
        If `tol` is not met; the best constants and errors are its `result`.
    """
    tol = tuning.TWO_VARIABLES.accuracy if tol is None else tol
    intensity, uncertainty = _limit_variance(scene)
    kappa, error = _best(scene, tol)
    u, u_error = _poisson_at_start(scene, tol)
    found = (
        LayerConstants(intensity / 2, (kappa, kappa), u),
        LayerConstants(uncertainty / 2, (error, error), u_error),
    )
    for name, value, reached in (("kappa", kappa, error), ("u at the start", u, u_error)):
        if not reached <= tol:
            raise ToleranceError(
                f"{name} = {value:.7g} has an error of {reached:.1e}, above tol = {tol:g}; "
                "loosen tol",
                found,
            )
    return found


def _limit_variance(scene):
    """Return gamma^2 and its error, even a large one; refuse scenes in which it may be 0."""
    try:
        return gamma2_on_grids.gamma2(scene, tuning.TWO_VARIABLES.gamma2)
    except ToleranceError as refused:
        if refused.result is None:
            raise
        value, error = refused.result
    if value <= error:
        raise SceneError(
            f"gamma^2 of g = {quoted(scene.observable)} is 0 in this scene, or hard to tell from "
            "it, so that there is no extrapolation length; choose another observable"
        )
    return value, error


def _best(scene, tol):
    """Return kappa and its error, from the first coarsest grid on which nothing fails.

    What is coarse in one variable may be singular when the other is refined.
    """
    chosen, found = tuning.TWO_VARIABLES, []
    grid = fitted(scene, max(math.log(1 / tol), 0.0) + chosen.spare, 0)
    for coarse in (grid.all_raised(by) for by in range(chosen.coarsest)):
        if _size(scene, coarse) > chosen.largest:
            break
        try:
            *pair, complete = _combined(scene, coarse, tol)
        except ToleranceError:
            continue
        found.append(pair)
        if complete:
            break
    if not found:
        raise ToleranceError(
            f"kappa cannot be solved for with {chosen.largest} nodes in this scene; use a smaller "
            "n or a damping closer to 1"
        )
    return min(found, key=lambda pair: pair[1])


def _combined(scene, coarse, tol):
    """Return kappa and its error by the combination technique, and whether no grid failed."""
    chosen = tuning.TWO_VARIABLES
    base = _milne(scene, coarse)
    box = 2 * abs(_milne(scene, coarse.enlarged()) - base)
    lowest = tuple(coarse.levels.values())
    kappa, error, complete = combined(
        lowest,
        lambda index: base if index == lowest else _milne(scene, coarse.with_levels(index)),
        lambda index: (_size(scene, coarse.with_levels(index)) / chosen.largest) ** 3,
        lambda _, error: error + box <= tol,
        chosen.work,
        COMBINATION_TECHNIQUE.mixed_by_motion,
    )
    return kappa, error + box, complete


def _size(scene, grid):
    """Count the nodes with g != 0 on half of a grid."""
    axes, solve = direct_solver(scene, grid)
    return len(_moving(solve.fold(evaluate(scene.numerical_observable(), axes))))


def _moving(g):
    """Return the places of the nodes with g != 0."""
    return np.flatnonzero(np.abs(g) > tuning.TWO_VARIABLES.zero * np.max(np.abs(g)))


def _poisson_at_start(scene, tol):
    """Return the Poisson solution at the start, and its error; it is odd."""
    if not any(scene.start.values()):
        return 0.0, 0.0

    def solve(grid):
        axes, solver = direct_solver(scene, grid)
        g = solver.fold(evaluate(scene.numerical_observable(), axes))
        u, _ = solver.solve(g, ODD)
        value = start_row(scene, axes) @ solver.unfold(u, ODD)
        return value, tuning.TWO_VARIABLES.rounding * abs(value)

    grid = fitted(scene, tuning.TWO_VARIABLES.depth, 1)
    grid = replace(grid, ends=around_start(scene, grid.ends))
    found = uniform_refinement.refined(grid, solve, lambda error, _: error / tol)
    return float(found.value), float(found.error)


def _milne(scene: Scene, grid) -> float:
    """Return kappa on one grid."""
    axes, solve = direct_solver(scene, grid)
    everywhere = solve.fold(evaluate(scene.numerical_observable(), axes))
    kept = _moving(everywhere)
    # masses of both mirror images together; upwinding may make them negative in the tails
    measure, g = 2 * solve.fold(solve.stationary()), everywhere[kept]
    source = np.zeros((len(everywhere), len(kept)))
    source[kept, np.arange(len(kept))] = g
    odd = np.linalg.solve(-solve.matrix(ODD).toarray(), source)
    whole = odd.sum(axis=1)
    u = whole[kept]
    diffusion = (measure[kept] * g) @ u
    if diffusion <= 0:
        raise ToleranceError("a grid is too coarse for the diffusion of int g")
    border = np.block(
        [[-solve.matrix(EVEN).toarray(), np.ones((len(measure), 1))], [measure, np.zeros(1)]]
    )
    even = np.linalg.solve(border, np.vstack([source, np.zeros((1, len(kept)))]))[kept]
    return _extrapolated(g, measure, kept, odd[kept], even, u, diffusion)


def _extrapolated(g, measure, kept, odd, even, u, diffusion) -> float:
    """Solve the Milne problem at the nodes with g != 0 and return kappa.

    The solution is kappa - x - u and the modes that decay as x -> -inf: (e + o) exp(mu x) with
    -A o = mu g e and -A e = mu g o. They carry no flux, E[g o] = 0, which fixes the constant in e.
    With the inverses of -A on odd and on even functions, each applied to g times a function (`odd`
    and `even`), o = mu odd e and e = mu even o. So K = odd even has the eigenvalues 1/mu^2 on o,
    and all modes together are e = even w, o = K^(1/2) w, with the principal square root and any w.
    Eigenvectors would lose up to all digits, for K is not self-adjoint.
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
    # imaginary parts come from modes in the tails that the grid does not resolve: other grids show
    # how much they matter
    root = np.real(scipy.linalg.sqrtm(product))
    if not np.all(np.isfinite(root)):
        raise ToleranceError("the discretised Milne problem is singular in double precision")
    leaving = even @ (scale[:, None] * without_flux) + (np.sign(g) * scale)[:, None] * (
        without_flux @ root
    )
    rows = np.sqrt(masses)
    matrix = rows[:, None] * np.column_stack([np.ones(len(kept)), leaving])
    size = np.linalg.norm(matrix, axis=0)
    return float((np.linalg.solve(matrix / size, rows * np.sign(g) * u) / size)[0])
