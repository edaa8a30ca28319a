"""The Milne problem at both thresholds, for one variable with white noise and a g without symmetry.

At the upper threshold A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and
q ~ kappa - x - u as x -> -inf, where A u = -g; at the lower one, its mirror image.
`docs/methods/boundary_layer.md` has the derivation.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.linalg

from nonsmooth.boundary_layer import tuning
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.ordinates_line import Ordinates, ordinates
from nonsmooth.line import quadrature
from nonsmooth.linear_algebra.dense import backward, cholesky, forward
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene


def applies(scene: Scene) -> bool:
    """Whether the scene has the state y and white noise, and g or the drift is not odd."""
    return scene.is_line and not scene.is_odd()


def layer_constants(
    scene: Scene, tol: float | None = None
) -> tuple[LayerConstants, LayerConstants]:
    """Compute the constants of both thresholds, up to the order 3.

    Parameters
    ----------
    scene : Scene
        To which this `applies`, with E g = 0. Scenes with odd g and drift are excluded because they
        are discretised on half of the line.
    tol : float, optional
        Absolute error wanted of both kappa, and of the other constants times the largest of them
        if that is above 1; 1e-8 unless given.

    Returns
    -------
    constants, errors : LayerConstants
        The errors are the differences of the results of two polynomial degrees.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the message has the best values and their error.
    """
    tol = tuning.LINE.accuracy if tol is None else tol
    found = until_agreement(
        tuning.LINE.degrees,
        lambda degree: _on_degree(scene, degree),
        lambda levels: levels[-1].distance(levels[-2]),
        lambda values, errors: errors.meets(tol, values),
    )
    if not found.met:
        lower, upper = found.value.kappa
        raise ToleranceError(
            f"kappa = {lower:.10g}, {upper:.10g} and the other constants have errors up "
            f"to {found.error.largest():.1e}, above tol = {tol:g}; loosen tol",
            (found.value, found.error),
        )
    return found.value, found.error


@dataclass(frozen=True)
class _Modes:
    """Modes exp(mu x) of the layers at both thresholds, and the Poisson solution u.

    The mode j is `shapes[:, j]`, with 1/mu = `inverses[j]`; those with mu > 0 decay from the upper
    threshold, the others from the lower one.
    """

    diffusion: float
    u: np.ndarray
    inverses: np.ndarray
    shapes: np.ndarray


def _modes(grid: Ordinates, g: np.ndarray) -> _Modes:
    """Compute the modes; the solutions 1 and x + u of the Milne equation do not decay.

    Modes (a + psi) exp(mu x), psi = 0 at one node, satisfy K psi = mu M g (a + psi), with the
    stiffness matrix K and the masses M, and carry no flux, E[g psi] = 0. With the Cholesky factor
    of K they are eigenvectors of a symmetric matrix, restricted to the complement of the flux; 1/mu
    are the eigenvalues. The component of the equation along the flux gives the constant a.
    """
    rest = np.delete(np.arange(len(grid.g)), np.argmax(grid.masses))
    weights = grid.masses[rest] * g[rest]
    factor = cholesky(grid.stiffness[EVEN][np.ix_(rest, rest)])

    def spread_out(values):
        """Functions on the whole grid, 0 at the node left out."""
        found = np.zeros((len(grid.g), *values.shape[1:]))
        found[rest] = backward(factor, values)
        return found

    flux = forward(factor, weights)
    diffusion = flux @ flux
    coupling = forward(factor, forward(factor, np.diag(weights)).T)
    complement = scipy.linalg.qr(flux[:, None])[0][:, 1:]
    inverses, vectors = np.linalg.eigh(complement.T @ coupling @ complement)
    vectors = complement @ vectors
    modes = spread_out(vectors) - (flux @ coupling @ vectors) / diffusion
    u = spread_out(flux)
    return _Modes(diffusion, u - grid.masses @ u, inverses, modes)


class _Layer(NamedTuple):
    """The solution q = kappa - |x| - side u + d of the Milne problem at one side, -1 or 1.

    The modes of d, `parts[:, j]` with their strengths, decay over the lengths `lengths[j]`.
    """

    kappa: float
    lengths: np.ndarray
    parts: np.ndarray


def _at_threshold(grid: Ordinates, g: np.ndarray, modes: _Modes, side: int) -> _Layer:
    """Solve the Milne problem at one side."""
    leaving = np.flatnonzero(side * g > 0)
    decaying = np.argsort(-side * modes.inverses)[: len(leaving) - 1]
    scale = np.sqrt(grid.masses[leaving])
    matrix = np.column_stack([np.ones(len(leaving)), modes.shapes[np.ix_(leaving, decaying)]])
    solution = np.linalg.solve(scale[:, None] * matrix, scale * side * modes.u[leaving])
    parts = modes.shapes[:, decaying] * solution[1:]
    return _Layer(float(solution[0]), np.abs(modes.inverses[decaying]), parts)


def mean(scene: Scene) -> float:
    """Return E g of a scene to which this `applies`; 0 if it is rounding."""
    value, grid = quadrature.mean(scene)[0], ordinates(scene, tuning.LINE.degrees[0])
    return value if abs(value) > tuning.LINE.centred * np.sqrt(grid.masses @ grid.g**2) else 0.0


def _on_degree(scene: Scene, degree: int) -> LayerConstants:
    """Solve both Milne problems on elements of one degree."""
    grid = ordinates(scene, degree)
    # subtract what the quadrature leaves of the mean
    g = grid.g - np.where(grid.g == 0, 0.0, grid.masses @ grid.g)
    modes, m = _modes(grid, g), grid.masses
    D, u = modes.diffusion, modes.u

    def solved(source):
        """Solve A f = -source, up to the mean of the source."""
        return grid.resolvent(0.0, EVEN, source[:, None])[:, 0]

    h = solved(g * u)
    skewness, square = m @ (g * u**2), m @ u**2
    r = solved(g * h - D * u)
    dispersion, c = m @ (g * r), skewness / D
    fifth = m @ (g * solved(g * r - D * h - skewness * u))
    # the layer of the other threshold, reflected, solves the adjoint problem at this one
    below, above = layers = [_at_threshold(grid, g, modes, side) for side in (-1, 1)]
    upper, lower = (
        float(square - layer.kappa**2 / 2 + m @ layer.parts @ layer.lengths - c**2 / 2)
        for layer in layers
    )
    overlap, odd = _overlap(m, u, below, above), (2 * c * dispersion - fifth) / D - m @ (u * h)

    def kappa3(side, kappa, other):
        even = overlap + kappa * square - kappa**3 / 3
        return float(even + side * (odd + c * other * (kappa + side * c) - c * kappa**2 / 2))

    return LayerConstants(
        diffusion=float(D),
        kappa=(below.kappa, above.kappa),
        u=float(grid.start[EVEN] @ u),
        skewness=float(skewness),
        dispersion=float(dispersion),
        dipole=(lower, upper),
        h=float(grid.start[EVEN] @ h),
        kappa3=(kappa3(-1, below.kappa, above.kappa), kappa3(1, above.kappa, below.kappa)),
        r=float(grid.start[EVEN] @ r),
        fifth=float(fifth),
    )


def _overlap(masses: np.ndarray, u: np.ndarray, below: _Layer, above: _Layer) -> float:
    """Integral over x < 0 of E[q q*] without its polynomial part; the same at both thresholds."""
    total = 0.0
    for layer, other, side in ((below, above, -1), (above, below, 1)):
        moments = layer.lengths * (other.kappa + layer.lengths)
        total += masses @ layer.parts @ moments + side * (masses * u) @ layer.parts @ layer.lengths
    decays = np.outer(below.lengths, above.lengths) / np.add.outer(below.lengths, above.lengths)
    overlaps = below.parts.T @ (masses[:, None] * above.parts)
    return float(total + np.sum(overlaps * decays))
