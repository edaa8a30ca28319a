"""The Milne problem of one variable with white noise and odd g, on half of the line.

At the upper threshold A q + g d_x q = 0 for x < 0, q = 0 at x = 0 where g > 0, and
q ~ kappa - x - u as x -> -inf, where A u = -g. `docs/methods/boundary_layer.md` has the derivation.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from nonsmooth.boundary_layer import tuning
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.ordinates_line import Ordinates, ordinates
from nonsmooth.linear_algebra.dense import backward, cholesky, forward, svd
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene


def applies(scene: Scene) -> bool:
    """Whether the scene has the state y, white noise, and odd g and drift."""
    return scene.is_line and scene.is_odd()


def layer_constants(
    scene: Scene, tol: float | None = None
) -> tuple[LayerConstants, LayerConstants]:
    """Compute all constants, up to the order 3.

    Parameters
    ----------
    scene : Scene
        To which this `applies`.
    tol : float, optional
        Absolute error wanted of kappa, and of the other constants times the largest of them if that
        is above 1; 1e-8 unless given.

    Returns
    -------
    constants, errors : LayerConstants
        The errors are the differences of the results of two polynomial degrees.

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    if not applies(scene):
        raise SceneError(
            f"the constants of second order are computed for the state (y), white noise and odd g, "
            f"not for ({', '.join(scene.state)}) with {scene.noise.title} and g = "
            f"{quoted(scene.observable)}; choose such a scene"
        )
    tol = tuning.LINE.accuracy if tol is None else tol

    found = until_agreement(
        tuning.LINE.degrees,
        lambda degree: _on_degree(scene, degree),
        lambda levels: levels[-1].distance(levels[-2]),
        lambda values, errors: errors.meets(tol, values),
    )
    values, errors = found.value, found.error
    if not found.met:
        raise ToleranceError(
            f"kappa = {values.kappa[1]:.10g} has an error of {errors.kappa[1]:.1e} and the other "
            f"constants up to {errors.largest():.1e}, above tol = {tol:g}; loosen tol",
            (values, errors),
        )
    return values, errors


@dataclass(frozen=True)
class _Milne:
    """The solution q = kappa - x - u + d of the Milne problem, d a sum of modes that decay.

    The mode j has the even part `even[:, j]` and the odd part `odd[:, j]`, both times its strength
    in q, and decays like exp(x / inverses[j]). The first node of the even parts is the origin. The
    odd parts and u are 0 there and leave it out.
    """

    diffusion: float
    kappa: float
    u: np.ndarray
    inverses: np.ndarray
    even: np.ndarray
    odd: np.ndarray
    means: np.ndarray


def _milne(grid: Ordinates) -> _Milne:
    """Solve by the modes that decay as x -> -inf; the solutions 1 and x + u do not decay.

    Modes (e + o) exp(mu x) of even e = a + psi, psi = 0 at the origin, and odd o satisfy
    K_o o = mu M g e and K_e psi = mu M g o, with the stiffness matrices K and the masses M, and
    carry no flux, E[g o] = 0, which fixes the constant a. With Cholesky factors of the stiffness
    matrices they are the singular vectors of one matrix, whose singular values are 1/mu.
    """
    inner = slice(1, None)  # without the origin
    kept = np.flatnonzero(grid.g[inner])
    g, weights = grid.g[inner], grid.masses[inner]
    odd, even = (cholesky(grid.stiffness[parity][inner, inner]) for parity in (ODD, EVEN))

    flux = forward(odd, weights * g)
    u = backward(odd, flux)
    diffusion = flux @ flux
    coupling = forward(even, forward(odd, np.diag(weights * g)).T).T
    complement = scipy.linalg.qr(flux[:, None])[0][:, 1:]
    left, inverses, right = svd(complement.T @ coupling)
    used = len(kept) - 1
    inverses = inverses[:used]
    odd_parts = backward(odd, complement @ left[:, :used])
    even_parts = backward(even, right[:used].T)
    constant = -(flux @ coupling @ right[:used].T) / diffusion
    # q = 0 where g > 0, scaled so that the equations are those of L^2(m)
    leaving = constant + even_parts + np.sign(g)[:, None] * odd_parts
    rows = np.sqrt(weights[kept])
    solution = np.linalg.solve(
        rows[:, None] * np.column_stack([np.ones(len(kept)), leaving[kept]]),
        rows * (np.sign(g) * u)[kept],
    )
    kappa, strengths = solution[0], solution[1:]
    return _Milne(
        diffusion,
        kappa,
        u,
        inverses,
        even=strengths * np.vstack([constant, constant + even_parts]),
        odd=strengths * odd_parts,
        means=strengths * (constant + weights @ even_parts),
    )


def _on_degree(scene: Scene, degree: int) -> LayerConstants:
    """Integrate the solution of the Milne problem.

    kappa3 comes from the solution q and its reflection q*(x, y) = q(x, -y). The next order,
    A q_2 + g d_x q_2 = - D q, has d_x E[g q_2 q*] = - D E[q q*], and E[g q_2 q*] is 0 at the
    threshold.
    """
    grid = ordinates(scene, degree)
    milne = _milne(grid)
    inner = slice(1, None)
    g, weights = grid.g[inner], grid.masses[inner]
    diffusion, kappa, u, inverses = milne.diffusion, milne.kappa, milne.u, milne.inverses
    # integrals over x < 0: of E d, of 2 (kappa - x) E d + 2 E[u d], and of E[d d*]
    dipole = milne.means @ inverses
    moments = 2 * (
        milne.means @ (inverses * (kappa + inverses)) + (weights * u) @ milne.odd @ inverses
    )
    overlaps = milne.even.T @ (grid.masses[:, None] * milne.even) - milne.odd.T @ (
        weights[:, None] * milne.odd
    )
    decays = np.outer(inverses, inverses) / np.add.outer(inverses, inverses)
    square = weights @ u**2
    h = grid.resolvent(0.0, EVEN, np.append(0.0, g * u)[:, None])[:, 0]
    source = np.append(0.0, g * h[inner] - diffusion * u)
    r = grid.resolvent(0.0, ODD, source[:, None])[inner, 0]
    both = float(square - kappa**2 / 2 + dipole)
    kappa3 = float(square * kappa - kappa**3 / 3 + moments + np.sum(overlaps * decays))
    return LayerConstants(
        diffusion=float(diffusion),
        kappa=(float(kappa), float(kappa)),
        u=float(grid.start[ODD][inner] @ u),
        dispersion=float(np.sum(weights * g * r)),
        dipole=(both, both),
        h=float(grid.start[EVEN] @ h),
        kappa3=(kappa3, kappa3),
        r=float(grid.start[ODD][inner] @ r),
    )
