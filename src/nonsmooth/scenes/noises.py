"""The three noises of the paper, and how to add one: white, Langevin, Hamiltonian (Table 2).

`Noise` is the contract. `White`, `Langevin` (type 1) and `Hamiltonian` (type 2) fulfil it;
`OrnsteinUhlenbeck` and `KanaiTajimi` make noises of types 1 and 2 with linear equations.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
import scipy
import sympy

from nonsmooth.checks import as_number, require_parameter
from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes import tuning
from nonsmooth.scenes.formulas import parse, require_slope, vectorised
from nonsmooth.scenes.regularity import require_moderate
from nonsmooth.scenes.symbols import eta, y, zeta


@runtime_checkable
class Noise(Protocol):
    """What drives the oscillator: white noise dW in one of the equations of motion.

    How to add one: most noises are a `Langevin` or a `Hamiltonian` with formulas of their own;
    a function that returns one, like `KanaiTajimi`, is all that they need, and every solver takes
    them. A noise of another kind is a frozen dataclass with the attributes below, handed to
    `Scene(noise=...)`; it may have equations for zeta and eta. Monte Carlo simulates it by the
    Euler-Maruyama scheme. Solvers on grids refuse it, as they need to know its invariant density.

    Attributes
    ----------
    kind : str
        Name of the kind, which no other kind of noise has.
    title : str
        What it is called in messages and captions.
    driven : sympy.Symbol
        The variable in whose equation sigma dW stands.
    forcing : sympy.Expr
        The term that it adds to the equation of the velocity, besides dW.
    sigma : float
        Intensity of dW, "1".
    """

    kind: ClassVar[str]
    title: ClassVar[str]
    driven: ClassVar[sympy.Symbol]
    forcing: ClassVar[sympy.Expr]

    @property
    def sigma(self) -> float:
        """Intensity of dW."""

    @property
    def drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """The drift of the noise's own variables: a dict from zeta and eta, or some of them."""


def langevin_drift(potential: sympy.Expr) -> dict[sympy.Symbol, sympy.Expr]:
    """Return {eta: drift} of eq. (1) of the paper for a potential v(eta)."""
    return {eta: -sympy.diff(potential, eta)}


def hamiltonian_drift(
    hamiltonian: sympy.Expr, dissipation: sympy.Expr
) -> dict[sympy.Symbol, sympy.Expr]:
    """Return {zeta: B_1, eta: B_2}, eq. (4) of the paper, for H(eta, zeta) and F(eta, zeta)."""
    slope = sympy.diff(hamiltonian, zeta)
    return {zeta: -sympy.diff(hamiltonian, eta) - dissipation * slope, eta: slope}


