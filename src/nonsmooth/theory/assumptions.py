"""The constants of the paper's standing assumptions (HU1)-(HU5), (2), (T117) and (T120).

The assumptions say that constants exist. Here they are computed for given U, v, H and F. Suprema
are taken over a fine grid up to 1e6 and refined. The assumptions also hold with smaller lambda, r
or delta~ and with larger beta or M.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.linalg
import sympy
from scipy.optimize import minimize_scalar

from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.noises import Hamiltonian, Langevin
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, zeta
from nonsmooth.theory import tuning


@dataclass(frozen=True)
class Confinement:
    """Constants of (HU2), (HU3), (HU5) and of Claim 7 of the paper, for U (U_n for obstacles).

    Attributes
    ----------
    lambda_1, beta_1 : float
        U >= lambda_1 x^2 - beta_1 (HU2), "1".
    lambda_2, beta_2 : float
        x U' >= lambda_2 U - beta_2 (HU3), "1".
    steepest : float
        max |U'| on [-1, 1], "1".
    shift : float
        What is added to U so that U >= 0 (HU4), "1".
    """

    lambda_1: float
    beta_1: float
    lambda_2: float
    beta_2: float
    steepest: float
    shift: float

    @property
    def lambda_3(self) -> float:
        """Of (HU5): x U' >= lambda_3 (U + x^2) - beta_3."""
        return self.lambda_1 * self.lambda_2 / (1 + self.lambda_1)

    @property
    def beta_3(self) -> float:
        """Of (HU5)."""
        return self.beta_2 + self.lambda_2 * self.beta_1 / (1 + self.lambda_1)

    @property
    def beta_4(self) -> float:
        """Of Claim 7: sign(x) U'(x) >= -beta_4."""
        return max(self.beta_3, self.steepest)


@dataclass(frozen=True)
class Dissipation:
    """Constants of (T117) and (T120) for a quadratic H, with R = cross eta zeta.

    Attributes
    ----------
    rate, M : float
        delta~ and M, "1".
    stiffness, damping, cross : float
        k and gamma_0 of the noise, and the coefficient of R, "1".
    """

    rate: float
    M: float
    stiffness: float
    damping: float
    cross: float

    @property
    def energy(self) -> np.ndarray:
        """Matrix of the quadratic form H + R in (eta, zeta)."""
        return np.array([[self.stiffness, self.cross], [self.cross, 1.0]]) / 2

    @property
    def decay(self) -> np.ndarray:
        """Matrix of the quadratic part of -(1/2 d_zetazeta + B_1 d_zeta + B_2 d_eta)(H + R)."""
        c, gamma = self.cross, self.damping
        return np.array([[c * self.stiffness, c * gamma / 2], [c * gamma / 2, gamma - c]])


def potential(scene: Scene) -> tuple[sympy.Expr, sympy.Expr]:
    """Return U (U_n for obstacles, Table 3) and its derivative, expressions in x."""
    model = scene.mechanics
    number = {penalization: sympy.Float(scene.n)}
    slope = sympy.diff(scene.potential_expression, x)
    if model.in_potential:
        slope += model.penalty_force.subs(number)
    return scene.potential_expression + model.added_potential.subs(number), slope


def _line():
    """Return the grid on which suprema are taken: 0 and both signs of ever larger values."""
    chosen = tuning.ASSUMPTIONS
    end, count = chosen.equidistant
    positive = np.geomspace(chosen.nearest, chosen.farthest, chosen.logarithmic)
    positive = np.unique(np.concatenate([positive, np.linspace(0, end, count)]))
    return np.concatenate([-positive[::-1], [0.0], positive])


def _supremum(function):
    """Take the largest value on the grid and look for a larger one near it."""
    line = _line()
    values = function(line)
    best = int(np.argmax(values))
    around = line[max(best - 1, 0)], line[min(best + 1, len(line) - 1)]
    refined = minimize_scalar(lambda z: -float(function(np.array(z))), around, bounds=around)
    return max(float(values[best]), -float(refined.fun))


