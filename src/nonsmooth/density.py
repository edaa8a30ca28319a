"""The invariant density of Z^n (Theorem thm1) and its marginals, without Monte Carlo."""

import math

import numpy as np
import xarray as xr

from nonsmooth import refinement
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.models import STATE_VARIABLES

_POINTS = 201
_EXACT = {1: 1e-8, 2: 1e-6, 3: 1e-2, 4: 5e-2}  # tolerance unless given, by the number of variables
_RESIDUAL = 0.05  # of the iteration, relative to the tolerance


def invariant_density(scene, tol=None, points=None):
    """Invariant density: marginals of every variable and of the last two together.

    Parameters
    ----------
    scene : Scene
        With a finite n: at n = inf mass concentrates on sets of measure zero.
    tol : float, optional
        Error allowed, relative to the largest value of each density; by the number of variables
        1e-8, 1e-6, 1e-2, 5e-2 unless given.
    points : dict, optional
        Maps names of variables to points at which the densities are wanted; 201 equidistant ones
        over the support unless given.

    Returns
    -------
    xarray.Dataset
        `density_y` and so on over the points of each variable, and the joint density of the last
        two variables of the state, `density_y_x` or `density_eta_y`; each with its error
        (`density_y_error`), the largest difference between two grids.

    Raises
    ------
    SceneError
        If n is infinite.
    ToleranceError
        If `tol` cannot be met; the message has the error reached.
    """
    if math.isinf(scene.n):
        raise SceneError(
            "at n = inf the invariant measure of this package's models has no density in general; "
            "choose a finite n"
        )
    tol = _EXACT[len(scene.state)] if tol is None else tol
    grid = refinement.fitted(scene, math.log(1 / tol) + refinement.SPARE, 1)
    if points is None:
        points = {symbol.name: np.linspace(-end, end, _POINTS) for symbol, end in grid.ends.items()}
    names = [symbol.name for symbol in STATE_VARIABLES if symbol.name in scene.state]
    accuracy, found = tol * _RESIDUAL, None
    while True:
        previous, found = found, _on(scene, grid, names, points, accuracy)
        if previous is not None:
            error = {key: np.max(np.abs(found[key] - previous[key])) for key in found}
            relative = max(error[key] / np.max(found[key]) for key in found)
            if relative <= tol:
                break
        grid = refinement.raised(grid)
        if not refinement.affordable(scene, grid):
            raise ToleranceError(
                f"the invariant density has a relative error of {relative:.1e} on the finest grid, "
                f"above tol = {tol:g}; loosen tol"
            )
    variables = {f"density_{'_'.join(key)}": (key, value) for key, value in found.items()}
    variables |= {f"density_{'_'.join(key)}_error": ((), value) for key, value in error.items()}
    return xr.Dataset(variables, coords={name: points[name] for name in names})


def _on(scene, grid, names, points, accuracy):
    axes, solve = refinement.solver(scene, grid)
    shape = [len(axis.nodes) for axis in axes.values()]
    masses = solve.stationary(accuracy).reshape(shape)
    order = [symbol.name for symbol in axes]
    at = {
        symbol.name: axis.interpolation(points[symbol.name]) / axis.weights
        for symbol, axis in axes.items()
    }
    found = {}
    for key in [(name,) for name in names] + [tuple(names[-2:])] * (len(names) > 1):
        rest = tuple(place for place, name in enumerate(order) if name not in key)
        joint = masses.sum(axis=rest)
        for place, name in enumerate(name for name in order if name in key):
            joint = np.moveaxis(np.tensordot(at[name].toarray(), joint, axes=(1, place)), 0, place)
        if [name for name in order if name in key] != list(key):
            joint = joint.T
        found[key] = joint
    return found
