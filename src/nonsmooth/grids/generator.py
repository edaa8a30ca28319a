"""The generator A_n (eq. (9) of the paper) of any scene on a tensor grid of spectral elements.

Everything is read from the scene's own drift: coefficients are evaluated at the nodes, and on the
faces of discontinuous elements, where their sign decides from which side a value is taken.
"""

from collections.abc import Container, Mapping
from dataclasses import dataclass
from functools import reduce

import numpy as np
import scipy.sparse as sp
import sympy

from nonsmooth.errors import SceneError
from nonsmooth.grids.elements import Axis
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene

_SIDE = 1e-6  # distance from an edge at which its sides are seen, over the smallest element
_JUMP = 1e-3  # relative difference of both sides that is a jump
_BATCH = 300  # points that are interpolated at together, so that their values fit into the cache


def evaluate(
    expression: sympy.Expr,
    axes: Mapping[sympy.Symbol, Axis],
    points: Mapping[sympy.Symbol, np.ndarray] | None = None,
) -> np.ndarray:
    """Evaluate a formula on a tensor grid.

    Parameters
    ----------
    expression : sympy.Expr
    axes : dict
        Maps the symbols of the variables, in order, to their `Axis`.
    points : dict, optional
        Points that replace an axis' nodes.

    Returns
    -------
    numpy.ndarray, shape (number of grid points,)

    Raises
    ------
    SceneError
        If the formula is not finite somewhere.
    """
    where = [(points or {}).get(symbol, axis.nodes) for symbol, axis in axes.items()]
    grid = np.meshgrid(*where, indexing="ij")
    with np.errstate(all="ignore"):
        values = vectorised(expression, tuple(axes))(*grid).ravel()
    if not np.all(np.isfinite(values)):
        at = [float(part.ravel()[np.argmin(np.isfinite(values))]) for part in grid]
        place = ", ".join(f"{symbol} = {value:.3g}" for symbol, value in zip(axes, at, strict=True))
        raise SceneError(
            f"a formula of the scene is not finite at {place}; change the potential, the noise or g"
        )
    return values


def start_row(scene: Scene, axes: Mapping[sympy.Symbol, Axis], side: int = 1) -> np.ndarray:
    """Row vector that interpolates functions on a tensor grid at the start, or at its mirror image.

    Parameters
    ----------
    scene : Scene
    axes : dict
        As for `evaluate`.
    side : {1, -1}

    Returns
    -------
    numpy.ndarray, shape (number of grid points,)
    """
    start = [side * scene.start.get(symbol.name, 0.0) for symbol in axes]
    parts = [axis.interpolation(z) for axis, z in zip(axes.values(), start, strict=True)]
    return reduce(np.kron, [part.toarray()[0] for part in parts])


def at_points(
    values: np.ndarray,
    axes: Mapping[sympy.Symbol, Axis],
    points: Mapping[sympy.Symbol, np.ndarray],
) -> np.ndarray:
    """Interpolate a function on a tensor grid at points anywhere in the state.

    Parameters
    ----------
    values : numpy.ndarray, shape (number of grid points,)
    axes : dict
        As for `evaluate`.
    points : dict
        Maps each symbol to an array of shape (m,).

    Returns
    -------
    numpy.ndarray, shape (m,)
        0 outside the grid.
    """
    rows = [_padded(axis.interpolation(points[symbol])) for symbol, axis in axes.items()]
    found = np.empty(len(rows[0][0]))
    for begin in range(0, len(found), _BATCH):
        some = slice(begin, begin + _BATCH)
        nodes = np.zeros((len(found[some]), 1), dtype=int)
        for axis, (columns, _) in zip(axes.values(), rows, strict=True):
            further = nodes[:, :, None] * len(axis.nodes) + columns[some, None, :]
            nodes = further.reshape(len(nodes), -1)
        left = values[nodes]
        for _, weights in rows:  # one variable after the other
            blocks = left.reshape(len(left), weights.shape[1], -1)
            left = (weights[some, None, :] @ blocks)[:, 0]
        found[some] = left[:, 0]
    return found


def _padded(matrix):
    """Columns and entries of a sparse matrix, with zeros where a row has fewer than others."""
    counts = np.diff(matrix.indptr)
    kept = np.arange(np.max(counts, initial=1)) < counts[:, None]
    columns, entries = np.zeros(kept.shape, dtype=int), np.zeros(kept.shape)
    columns[kept], entries[kept] = matrix.indices, matrix.data
    return columns, entries


