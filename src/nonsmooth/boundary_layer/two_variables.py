"""The constants of two variables with odd g and drift, whose generator A is not self-adjoint.

Functions are odd or even, so that they are discretised on half of a tensor grid. Those of the Milne
problem come from `half_space`, which also needs that of the adjoint of A for the orders 2 and 3.
`docs/methods/boundary_layer.md` has the derivation.
"""

import math
from dataclasses import replace

import numpy as np

from nonsmooth.boundary_layer import half_space, tuning
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.combination_technique import combined
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.mesh.box import is_known
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import around_start, direct_solver, fitted
from nonsmooth.grids.tuning import COMBINATION_TECHNIQUE
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import gamma2_on_grids


def applies(scene: Scene) -> bool:
    """Whether the scene has two state variables, a finite n, odd g and drift, and a known box."""
    finite = scene.dimension == 2 and not math.isinf(scene.n)
    return finite and scene.is_odd() and is_known(scene)


def layer_constants(
    scene: Scene, tol: float | None = None, higher: bool = True
) -> tuple[LayerConstants, LayerConstants]:
    """Compute the constants of the order 1, or of all orders.

    Parameters
    ----------
    scene : Scene
        To which this `applies`.
    tol : float, optional
        Absolute error wanted of kappa and u; 1e-3 unless given. The others may have errors that
        move a formula as much where a threshold is three times kappa away.
    higher : bool, optional
        Whether the dipole and kappa3 are wanted, too, which the orders 2 and 3 need.

    Returns
    -------
    constants, errors : LayerConstants
        The errors are what grids beyond those combined may add (`Combination.error`), twice what a
        larger box changes, and a part of the tolerance.

    Raises
    ------
    SceneError
        If gamma^2 is 0: int g does not behave like a Brownian motion.
    ToleranceError
        If `tol` is not met; the best constants and errors are its `result`.
    """
    tol = tuning.TWO_VARIABLES.accuracy if tol is None else tol
    intensity, uncertainty = _limit_variance(scene)
    layer, allowed = _best(scene, tol, higher)
    interior, allowed_inside = _interior(scene, tol, layer[0])
    diffusion = np.array([intensity, uncertainty]) / 2
    values, errors = (
        _record(*numbers, diffusion[0]) for numbers in zip(diffusion, layer, interior, strict=True)
    )
    for names, (numbers, inexact), most in (
        (("kappa", "S", "kappa3"), layer, allowed),
        (("u at the start", "h there", "r there", "B / D"), interior, allowed_inside),
    ):
        for name, value, error, limit in zip(names, numbers, inexact, most, strict=False):
            if not error <= limit:
                raise ToleranceError(
                    f"{name} = {value:.7g} has an error of {error:.1e}, above {limit:.1e} as "
                    f"tol = {tol:g} needs; loosen tol",
                    (values, errors),
                )
    return values, errors


def _record(diffusion, layer, interior, unit):
    """Give names to constants, or to their errors; the dispersion comes as a part of a unit."""
    (kappa, *others), (u, h, r, dispersion) = layer.tolist(), interior.tolist()
    dipole, kappa3 = others or (None, None)
    return LayerConstants(
        diffusion=float(diffusion),
        kappa=(kappa, kappa),
        u=u,
        dispersion=float(dispersion * unit),
        dipole=None if dipole is None else (dipole, dipole),
        h=h,
        kappa3=None if kappa3 is None else (kappa3, kappa3),
        r=r,
    )


def _allowed(tol, kappa):
    """Return which errors of constants are allowed: lengths, their squares, their cubes.

    To first order an error d of kappa changes the square of a distance b by 2 b d.
    """
    near = tuning.TWO_VARIABLES.nearest * abs(kappa)
    return tol * np.array([1.0, 2 * near, 2 * near**2])


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


def _best(scene, tol, higher):
    """Return the constants of the Milne problem with their errors, and which errors are allowed.

    They are from the first coarsest grid on which nothing fails: what is coarse in one variable
    may be singular when the other is refined.
    """
    chosen, found = tuning.TWO_VARIABLES, []
    grid = fitted(scene, max(math.log(1 / tol), 0.0) + chosen.spare, 0)
    for coarse in (grid.all_raised(by) for by in range(chosen.coarsest)):
        if half_space.size(scene, coarse) > chosen.largest:
            break
        try:
            *one, complete = _combined(scene, coarse, tol, higher)
        except ToleranceError:
            continue
        found.append(one)
        if complete:
            break
    if not found:
        raise ToleranceError(
            f"kappa cannot be solved for with {chosen.largest} nodes in this scene; use a smaller "
            "n or a damping closer to 1"
        )
    return min(found, key=lambda one: np.max(one[0][1] / one[1]))


def _combined(scene, coarse, tol, higher):
    """Return what `_best` does, by the combination technique, and whether no grid failed."""
    chosen = tuning.TWO_VARIABLES
    base = half_space.constants(scene, coarse, higher)
    allowed = _allowed(tol, base[0])[: len(base)]
    box = 2 * np.abs(half_space.constants(scene, coarse.enlarged(), higher) - base)
    others = box + chosen.by_chance * allowed
    lowest = tuple(coarse.levels.values())

    def on(index):
        grid = coarse.with_levels(index)
        found = base if index == lowest else half_space.constants(scene, grid, higher)
        return found / allowed

    value, error, complete = combined(
        lowest,
        on,
        lambda index: (half_space.size(scene, coarse.with_levels(index)) / chosen.largest) ** 3,
        lambda _, error: bool(np.all(error + others / allowed <= 1)),
        chosen.work,
        COMBINATION_TECHNIQUE.mixed_by_motion,
        chosen.alone,
    )
    return (value * allowed, error * allowed + others), allowed, complete


def _interior(scene, tol, layer):
    """Return u, h and r at the start and B/D with their errors, and which errors are allowed.

    Order 1 has only u; the others tell the size of what it leaves out, for which a coarse grid is
    good enough.
    """
    kappa, *others = layer
    allowed = _allowed(tol, kappa)[[0, 1, 2, 1]] if others else np.array([tol, *[np.inf] * 3])

    def solve(grid):
        axes, solver = direct_solver(scene, grid)
        g = solver.fold(evaluate(scene.numerical_observable(), axes))
        at_start = start_row(scene, axes)
        masses = 2 * solver.fold(solver.stationary())
        u, _ = solver.solve(g, ODD)
        h, diffusion = solver.solve(g * u, EVEN)
        h -= masses @ h
        r, _ = solver.solve(g * h - diffusion * u, ODD)
        found = [
            at_start @ solver.unfold(one, parity) for one, parity in ((u, ODD), (h, EVEN), (r, ODD))
        ]
        values = np.array([*found, (masses * g) @ r / diffusion])
        return values, tuning.TWO_VARIABLES.rounding * np.abs(values)

    grid = fitted(scene, tuning.TWO_VARIABLES.depth, 1)
    grid = replace(grid, ends=around_start(scene, grid.ends))
    found = uniform_refinement.refined(grid, solve, lambda error, _: np.max(error / allowed))
    return (found.value, found.error), allowed
