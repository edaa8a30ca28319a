"""The three noises of the paper: white, overdamped Langevin, stochastic Hamiltonian (Table 2)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import sympy

from nonsmooth.errors import SceneError
from nonsmooth.scenes.formulas import parse, vectorised
from nonsmooth.scenes.symbols import eta, y, zeta

# Where "at infinity" a potential is examined: far enough for the leading term of any
# reasonable formula to dominate, near enough for its fourth power not to overflow.
FAR = np.array([1e2, 1e3, 1e4, 1e6])


def _require_positive(name, value):
    if not 0 < value < np.inf:
        raise SceneError(f"the noise needs {name} > 0, got {value}; choose a positive number")


def langevin_drift(potential):
    """Return {eta: drift} of eq. (noise1) for a potential v(eta)."""
    return {eta: -sympy.diff(potential, eta)}


def hamiltonian_drift(hamiltonian, dissipation):
    """Return {zeta: B_1, eta: B_2} of eq. (defB1B2) for H(eta, zeta) and F(eta, zeta)."""
    slope = sympy.diff(hamiltonian, zeta)
    return {zeta: -sympy.diff(hamiltonian, eta) - dissipation * slope, eta: slope}


@dataclass(frozen=True)
class White:
    """White noise: the forcing is dW itself, acting on the velocity.

    Parameters
    ----------
    sigma : float
        Intensity, "1" (dimensionless); the paper has 1.
    """

    sigma: float = 1.0
    kind: ClassVar[str] = "white"
    title: ClassVar[str] = "white noise"
    driven: ClassVar[sympy.Symbol] = y
    forcing: ClassVar[sympy.Expr] = sympy.Integer(0)

    def __post_init__(self):
        _require_positive("sigma", self.sigma)
        object.__setattr__(self, "sigma", float(self.sigma))

    @property
    def drift(self):
        """No variable of its own."""
        return {}


@dataclass(frozen=True)
class Langevin:
    """Colored noise of type 1, d eta = -v'(eta) dt + sigma dW (eq. noise1).

    Parameters
    ----------
    potential : str
        Confining potential v, a formula in ``eta``.
    sigma : float
        Intensity, "1".

    Raises
    ------
    SceneError
        If v is not confining, v'(eta) eta >= r eta^2 for large |eta| (eq. cond-boldvprime).
    """

    potential: str
    sigma: float = 1.0
    kind: ClassVar[str] = "langevin"
    title: ClassVar[str] = "colored noise of type 1"
    driven: ClassVar[sympy.Symbol] = eta
    forcing: ClassVar[sympy.Expr] = eta

    def __post_init__(self):
        _require_positive("sigma", self.sigma)
        ends = np.concatenate([-FAR, FAR])
        with np.errstate(all="ignore"):
            restoring = -vectorised(self.drift[eta], (eta,))(ends) / ends
        if not (np.all(restoring > 0) and restoring[-1] > 1e-3 * restoring[-4]):
            raise SceneError(
                f"the noise potential v = {self.potential!r} is not confining; "
                "v'(eta)*eta must grow at least like eta**2, for example v = 'eta**2/2'"
            )

    @property
    def potential_expression(self):
        """v(eta), a sympy expression."""
        return parse(self.potential, (eta,))

    @property
    def drift(self):
        """{eta: -v'(eta)}."""
        return langevin_drift(self.potential_expression)


@dataclass(frozen=True)
class Hamiltonian:
    """Colored noise of type 2 (eq. noise2): d zeta = B_1 dt + sigma dW, d eta = B_2 dt.

    Parameters
    ----------
    H : str
        Hamiltonian, a formula in ``eta`` and ``zeta``.
    F : str
        Dissipation, a formula in ``eta`` and ``zeta``.
    sigma : float
        Intensity, "1".

    Raises
    ------
    SceneError
        If H does not grow at infinity in every direction or F is negative there
        (necessary for eqs. T117 and T120).
    """

    H: str
    F: str
    sigma: float = 1.0
    kind: ClassVar[str] = "hamiltonian"
    title: ClassVar[str] = "colored noise of type 2"
    driven: ClassVar[sympy.Symbol] = zeta
    forcing: ClassVar[sympy.Expr] = eta

    def __post_init__(self):
        _require_positive("sigma", self.sigma)
        angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
        ends = np.outer(FAR, np.cos(angle)), np.outer(FAR, np.sin(angle))
        with np.errstate(all="ignore"):
            energy = vectorised(self.energy, (eta, zeta))(*ends)
            dissipation = vectorised(self.dissipation, (eta, zeta))(*ends)
        if not np.all(np.diff(energy, axis=0) > 0):
            raise SceneError(
                f"the Hamiltonian H = {self.H!r} does not confine (eta, zeta); "
                "it must grow in every direction, for example H = 'eta**2/2 + zeta**2/2'"
            )
        if not np.all(dissipation > 0):
            raise SceneError(
                f"the dissipation F = {self.F!r} is not positive at infinity; "
                "use a positive function, for example F = '1'"
            )

    @property
    def energy(self):
        """H(eta, zeta), a sympy expression."""
        return parse(self.H, (eta, zeta))

    @property
    def dissipation(self):
        """F(eta, zeta), a sympy expression."""
        return parse(self.F, (eta, zeta))

    @property
    def drift(self):
        """{zeta: B_1, eta: B_2}."""
        return hamiltonian_drift(self.energy, self.dissipation)


def OrnsteinUhlenbeck(theta=1.0, sigma=1.0):
    """Return the Langevin noise with v = theta eta^2 / 2.

    Parameters
    ----------
    theta, sigma : float
        Relaxation rate and intensity, "1".
    """
    _require_positive("theta", theta)
    return Langevin(potential=f"{float(theta)!r}*eta**2/2", sigma=sigma)


def KanaiTajimi(stiffness=1.0, damping=1.0, sigma=1.0):
    """Return the Hamiltonian noise of earthquake engineering, a filtered white noise.

    Parameters
    ----------
    stiffness, damping, sigma : float
        k and gamma_0 of the ground's linear oscillator, and the intensity, "1".
    """
    _require_positive("stiffness", stiffness)
    _require_positive("damping", damping)
    return Hamiltonian(
        H=f"{float(stiffness)!r}*eta**2/2 + zeta**2/2", F=f"{float(damping)!r}", sigma=sigma
    )


NOISES = {"white": White(), "langevin": OrnsteinUhlenbeck(), "hamiltonian": KanaiTajimi()}
