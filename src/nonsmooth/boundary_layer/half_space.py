"""The Milne problem of two variables and its adjoint on one tensor grid.

At the upper threshold A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and
q ~ kappa - x - u as x -> -inf. The adjoint problem is that of the reversed motion, with the adjoint
of A in L^2(m), m being the invariant density. It is solved for m q, which needs no division by
masses that are rounding in the tails: A becomes its transpose, the constants become m. Reflected,
it has the same conditions at x = 0, and by conservation of the flux E[g q q*] the same kappa.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from nonsmooth.boundary_layer import tuning
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid, direct_solver
from nonsmooth.linear_algebra.sylvester import sylvester
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Layer:
    """What decays in the solution as x -> -inf: d(x) = e(x) + o(x), even and odd in the state.

    All decaying solutions are e = E w', o = O w with w' = dw/dx, and w(x) = exp(R^-1 x) w(0).

    Attributes
    ----------
    kappa : float
    u : numpy.ndarray, shape (nodes,)
        The Poisson solution, times m in the adjoint problem.
    even : numpy.ndarray, shape (nodes, modes)
        E.
    odd : numpy.ndarray, shape (nodes, modes)
        O.
    root : numpy.ndarray, shape (modes, modes)
        R.
    strengths : numpy.ndarray, shape (modes,)
        R^-1 w(0).
    """

    kappa: float
    u: np.ndarray
    even: np.ndarray
    odd: np.ndarray
    root: np.ndarray
    strengths: np.ndarray

    @property
    def start(self) -> np.ndarray:
        """w(0), shape (modes,)."""
        return self.root @ self.strengths


def size(scene: Scene, grid: Grid) -> int:
    """Count the nodes with g != 0 on half of a grid."""
    axes, solve = direct_solver(scene, grid)
    return len(_moving(solve.fold(evaluate(scene.numerical_observable(), axes))))


def _moving(g):
    """Return the places of the nodes with g != 0."""
    return np.flatnonzero(np.abs(g) > tuning.TWO_VARIABLES.zero * np.max(np.abs(g)))


def constants(scene: Scene, grid: Grid, higher: bool) -> np.ndarray:
    """Return kappa, and for the orders 2 and 3 the dipole S and kappa3.

    Parameters
    ----------
    scene : Scene
        With two variables, finite n, odd g and drift.
    grid : Grid
    higher : bool
        Whether the last two are wanted; they take three times as long.

    Returns
    -------
    numpy.ndarray, shape (1,) or (3,)

    Raises
    ------
    ToleranceError
        If the grid is too coarse.
    """
    masses, solutions = solved(scene, grid)
    layer = next(solutions)
    if not higher:
        return np.array([layer.kappa])
    return np.array([layer.kappa, *_integrals(layer, next(solutions), masses)])


def solved(scene: Scene, grid: Grid) -> tuple[np.ndarray, Iterator[Layer]]:
    """Solve the Milne problem, and its adjoint.

    Parameters
    ----------
    scene, grid
        As for `constants`.

    Returns
    -------
    masses : numpy.ndarray, shape (nodes,)
        Of the invariant measure, on half of the grid, with those of the other half.
    solutions : iterator
        Yields the solution, and then that of the adjoint problem, reflected and times m.

    Raises
    ------
    ToleranceError
        If the grid is too coarse.
    """
    axes, solve = direct_solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    # upwinding may make masses negative in the tails
    masses = 2 * solve.fold(solve.stationary())
    ones = np.ones(len(masses))
    odd, even = (-solve.matrix(parity).toarray() for parity in (ODD, EVEN))
    border = np.block([[even, ones[:, None]], [masses, np.zeros(1)]])
    smallest = tuning.TWO_VARIABLES.smallest_scale * np.max(np.abs(masses))
    weights = np.maximum(np.abs(masses), smallest)
    problems = (odd, border, ones, masses, weights), (odd.T, border.T, masses, ones, 1 / weights)
    return masses, (_layer(g, *problem) for problem in problems)


def _layer(g, odd_matrix, even_matrix, constant, mean, weights) -> Layer:
    """Solve the Milne problem of a matrix whose kernel is `constant`, and mean @ A = 0.

    The solution is kappa - x - u and the modes that decay as x -> -inf: (e + o) exp(mu x) with
    -A o = mu g e and -A e = mu g o. They carry no flux, E[g o] = 0, which fixes the constant in e.
    With the inverses of -A on odd and on even functions, each applied to g times a function (`odd`
    and `even`), o = mu odd e and e = mu even o. So K = odd even has the eigenvalues 1/mu^2 on o,
    and all modes together are e = even w, o = K^(1/2) w, with the principal square root and any w.
    Eigenvectors would lose up to all digits, for K is not self-adjoint.
    """
    kept = _moving(g)
    source = np.zeros((len(g), len(kept)))
    source[kept, np.arange(len(kept))] = g[kept]
    odd = np.linalg.solve(odd_matrix, source)
    u = odd @ constant[kept]
    flow = (mean * g)[kept]
    diffusion = flow @ u[kept]
    if diffusion <= 0:
        raise ToleranceError("a grid is too coarse for the diffusion of int g")
    even = np.linalg.solve(even_matrix, np.vstack([source, np.zeros((1, len(kept)))]))[:-1]
    even = even - np.outer(constant, (flow @ odd[kept]) / diffusion @ even[kept])
    # scaled as if A were self-adjoint
    sign, rows = np.sign(g[kept]), np.sqrt(weights[kept])
    scale = 1 / np.sqrt(weights[kept] * np.abs(g[kept]))
    without_flux = scipy.linalg.qr((flow * scale)[:, None])[0][:, 1:]
    product = (odd[kept] @ even[kept]) * scale / scale[:, None]
    # imaginary parts come from modes in the tails that the grid does not resolve: other grids show
    # how much they matter
    root = np.real(scipy.linalg.sqrtm(without_flux.T @ product @ without_flux))
    if not np.all(np.isfinite(root)):
        raise ToleranceError("the discretised Milne problem is singular in double precision")
    shapes = scale[:, None] * without_flux
    decaying = even @ shapes
    leaving = decaying[kept] + (sign * scale)[:, None] * (without_flux @ root)
    matrix = rows[:, None] * np.column_stack([constant[kept], leaving])
    norms = np.linalg.norm(matrix, axis=0)
    kappa, *strengths = np.linalg.solve(matrix / norms, rows * sign * u[kept]) / norms
    return Layer(kappa, u, decaying, _everywhere(odd, kept, shapes), root, np.array(strengths))


def _everywhere(odd, kept, shapes):
    """Continue odd parts of modes to the nodes with g = 0, where -A o = 0."""
    found = np.empty((len(odd), shapes.shape[1]))
    found[kept] = shapes
    rest = np.delete(np.arange(len(odd)), kept)
    if len(rest):
        found[rest] = odd[rest] @ np.linalg.solve(odd[kept], shapes)
    return found


def _integrals(layer, adjoint, masses):
    """Return the dipole S and kappa3, from integrals over x < 0 of products of both solutions.

    With E* = m times the even part of the adjoint solution, and so on, the reflection d* of its
    decaying part has the even part E* and the odd part -O*.
    """
    kappa, square = layer.kappa, adjoint.u @ layer.u
    means, adjoint_means = masses @ layer.even, adjoint.even.sum(axis=0)
    dipole = square - kappa**2 / 2 + adjoint_means @ adjoint.start
    # of (kappa - x) (E d + E d*)
    moments = sum(
        mean @ (kappa * one.start + one.root @ one.start)
        for mean, one in ((means, layer), (adjoint_means, adjoint))
    )
    # of E[u* d] - E[u d*]
    crossed = adjoint.u @ layer.odd @ (layer.root @ layer.start)
    crossed += layer.u @ adjoint.odd @ (adjoint.root @ adjoint.start)
    # of E[d d*] = w'^T E^T E* w*' - w^T O^T O* w*; Z is the integral of both if w(0) = R
    odd = layer.root.T @ (layer.odd.T @ adjoint.odd) @ adjoint.root
    overlap = layer.root.T @ (layer.even.T @ adjoint.even - odd) @ adjoint.root
    overlap = sylvester(layer.root.T, adjoint.root, overlap)
    products = layer.strengths @ overlap @ adjoint.strengths
    return dipole, square * kappa - kappa**3 / 3 + moments + crossed + products