@dataclass(frozen=True)
class White:
    """White noise: dW itself acts on the velocity.

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

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", require_parameter("sigma", self.sigma))

    @property
    def drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """Empty: white noise has no variable of its own."""
        return {}


@dataclass(frozen=True)
class Langevin:
    """Colored noise of type 1, d eta = -v'(eta) dt + sigma dW (eq. (1) of the paper).

    Parameters
    ----------
    potential : str
        Confining potential v, a formula in ``eta``.
    sigma : float
        Intensity, "1".

    Raises
    ------
    SceneError
        If v is not confining. The paper asks for v'(eta) eta >= r eta^2 for large |eta|, its
        eq. (2).
    """

    potential: str
    sigma: float = 1.0
    kind: ClassVar[str] = "langevin"
    title: ClassVar[str] = "colored noise of type 1"
    driven: ClassVar[sympy.Symbol] = eta
    forcing: ClassVar[sympy.Expr] = eta

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", require_parameter("sigma", self.sigma))
        if (number := as_number(self.potential)) is not None:
            raise SceneError(
                f"the noise potential is {quoted(self.potential)}; write a formula of eta in "
                f"quotes, or OrnsteinUhlenbeck(theta={number:g}, sigma={self.sigma:g})"
            )
        require_moderate("v", self.potential, self.potential_expression, (eta,))
        require_slope(self.potential, self.potential_expression, eta)
        far = np.array(tuning.FAR_OUT.distances)
        ends = np.concatenate([-far, far])
        with np.errstate(all="ignore"):
            restoring = -vectorised(self.drift[eta], (eta,))(ends) / ends
        if not (np.all(restoring > 0) and restoring[-1] > tuning.FAR_OUT.kept * restoring[-4]):
            raise SceneError(
                f"the noise potential v = {quoted(self.potential)} is not confining; "
                "v'(eta)*eta must grow at least like eta**2, for example v = 'eta**2/2'"
            )

    @property
    def potential_expression(self) -> sympy.Expr:
        """v(eta), a sympy expression."""
        return parse(self.potential, (eta,))

    @property
    def drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """{eta: -v'(eta)}."""
        return langevin_drift(self.potential_expression)


@dataclass(frozen=True)
class Hamiltonian:
    """Colored noise of type 2: d zeta = B_1 dt + sigma dW, d eta = B_2 dt.

    This is eq. (3) of the paper; eq. (4) has B_1 and B_2.

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
        If H does not grow at infinity in every direction, or F is not positive there. The
        paper's assumptions (T117) and (T120) are not checked beyond that.
    """

    H: str
    F: str
    sigma: float = 1.0
    kind: ClassVar[str] = "hamiltonian"
    title: ClassVar[str] = "colored noise of type 2"
    driven: ClassVar[sympy.Symbol] = zeta
    forcing: ClassVar[sympy.Expr] = eta

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", require_parameter("sigma", self.sigma))
        require_moderate("H", self.H, self.energy, (eta, zeta))
        require_moderate("F", self.F, self.dissipation, (eta, zeta))
        for variable in (eta, zeta):
            require_slope(self.H, self.energy, variable)
        angle = np.linspace(0, 2 * np.pi, tuning.FAR_OUT.directions, endpoint=False)
        far = tuning.FAR_OUT.distances
        # rounded, so that it does not grow along a ray on which it is constant but for rounding
        ends = [np.outer(far, np.round(part(angle), 15)) for part in (np.cos, np.sin)]
        with np.errstate(all="ignore"):
            energy = vectorised(self.energy, (eta, zeta))(*ends)
            dissipation = vectorised(self.dissipation, (eta, zeta))(*ends)
            grows = np.all(np.diff(energy, axis=0) > 0) and self._grows_between(angle, energy)
        if not grows:
            raise SceneError(
                f"the Hamiltonian H = {quoted(self.H)} does not confine (eta, zeta); "
                "it must grow in every direction, for example H = 'eta**2/2 + zeta**2/2'"
            )
        if not np.all(dissipation > 0):
            raise SceneError(
                f"the dissipation F = {quoted(self.F)} is not positive at infinity; "
                "use a positive function, for example F = '1'"
            )

    def _grows_between(self, angle, energy):
        """Whether the least H at each distance grows, at angles between those of known values."""
        H, settings = vectorised(self.energy, (eta, zeta)), tuning.FAR_OUT
        beside = np.array([0.0, -settings.direction, settings.direction])
        least = []
        for r, known in zip(settings.distances, energy, strict=True):
            lowest = known <= np.minimum(np.roll(known, 1), np.roll(known, -1))
            found = []
            for near in angle[lowest]:

                def at(turn, near=near, r=r):
                    return H(r * np.cos(near + turn), r * np.sin(near + turn))

                turn = scipy.optimize.minimize_scalar(
                    at,
                    bounds=(-angle[1], angle[1]),
                    method="bounded",
                    options={"xatol": settings.converged},
                ).x
                found.append(at(min(0.0, turn, key=at) + beside))
            least.append(min(found, key=lambda values: values[0]))
        least = np.array(least)
        # on a ray on which H is constant it changes by what rounding does to the direction
        change = np.max(least[-1]) - least[-1, 0]
        return np.all(np.diff(least[:, 0]) > 0) and least[-1, 0] - least[0, 0] > change

    @property
    def energy(self) -> sympy.Expr:
        """H(eta, zeta), a sympy expression."""
        return parse(self.H, (eta, zeta))

    @property
    def dissipation(self) -> sympy.Expr:
        """F(eta, zeta), a sympy expression."""
        return parse(self.F, (eta, zeta))

    @property
    def drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """{zeta: B_1, eta: B_2}."""
        return hamiltonian_drift(self.energy, self.dissipation)


def OrnsteinUhlenbeck(theta: float = 1.0, sigma: float = 1.0) -> Langevin:
    """Return the Ornstein-Uhlenbeck noise, which is Langevin with v = theta eta^2 / 2.

    Parameters
    ----------
    theta, sigma : float
        Relaxation rate and intensity, "1".
    """
    rate = require_parameter("theta", theta)
    return Langevin(potential=f"{rate!r}*eta**2/2", sigma=sigma)


def KanaiTajimi(stiffness: float = 1.0, damping: float = 1.0, sigma: float = 1.0) -> Hamiltonian:
    """Return the Hamiltonian noise of earthquake engineering, a filtered white noise.

    Parameters
    ----------
    stiffness, damping, sigma : float
        k and gamma_0 of the ground's linear oscillator, and the intensity, "1".
    """
    k = require_parameter("stiffness of the noise", stiffness)
    gamma = require_parameter("damping of the noise", damping)
    return Hamiltonian(H=f"{k!r}*eta**2/2 + zeta**2/2", F=f"{gamma!r}", sigma=sigma)


NOISES: dict[str, Callable[..., Noise]] = {
    "white": White,
    "langevin": OrnsteinUhlenbeck,
    "hamiltonian": KanaiTajimi,
}
# what a scene may call its noise: by its kind, or as engineers do
NAMES: dict[str, Callable[..., Noise]] = NOISES | {
    "ornstein_uhlenbeck": NOISES["langevin"],
    "kanai_tajimi": NOISES["hamiltonian"],
}


@cache
def named(name: str) -> Noise:
    """Return the noise with all parameters 1, which is made when it is first asked for.

    Parameters
    ----------
    name : str
        One of `NAMES`.
    """
    return NAMES[name]()
