"""From a structure in SI units to the dimensionless scene, and the way back.

A structure of mass m on ground that accelerates by a(t) moves like

    m X'' + c X' + k X + R = -m a,

with X its displacement against the ground. R is dry friction of size F, the force of stops at the
distances +-d, or nothing; a structure that yields at the force F has k Z in the place of k X, with
Z the elastic part of X. A scene measures lengths in L, times in T and masses in m, so that the slip
force, the yield displacement or the gap is 1:

============== ================================ ==========================================
model          L                                T
============== ================================ ==========================================
friction       F T^2 / m                        sqrt(m / k); without a spring 1 / omega_g,
obstacle       d                                and in white noise such that sigma = 1
elasto_plastic F / k                            sqrt(m / k)
============== ================================ ==========================================

Then C_b = c T / m and U = k T^2 / m x^2 / 2, which is x^2 / 2 or, without a spring, 0. The noise is
N = a T^2 / L up to its sign, which its symmetry makes irrelevant. White noise of the two-sided
spectral density S_0 over angular frequencies, so that the integral of a over t has the variance
2 pi S_0 t, has sigma^2 = 2 pi S_0 T^3 / L^2. Through the ground's filter

    a'' + 2 zeta_g omega_g a' + omega_g^2 a = omega_g^2 w,

with w white noise of density S_0, it becomes the noise `KanaiTajimi` with the stiffness
(omega_g T)^2, the damping 2 zeta_g omega_g T and the intensity (omega_g T)^2 times that of white
noise. This is the paper's form of the filter: the spectrum of a is S_0 omega_g^4 / D with
D = (omega_g^2 - omega^2)^2 + 4 zeta_g^2 omega_g^2 omega^2. That of Kanai and Tajimi has
4 zeta_g^2 omega_g^2 omega^2 in the numerator, too, which is more except far below omega_g.
"""

import math
from dataclasses import dataclass
from functools import cached_property

from nonsmooth.checks import as_number, require_choice, require_positive
from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.noises import KanaiTajimi, Noise, White
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Scales:
    """The units of a scene.

    Attributes
    ----------
    length : float
        L, "m".
    time : float
        T, "s".
    force : float
        m L / T^2, "N".
    """

    length: float
    time: float
    force: float


@dataclass(frozen=True)
class Structure:
    """A structure on shaking ground.

    Parameters
    ----------
    model : str
        ``"elasto_plastic"``, ``"friction"`` or ``"obstacle"``.
    mass : float
        m, "kg".
    damping : float
        c, "N s m-1".
    limit : float
        The slip force, "N", the yield force, "N", or the gap on either side, "m".
    spectral_density : float
        S_0 of the acceleration, two-sided over angular frequencies, "m2 s-3".
    stiffness : float
        k, "N m-1"; 0 for none, except where the structure yields.
    ground_frequency : float, optional
        omega_g, "rad s-1"; white noise unless given.
    ground_damping : float, optional
        zeta_g, "1", with `ground_frequency`.

    Raises
    ------
    SceneError
        If a parameter is out of range or missing.
    """

    model: str
    mass: float
    damping: float
    limit: float
    spectral_density: float
    stiffness: float = 0.0
    ground_frequency: float | None = None
    ground_damping: float | None = None

    def __post_init__(self) -> None:
        require_choice("model", self.model, MODELS)
        for name in ("mass", "damping", "limit", "spectral_density"):
            require_positive(name, getattr(self, name))
        if as_number(self.stiffness) != 0 or self.model == "elasto_plastic":
            require_positive("stiffness", self.stiffness)
        if (self.ground_frequency is None) != (self.ground_damping is None):
            raise SceneError(
                f"ground_frequency is {quoted(self.ground_frequency)} and ground_damping is "
                f"{quoted(self.ground_damping)}; give both, or none for white noise"
            )
        if self.ground_frequency is not None:
            require_positive("ground_frequency", self.ground_frequency)
            require_positive("ground_damping", self.ground_damping)

    @cached_property
    def scales(self) -> Scales:
        """The units of its scene."""
        time = self._time()
        length = {
            "friction": self.limit * time**2 / self.mass,
            "obstacle": self.limit,
            "elasto_plastic": self.limit / self.stiffness if self.stiffness else math.nan,
        }[self.model]
        return Scales(length, time, self.mass * length / time**2)

    def _time(self):
        if self.stiffness > 0:
            return math.sqrt(self.mass / self.stiffness)
        if self.ground_frequency is not None:
            return 1 / self.ground_frequency
        white = 2 * math.pi * self.spectral_density
        if self.model == "friction":
            return white * (self.mass / self.limit) ** 2
        return (self.limit**2 / white) ** (1 / 3)

    @property
    def noise(self) -> Noise:
        """The ground's motion, dimensionless."""
        length, time = self.scales.length, self.scales.time
        sigma = math.sqrt(2 * math.pi * self.spectral_density * time**3) / length
        if self.ground_frequency is None or self.ground_damping is None:
            return White(sigma)
        frequency = self.ground_frequency * time
        return KanaiTajimi(frequency**2, 2 * self.ground_damping * frequency, frequency**2 * sigma)

    def scene(self, observable: str | None = None, n: float = math.inf) -> Scene:
        """Return its dimensionless scene.

        Parameters
        ----------
        observable : str, optional
            As for `Scene`, a formula in dimensionless variables or the name of a force.
        n : float
            Penalization, "1". Stops of a finite stiffness K have n = K T^2 / m.

        Returns
        -------
        Scene
        """
        return Scene(
            self.model,
            self.noise,
            n=n,
            damping=self.damping * self.scales.time / self.mass,
            potential="x**2/2" if self.stiffness > 0 else "0",
            observable=observable,
        )
