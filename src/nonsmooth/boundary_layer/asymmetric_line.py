"""The Milne problem at the two walls of a scene with the state y, for a g without symmetry.

At the upper wall A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and q ~ kappa - x - u as
x -> -inf, u the Poisson solution of g; at the lower, its mirror image.
"""

from dataclasses import astuple, dataclass

import numpy as np
import scipy.linalg

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.line import quadrature

_DEGREES = (7, 9, 11, 13, 15, 17, 20)
_CENTRED = 1e-9  # largest mean of g, relative to its standard deviation


@dataclass(frozen=True)
class Walls:
    """Constants of the expansion to the order 1/p, of a self-adjoint generator.

    Attributes
    ----------
    diffusion : float
        D = gamma^2 / 2.
    lower, upper : float
        kappa of either wall; upper - lower = C / D.
    skewness : float
        C = E[g u^2]; the third cumulant of int_0^t g grows like 6 C t.
    dispersion : float
        B = E[g r]; the logarithm of E exp(q int_0^t g) grows like (D q^2 + C q^3 + B q^4) t.
    lower_corner, upper_corner : float
        S, the dipole that the start of time leaves at either wall.
    poisson, start : float
        u and h at the start; A u = -g, A h = D - g u, A r = D u + C - g h.
    """

    diffusion: float
    lower: float
    upper: float
    skewness: float
    dispersion: float
    lower_corner: float
    upper_corner: float
    poisson: float
    start: float


def walls(scene, tol=1e-8):
    """Compute the constants of both walls.

    Parameters
    ----------
    scene : Scene
        With the state y, white noise, and E g = 0; g not odd, whose grid would be halved.
    tol : float
        Absolute error wanted of all constants.

    Returns
    -------
    constants, errors : Walls
        The errors are the differences of two polynomial degrees.

    Raises
    ------
    SceneError
        If the stationary mean of g is not 0.
    ToleranceError
        If `tol` is not met; the message has the best values and their error.
    """
    mean = quadrature.mean(scene)[0]
    values = _walls(scene, _DEGREES[0], mean)
    for degree in _DEGREES[1:]:
        previous, values = values, _walls(scene, degree, mean)
        errors = np.abs(np.subtract(astuple(values), astuple(previous)))
        if errors.max() <= tol:
            return values, Walls(*(float(error) for error in errors))
    raise ToleranceError(
        f"kappa = {values.lower:.10g}, {values.upper:.10g} and the other constants have errors up "
        f"to {errors.max():.1e}, above tol = {tol:g}; loosen tol"
    )


def _walls(scene, degree, mean):
    """Solve by the modes that decay from each wall; 1 and x + u are apart.

    Modes (a + psi) exp(mu x), psi = 0 at one node, satisfy K psi = mu M g (a + psi) and carry no
    flux, E[g psi] = 0. With the Cholesky factor of K they are eigenvectors of a symmetric matrix on
    the complement of the flux, 1/mu its eigenvalues, and its row along the flux is a.
    """
    grid = ordinates(scene, degree)
    spread = np.sqrt(grid.masses @ grid.g**2)
    if abs(mean) > _CENTRED * spread:
        raise SceneError(
            f"the extrapolation length needs E g = 0, but g = {scene.observable!r} has the mean "
            f"{mean:.10g}; subtract it from g"
        )
    rest = np.delete(np.arange(len(grid.g)), np.argmax(grid.masses))
    # what the quadrature leaves of the mean
    g = grid.g - np.where(grid.g == 0, 0.0, grid.masses @ grid.g)
    weights = grid.masses[rest] * g[rest]
    factor = scipy.linalg.cholesky(grid.stiffness[EVEN][np.ix_(rest, rest)], lower=True)

    def forward(values):
        return scipy.linalg.solve_triangular(factor, values, lower=True)

    def spread_out(values):
        """Functions on the whole grid, 0 at the node left out."""
        found = np.zeros((len(grid.g), *values.shape[1:]))
        found[rest] = scipy.linalg.solve_triangular(factor, values, lower=True, trans="T")
        return found

    flux = forward(weights)
    diffusion = flux @ flux
    coupling = forward(forward(np.diag(weights)).T)
    complement = scipy.linalg.qr(flux[:, None])[0][:, 1:]
    inverses, vectors = np.linalg.eigh(complement.T @ coupling @ complement)
    vectors = complement @ vectors
    modes = spread_out(vectors) - (flux @ coupling @ vectors) / diffusion
    u = spread_out(flux)
    u = u - grid.masses @ u
    h = grid.resolvent(0.0, EVEN, (g * u)[:, None])[:, 0]
    skewness, square = grid.masses @ (g * u**2), grid.masses @ u**2
    r = grid.resolvent(0.0, EVEN, (g * h - diffusion * u)[:, None])[:, 0]
    means = grid.masses @ modes
    lengths, corners = [], []
    for side in (-1, 1):
        leaving = np.flatnonzero(side * g > 0)
        decaying = np.argsort(-side * inverses)[: len(leaving) - 1]
        scale = np.sqrt(grid.masses[leaving])
        matrix = np.column_stack([np.ones(len(leaving)), modes[np.ix_(leaving, decaying)]])
        solution = np.linalg.solve(scale[:, None] * matrix, scale * side * u[leaving])
        dipole = (means * np.abs(inverses))[decaying] @ solution[1:]
        lengths.append(float(solution[0]))
        # of the other wall, whose layer, reflected, solves the adjoint problem at this one
        corners.append(
            float(square - solution[0] ** 2 / 2 + dipole - (skewness / diffusion) ** 2 / 2)
        )
    return Walls(
        float(diffusion),
        *lengths,
        float(skewness),
        float(grid.masses @ (g * r)),
        *corners[::-1],
        float(grid.start[EVEN] @ u),
        float(grid.start[EVEN] @ h),
    )
