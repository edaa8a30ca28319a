"""The martingale of the Poisson solution as a control variate.

With -A u = g - E g, int_0^t g - t E g = u(Z_0) - u(Z_t) + M(t), M(t) = int_0^t sigma u'(Y) dW.
M and M^2 - <M> have the mean zero exactly, also for the time-stepping scheme, where each step adds
a polynomial of its increment whose mean is zero given the past; they carry almost all of the
variance of the integral and of its square.
"""

import numpy as np
from scipy.integrate import cumulative_simpson

from nonsmooth import models, spectral
from nonsmooth.expressions import vectorised

_POINTS = 4097
_NEGLIGIBLE = 20.0  # the table ends where the density has fallen by exp(-20) = 2e-9


def poisson_slope(scene):
    """Tabulate u' of a one-dimensional scene with white noise.

    By (m u')' = -2/sigma^2 (g - E g) m, integrated from the nearer end.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    reach : float
        The table covers [-reach, reach].
    values : numpy.ndarray
        u' at equidistant points; empty if the scene has another state or noise.
    """
    if not spectral.applies(scene):
        return 1.0, np.zeros(0)
    energy, _ = spectral.potential(scene)
    depth = vectorised(energy, (models.y,))
    reach = 1.0
    while depth(reach) < _NEGLIGIBLE:
        reach *= 1.1
    y = np.linspace(-reach, reach, _POINTS)
    density = np.exp(-depth(y))
    g = vectorised(scene.observable_expression, (models.y,))(y) - spectral.mean(scene)
    left = cumulative_simpson(g * density, x=y, initial=0)
    right = left[-1] - left
    flux = np.where(y < 0, -left, right)
    return reach, 2 / scene.noise.sigma**2 * flux / density
