"""The Milne problem at a threshold, and the constants of the corrected asymptotic formula.

A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and q ~ kappa - x - u as x -> -inf, u the
Poisson solution of g: int g, which is differentiable, behaves towards a threshold b like a Brownian
motion towards b + kappa.
"""

from dataclasses import astuple, dataclass

import numpy as np
import scipy.linalg

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.ordinates_line import ordinates

EXACT = 1e-8
_DEGREES = (7, 9, 11, 13, 15, 17, 20)


@dataclass(frozen=True)
class Expansion:
    """Constants of the expansion in p^(-1/2), of a self-adjoint generator and odd g.

    Attributes
    ----------
    diffusion : float
        D = gamma^2 / 2.
    length : float
        kappa, the extrapolation length.
    dispersion : float
        B = E[g r]: long waves decay at the rate D k^2 - B k^4 / p.
    corner : float
        S, the dipole that the start of time leaves at the thresholds.
    stretch : float
        kappa_3: waves of the wave number k see the length kappa + kappa_3 k^2 / p.
    poisson, start, third : float
        u, h and r at the start; A u = -g, A h = D - g u, A r = D u - g h.
    """

    diffusion: float
    length: float
    dispersion: float
    corner: float
    stretch: float
    poisson: float
    start: float
    third: float


_LENGTH = list(Expansion.__dataclass_fields__).index("length")


def expansion(scene, tol=EXACT):
    """Compute the constants of the corrected asymptotic formula.

    Parameters
    ----------
    scene, tol
        The state y, white noise and odd g; absolute error wanted of kappa, and of the other
        constants relative to the largest of all, if that is above 1.

    Returns
    -------
    constants, errors : Expansion

    Raises
    ------
    SceneError, ToleranceError
        As `extrapolation_length`.
    """
    if not (scene.is_line and scene.is_odd()):
        raise SceneError(
            f"the constants of second order are computed for the state (y), white noise and odd g, "
            f"not for ({', '.join(scene.state)}) with {scene.noise.title} and g = "
            f"{scene.observable!r}; choose such a scene"
        )
    values = _expansion(scene, _DEGREES[0])
    for degree in _DEGREES[1:]:
        previous, values = values, _expansion(scene, degree)
        errors = np.abs(np.subtract(astuple(values), astuple(previous)))
        allowed = tol * max(1.0, np.max(np.abs(astuple(values))))
        if errors.max() <= allowed and errors[_LENGTH] <= tol:
            return values, Expansion(*(float(error) for error in errors))
    raise ToleranceError(
        f"kappa = {values.length:.10g} has an error of {errors[_LENGTH]:.1e} and the other "
        f"constants up to {errors.max():.1e}, above tol = {tol:g}; loosen tol"
    )


def _expansion(scene, degree):
    """Solve the Milne problem by the modes that decay as x -> -inf; 1 and x + u are apart.

    Modes (e + o) exp(mu x) of even e = a + psi, psi = 0 at the origin, and odd o satisfy
    K_o o = mu M g e, K_e psi = mu M g o, and carry no flux, E[g o] = 0, which fixes a. With
    Cholesky factors of the stiffness matrices they are the singular vectors of one matrix, and
    1/mu its singular values.

    kappa_3 comes from the solution M of the Milne problem and its reflection M*(xi, y) = M(xi, -y):
    the next order, A M_2 + g d_xi M_2 = - D M, has d_xi E[g M_2 M*] = - D E[M M*], and E[g M_2 M*]
    is 0 at the wall.
    """
    grid = ordinates(scene, degree)
    inner = slice(1, None)  # without the origin
    kept = np.flatnonzero(grid.g[inner])
    g, weights = grid.g[inner], grid.masses[inner]
    odd, even = (
        scipy.linalg.cholesky(grid.stiffness[parity][inner, inner], lower=True)
        for parity in (ODD, EVEN)
    )

    def forward(factor, values):
        return scipy.linalg.solve_triangular(factor, values, lower=True)

    def backward(factor, values):
        return scipy.linalg.solve_triangular(factor, values, lower=True, trans="T")

    flux = forward(odd, weights * g)
    u = backward(odd, flux)
    diffusion = flux @ flux
    coupling = forward(even, forward(odd, np.diag(weights * g)).T).T
    complement = scipy.linalg.qr(flux[:, None])[0][:, 1:]
    left, inverses, right = scipy.linalg.svd(complement.T @ coupling, full_matrices=False)
    used = len(kept) - 1
    inverses = inverses[:used]
    odd_parts = backward(odd, complement @ left[:, :used])
    even_parts = backward(even, right[:used].T)
    constant = -(flux @ coupling @ right[:used].T) / diffusion
    leaving = constant + even_parts + np.sign(g)[:, None] * odd_parts
    rows = np.sqrt(weights[kept])
    solution = np.linalg.solve(
        rows[:, None] * np.column_stack([np.ones(len(kept)), leaving[kept]]),
        rows * (np.sign(g) * u)[kept],
    )
    length, strengths = solution[0], solution[1:]
    # of the layer's modes, with their strengths: the mean, the even and the odd part
    means = strengths * (constant + weights @ even_parts)
    even_layer = strengths * np.vstack([constant, constant + even_parts])
    odd_layer = strengths * odd_parts
    # integrals over xi < 0: of the mean of the layer d; of 2 (kappa - xi) d + 2 u d; and of d d*
    dipole = means @ inverses
    moments = 2 * (means @ (inverses * (length + inverses)) + (weights * u) @ odd_layer @ inverses)
    overlaps = even_layer.T @ (grid.masses[:, None] * even_layer) - odd_layer.T @ (
        weights[:, None] * odd_layer
    )
    decays = np.outer(inverses, inverses) / np.add.outer(inverses, inverses)
    square = weights @ u**2

    def centred_even(values):
        return grid.resolvent(0.0, EVEN, values[:, None])[:, 0]

    h = centred_even(np.append(0.0, g * u))
    r = grid.resolvent(0.0, ODD, np.append(0.0, g * h[inner] - diffusion * u)[:, None])[inner, 0]
    return Expansion(
        float(diffusion),
        float(length),
        float(np.sum(weights * g * r)),
        float(square - length**2 / 2 + dipole),
        float(square * length - length**3 / 3 + moments + np.sum(overlaps * decays)),
        float(grid.start[ODD][inner] @ u),
        float(grid.start[EVEN] @ h),
        float(grid.start[ODD][inner] @ r),
    )