@lru_cache(maxsize=256)
def confinement(scene: Scene) -> Confinement:
    """Compute the constants of (HU1)-(HU5) of a scene's potential.

    lambda_1 and lambda_2 are half of what they could be at infinity.

    Parameters
    ----------
    scene : Scene
        With a finite n.

    Returns
    -------
    Confinement

    Raises
    ------
    SceneError
        If (HU1) or (HU2) does not hold.
    """
    U, slope = (vectorised(expression, (x,)) for expression in potential(scene))
    curvature = _curvature_at_infinity(scene, U, slope)
    chosen = tuning.ASSUMPTIONS
    far = np.array([-chosen.farthest, chosen.farthest])
    shift = max(0.0, _supremum(lambda z: -U(z)))

    def lifted(z):
        return U(z) + shift

    lambda_1 = curvature / 2
    lambda_2 = np.min(far * slope(far) / U(far)) / 2

    def least(function):
        return max(0.0, _supremum(function)) * (1 + chosen.safety) + chosen.positive

    inside = np.linspace(-1, 1, chosen.inside)
    steepest = float(np.max(np.abs(slope(inside)))) * (1 + chosen.inside_safety)
    return Confinement(
        lambda_1=float(lambda_1),
        beta_1=least(lambda z: lambda_1 * z**2 - lifted(z)),
        lambda_2=float(lambda_2),
        beta_2=least(lambda z: lambda_2 * lifted(z) - z * slope(z)),
        steepest=steepest + chosen.positive,
        shift=shift,
    )


def _curvature_at_infinity(scene, U, slope):
    """Return the limit of U / x^2, having checked (HU1) and (HU2)."""
    chosen = tuning.ASSUMPTIONS
    far = np.array([-chosen.farthest, chosen.farthest])
    with np.errstate(all="ignore"):
        curvature = np.min(U(far) / far**2)
        steep = np.max(np.abs(slope(far) / far))
        nearer = np.max(np.abs(slope(far / 10) / (far / 10)))
    if not (np.isfinite(steep) and steep <= 2 * nearer + chosen.quadratic):
        raise SceneError(
            f"U = {quoted(scene.potential)} violates (HU1), its derivative is not Lipschitz; "
            "use a potential of at most quadratic growth"
        )
    if not curvature > chosen.quadratic:
        raise SceneError(
            f"U = {quoted(scene.potential)} violates (HU2), U(x) >= c x**2 - C; "
            "add a confining term such as x**2/2"
        )
    return curvature


def restoring_rate(noise: Langevin) -> float:
    """Return the largest r with v'(eta) eta >= r eta^2 (eq. (2) of the paper).

    Parameters
    ----------
    noise : Langevin

    Raises
    ------
    SceneError
        If there is none above 0.
    """
    ratio = sympy.cancel(sympy.diff(noise.potential_expression, eta) / eta)
    line = _line()
    least = float(np.min(vectorised(ratio, (eta,))(line[line != 0])))
    r = least * (1 - tuning.ASSUMPTIONS.safety)
    if not r > 0:
        raise SceneError(
            f"the noise potential v = {quoted(noise.potential)} violates v'(eta) eta >= r eta**2; "
            "use one that restores everywhere, for example v = 'eta**2/2'"
        )
    return r


def dissipation(noise: Hamiltonian) -> Dissipation:
    """Compute the constants of (T117) and (T120).

    The paper takes R, M and delta~ from its reference and assumes that they exist. For
    H = k eta^2/2 + zeta^2/2 and F = gamma_0, R = c eta zeta with c = gamma_0/2 gives
    (1/2 d_zetazeta + B_1 d_zeta + B_2 d_eta)(H + R) = 1/2 - gamma_0 (H + R) exactly. If the
    noise is strongly damped, c = k/(2 gamma_0) keeps both quadratic forms positive.

    Parameters
    ----------
    noise : Hamiltonian

    Raises
    ------
    SceneError
        If H is not quadratic with unit mass or F is not a constant.
    """
    k = sympy.diff(noise.energy, eta, 2)
    damping = noise.dissipation
    quadratic = k * eta**2 / 2 + zeta**2 / 2
    if k.free_symbols or damping.free_symbols or sympy.simplify(noise.energy - quadratic) != 0:
        raise SceneError(
            f"no Lyapunov function for H = {quoted(noise.H)}, F = {quoted(noise.F)}: the paper "
            "assumes one; use KanaiTajimi, for which it is constructed"
        )
    k, damping = float(k), float(damping)
    cross = min(damping / 2, k / (2 * damping))
    form = Dissipation(0.0, 0.5, k, damping, cross)
    rate = min(
        scipy.linalg.eigvalsh(form.energy)[0], scipy.linalg.eigvalsh(form.decay, form.energy)[0]
    )
    rate = float(rate) * (1 - tuning.ASSUMPTIONS.safety)
    return Dissipation(rate, 0.5, k, damping, cross)
