"""Invariant probabilities of bins, from closed forms and on grids."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike
from scipy.ndimage import maximum_filter1d

from nonsmooth.errors import SceneError, answered
from nonsmooth.estimate import not_negative
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.closed_form import closed_form
from nonsmooth.statistics.density.on_grids import first_grid, outside, refined


def bin_averages(
    scene: Scene, edges: Mapping[str, ArrayLike], tol: float
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Invariant probabilities of bins, divided by their widths: what a histogram estimates.

    Where friction or a wall concentrates the density, averages over bins have converged already on
    grids on which the values at points have not.

    Parameters
    ----------
    scene : Scene
        As for `invariant_density`.
    edges : dict
        Maps names of variables to the edges of their bins.
    tol : float
        Error allowed, relative to the largest average of each variable.

    Returns
    -------
    dict
        Name -> (averages, errors), of each bin. On grids the difference of two of them oscillates
        from bin to bin; the error of a bin is twice the largest of those near it, at most the
        largest of all, and what the density may be outside of the grids.

    Raises
    ------
    SceneError
        If n = inf and there is no closed form.
    ToleranceError
        If `tol` cannot be met.
    """
    if closed := closed_form(scene):
        return _averages_of_closed_form(scene, closed, edges)
    if math.isinf(scene.n):
        raise SceneError(
            "at n = inf bins are averaged only where there is a closed form; choose a finite n, or "
            "histograms of simulated paths"
        )
    grid = first_grid(scene, tol)
    accuracy = tol * tuning.INVARIANT_DENSITY.residual

    def present(refined):
        clipped = {name: not_negative(*both) for name, both in refined.items()}
        return {
            name: (value, _largest_near(error) + outside(value, tol))
            for name, (value, error) in clipped.items()
        }

    return answered(
        lambda: refined(scene, grid, tol, lambda grid: _averages_on(scene, grid, edges, accuracy)),
        present,
    )


def _largest_near(error):
    """Take the largest error of the bins around each, with a margin; at most that of all bins."""
    chosen = tuning.INVARIANT_DENSITY
    reach = math.ceil(len(error) * chosen.near)
    around = maximum_filter1d(error, 2 * reach + 1, mode="nearest")
    return np.minimum(chosen.safety * around, np.max(error))


def _averages_of_closed_form(scene, closed, edges):
    """Averages and their errors, by Gauss quadrature in each bin."""
    chosen, averages = tuning.INVARIANT_DENSITY, {}
    for name, ends in edges.items():
        points, weights = _averaging(ends, _cuts(scene, name), chosen.gauss)
        value, inexact = closed[name](points)
        average = weights @ value
        coarse, fewer = _averaging(ends, _cuts(scene, name), chosen.fewer)
        error = np.abs(average - fewer @ closed[name](coarse)[0]) + weights @ inexact
        averages[name] = average, error
    return averages


def _averages_on(scene, grid, edges, accuracy):
    axes, masses = tensor_grid.invariant_measure(scene, grid, accuracy)
    found, gauss = {}, tuning.INVARIANT_DENSITY.gauss
    for place, (symbol, axis) in enumerate(axes.items()):
        if symbol.name in edges:
            marginal = masses.sum(axis=tuple(k for k in range(len(axes)) if k != place))
            points, weights = _averaging(edges[symbol.name], axis.edges, gauss)
            found[symbol.name] = weights @ (axis.densities(points) @ marginal)
    return found


def _cuts(scene, name):
    """Return the kinks of one variable, at which bins are cut."""
    return np.array([k for s, k in kinks(scene).items() if s.name == name for k in (-k, k)])


def _averaging(edges, cuts, count):
    """Return quadrature points, and the matrix that turns values there into averages over bins.

    Bins are cut at kinks of the density, so that the quadrature converges in each piece.
    """
    nodes, gauss = leggauss(count)
    inside = cuts[(cuts > edges[0]) & (cuts < edges[-1])]
    pieces = np.unique(np.concatenate([edges, inside]))
    half = np.diff(pieces) / 2
    points = ((pieces[:-1] + half)[:, None] + half[:, None] * nodes).ravel()
    weights = np.zeros((len(edges) - 1, len(half), len(nodes)))
    place = np.clip(np.searchsorted(edges, pieces[:-1] + half) - 1, 0, len(edges) - 2)
    weights[place, np.arange(len(half))] = half[:, None] * gauss
    return points, weights.reshape(len(edges) - 1, -1) / np.diff(edges)[:, None]