@dataclass(frozen=True)
class Change:
    """Derivatives of a scene's equations with respect to a parameter.

    Attributes
    ----------
    drift : dict
        Maps symbols to the derivatives of their drifts, formulas in the state.
    diffusion : float
        Derivative of sigma^2 / 2.
    """

    drift: Mapping[sympy.Symbol, sympy.Expr]
    diffusion: float


def assemble(
    scene: Scene,
    axes: Mapping[sympy.Symbol, Axis],
    equations: Container[sympy.Symbol] | None = None,
    change: Change | None = None,
) -> sp.csr_array:
    """Assemble the generator, the part of it that belongs to some equations, or its derivative.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    axes : dict
        Maps symbols to `Axis`; the first varies slowest.
    equations : container of sympy.Symbol, optional
        The variables whose drift and diffusion are included; all unless given.
    change : Change, optional
        Of the scene; the derivative of the generator is assembled instead.

    Returns
    -------
    scipy.sparse.csr_array, shape (grid points, grid points)
        Its rows sum to zero.
    """
    drift = scene.numerical_drift()
    own = change or Change(drift, scene.noise.sigma**2 / 2)
    size = [len(axis.nodes) for axis in axes.values()]
    generator = sp.csr_array((np.prod(size), np.prod(size)))
    for place, symbol in enumerate(axes):
        if equations is not None and symbol not in equations:
            continue
        axis, rate = axes[symbol], sympy.sympify(drift[symbol])

        def spread(matrix, place=place):
            return _kron(size[:place], matrix, size[place + 1 :])

        speed, value = evaluate(rate, axes), sympy.sympify(own.drift[symbol])
        moved = speed if change is None else _at_nodes(value, axes, symbol)
        generator += sp.diags_array(moved) @ spread(axis.slope)
        if symbol == scene.noise.driven:
            # where the drift leads inward, a condition at the end would make a layer there
            inward = (speed * evaluate(symbol, axes) < 0).astype(float)
            diffusion = spread(axis.curvature) + sp.diags_array(inward) @ spread(axis.release)
            generator += own.diffusion * diffusion
        if len(axis.faces):
            across = evaluate(rate, axes, {symbol: axis.faces})
            flow, jump = evaluate(value, axes, {symbol: axis.faces}), spread(axis.jump)
            for lift, side in (
                (axis.lift_left, np.where(across > 0, flow, 0.0)),
                (axis.lift_right, np.where(across < 0, flow, 0.0)),
            ):
                generator += spread(lift) @ (sp.diags_array(side) @ jump)
    return generator.tocsr()


def _at_nodes(rate, axes, symbol):
    """Values of the derivative of a drift at the nodes.

    It may jump at an edge that continuous elements share. There it is the mean of both
    sides, with the widths of the elements as weights, as they have them in the slope.
    """
    axis = axes[symbol]
    values = evaluate(rate, axes)
    if axis.curvature is None or not rate.has(sympy.Piecewise):
        return values
    near = _SIDE * np.min(np.diff(axis.edges))
    sides = [evaluate(rate, axes, {symbol: axis.nodes + side * near}) for side in (-1, 1)]
    widths = np.diff(axis.edges)
    share = np.full(len(axis.nodes), 0.5)
    share[:: len(axis.local[0]) - 1] = np.concatenate(
        [[0.0], widths[:-1] / (widths[:-1] + widths[1:]), [1.0]]
    )
    place = list(axes).index(symbol)
    lengths = [len(other.nodes) for other in axes.values()]
    shape = [1] * len(lengths)
    shape[place] = -1
    share = np.broadcast_to(share.reshape(shape), lengths).ravel()
    mean = share * sides[0] + (1 - share) * sides[1]
    jumps = np.abs(sides[1] - sides[0]) > _JUMP * np.max(np.abs(values))
    return np.where(jumps, mean, values)


def _kron(before, matrix, after):
    factors = (sp.eye_array(int(np.prod(before))), matrix, sp.eye_array(int(np.prod(after))))
    return reduce(lambda left, right: sp.kron(left, right, format="csr"), factors)
