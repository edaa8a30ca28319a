"""Eigenfunctions of the generator of a scene with one state variable, and moments of int_0^t g.

A = (sigma^2/2) d_yy - b d_y is self-adjoint in L^2(m), so that -A has real eigenvalues lambda_k
and orthonormal eigenfunctions phi_k. They are those of the matrices of `spectral_elements`.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.line import tuning
from nonsmooth.line.spectral_elements import assemble, mesh
from nonsmooth.linear_algebra import dense
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of -A in L^2(m), and what is needed of the eigenfunctions.

    Attributes
    ----------
    rates : numpy.ndarray, shape (k,)
        Eigenvalues, increasing; the first is 0.
    observable : numpy.ndarray, shape (k,)
        Coefficients <g, phi_k> of the centred observable.
    product : numpy.ndarray, shape (k, k)
        <g phi_j, phi_k>, g centred.
    start : numpy.ndarray, shape (k,)
        phi_k at the starting point.
    """

    rates: np.ndarray
    observable: np.ndarray
    product: np.ndarray
    start: np.ndarray


def spectrum(scene: Scene, degree: int) -> Spectrum:
    """Solve the eigenproblem of -A.

    Parameters
    ----------
    scene : Scene
    degree : int
        Polynomial degree of the elements.

    Returns
    -------
    Spectrum

    Raises
    ------
    SceneError
        If the scene has another state or noise, starts too far out, or g is not finite.
    ToleranceError
        If entries of the matrices overflow.
    """
    nodes, mass, stiffness, observable = assemble(scene, degree)
    try:
        rates, vectors = modes(mass, stiffness, scene.damping)
    except np.linalg.LinAlgError:
        raise ToleranceError(
            f"the generator with C_b = {scene.damping:g}, n = {scene.n:g} and sigma = "
            f"{scene.noise.sigma:g} overflows in double precision; choose them closer to 1"
        ) from None
    start = vectors[np.argmin(np.abs(nodes - scene.start.get("y", 0.0)))]
    vectors, start = vectors * np.sign(start[0]), start * np.sign(start[0])  # so that phi_0 = 1
    product = vectors.T @ observable @ vectors
    product -= product[0, 0] * np.eye(len(rates))
    rates[0] = 0.0
    return Spectrum(rates, product[0], product, start)


def modes(mass: np.ndarray, stiffness: np.ndarray, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Solve K phi = lambda M phi.

    The equivalent M phi = nu (M + K/s) phi is solved, with nu = 1/(1 + lambda/s) and s of the size
    of the small eigenvalues. Rounding errors are then relative to these, which matter most, and not
    to the largest one.

    Parameters
    ----------
    mass, stiffness : numpy.ndarray, shape (k, k)
        M and K.
    scale : float
        s.

    Returns
    -------
    rates : numpy.ndarray, shape (m,)
        Increasing lambda, without those that consist of rounding.
    vectors : numpy.ndarray, shape (k, m)
        phi, of the norm 1 in L^2(m).

    Raises
    ------
    numpy.linalg.LinAlgError
        If entries of the matrices overflow.
    """
    shifted = mass + stiffness / scale
    balance = 1 / np.sqrt(np.diag(shifted))
    both = np.outer(balance, balance)
    nu, vectors = dense.eigh(mass * both, shifted * both)
    keep = nu > tuning.SPECTRAL_ELEMENTS.least_nu
    nu, vectors = nu[keep][::-1], vectors[:, keep][:, ::-1] * balance[:, None]
    return scale * (1 / nu - 1), vectors / np.sqrt(nu)


def mean(scene: Scene) -> float:
    """Return the mean of the observable under the invariant density."""
    return assemble(scene.with_start({}), tuning.SPECTRAL_ELEMENTS.degree_of_mean)[3].sum()


def rounding(scene: Scene, degree: int) -> float:
    """Bound the relative rounding error of all results.

    Entries of the stiffness matrix are of the size degree^2 / width and cancel when it is applied
    to smooth functions. Widths are in units of sigma C_b^(-1/2), over which these functions change.
    The factor in front was fitted, see `tuning.SPECTRAL_ELEMENTS`.
    """
    width = np.min(np.diff(mesh(scene))) * np.sqrt(scene.damping) / scene.noise.sigma
    factor = tuning.SPECTRAL_ELEMENTS.rounding
    return factor * np.finfo(float).eps * degree**2 * max(1.0, 1 / width)


def asymptotic_variance(scene: Scene, degree: int) -> float:
    """gamma^2 = 2 sum_k <g, phi_k>^2 / lambda_k."""
    s = spectrum(scene, degree)
    return 2 * np.sum(s.observable[1:] ** 2 / s.rates[1:])


def moments(scene: Scene, times: np.ndarray, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """w(start, tau) and v(start, tau), as from `moments_with_rounding`."""
    return moments_with_rounding(scene, times, degree)[:2]


def moments_with_rounding(
    scene: Scene, times: np.ndarray, degree: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """w(start, tau) of the centred observable and v(start, tau), eqs. (35), (36) of the paper.

    w is the mean of int_0^tau g and v its variance,

        v = 2 sum_jk g_k <g phi_k, phi_j> phi_j(start) I_jk - w^2,

    with the integrals I_jk = int_0^tau exp(-lambda_j s) (1 - exp(-lambda_k (tau - s))) / lambda_k
    ds. Each is the difference of two numbers that are right to two units of the last digit. At
    early times they nearly cancel, and so do the modes; what rounding then leaves in v is returned
    beside it.

    Parameters
    ----------
    scene : Scene
    times : numpy.ndarray, shape (t,)
    degree : int
        Polynomial degree of the elements.

    Returns
    -------
    w, v, rounding : numpy.ndarray, shape (t,)

    Raises
    ------
    SceneError, ToleranceError
        As from `spectrum`.
    """
    s = spectrum(scene, degree)
    rate, g = s.rates[1:], s.observable[1:]
    weight = 2 * (g / rate)[:, None] * s.product[1:] * s.start  # (k, j)
    gap = np.abs(rate[:, None] - s.rates)
    slow = np.minimum(rate[:, None], s.rates)
    size = np.abs(weight).sum(axis=0)
    w, v, rounding = np.empty((3, len(times)))
    for i, tau in enumerate(times):
        w[i] = np.sum(g * s.start[1:] * _decayed(rate, tau))
        overlap = np.exp(-slow * tau) * _decayed(gap, tau)
        v[i] = np.sum(weight * (_decayed(s.rates, tau) - overlap)) - w[i] ** 2
        rounding[i] = 4 * np.finfo(float).eps * (size @ _decayed(s.rates, tau))
    return w, v, rounding


def _decayed(rate, tau):
    """Integral of exp(-rate s) over [0, tau]; tau where the rate is 0."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(rate * tau < np.finfo(float).eps, tau, -np.expm1(-rate * tau) / rate)
