"""The constants of the layer at a threshold, as the corrected formulas use them.

`docs/methods/boundary_layer.md` derives them. A is the generator, u the solution of the Poisson
equation A u = -g, and E the mean under the invariant measure, angle brackets in the manual.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class LayerConstants:
    """Constants of a scene, or the errors of such constants; those that are not known are None.

    For odd g both thresholds have the same constants, and skewness and fifth are 0.

    Attributes
    ----------
    diffusion : float
        D = gamma^2 / 2.
    kappa : (float, float)
        Extrapolation lengths of the lower and of the upper threshold.
    u : float
        Value at the start of u, the mean of int g after a long time.
    skewness : float
        C = E[g u^2]. The third cumulant of int_0^t g grows like 6 C t.
    dispersion : float or None
        B = E[g r]. The logarithm of E exp(q int_0^t g) grows like (D q^2 + C q^3 + B q^4) t for
        small q.
    dipole : (float, float) or None
        S at the lower and at the upper threshold. The Brownian survival probability starts as 1
        plus a dipole of this strength at the threshold, which accounts for early times.
    h : float or None
        Value at the start of h, A h = D - g u.
    kappa3 : (float, float) or None
        At a finite p a wave cos(k x) has the extrapolation length kappa + kappa3 k^2 / p at the
        lower and at the upper threshold.
    r : float or None
        Value at the start of r, A r = D u + C - g h.
    fifth : float
        Factor of q^5 in the logarithm of E exp(q int_0^t g) over t, as B is that of q^4.
    mean : float
        E g. The other constants are those of g - E g.
    """

    diffusion: float
    kappa: tuple[float, float]
    u: float
    skewness: float = 0.0
    dispersion: float | None = None
    dipole: tuple[float, float] | None = None
    h: float | None = None
    kappa3: tuple[float, float] | None = None
    r: float | None = None
    fifth: float = 0.0
    mean: float = 0.0

    @property
    def order(self) -> int:
        """The highest order of the corrected formula for which the known constants suffice."""
        if self.dipole is None or self.mean != 0:
            return 1
        return 2 if self.kappa3 is None else 3

    def largest(self) -> float:
        """Return the largest absolute value of all known constants."""
        known = [value for value in vars(self).values() if value is not None]
        return float(np.max(np.abs(np.hstack(known))))

    def meets(self, tol: float, values: "LayerConstants") -> bool:
        """Whether these errors are within `tol`: of kappa, and of others relative to large ones."""
        return max(self.kappa) <= tol and self.largest() <= tol * max(1.0, values.largest())

    def distance(self, other: "LayerConstants") -> "LayerConstants":
        """Return the absolute differences to other constants, of which the same must be known."""
        return LayerConstants(
            *(
                _difference(value, reference)
                for value, reference in zip(vars(self).values(), vars(other).values(), strict=True)
            )
        )


def _difference(value, reference):
    if value is None:
        return None
    difference = np.abs(np.subtract(value, reference)).tolist()
    return tuple(difference) if isinstance(value, tuple) else difference
