"""How fast the state comes back from far out, where the drift is linear."""

import itertools
import math
import time

import numpy as np

from nonsmooth.errors import SceneError
from nonsmooth.estimate import Estimate
from nonsmooth.scenes import tuning
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


def rate_at_infinity(scene: Scene) -> Estimate:
    """Rate at which the mean of V_n(Z_t), divided by V_n(Z_0), decays if Z_0 is far out.

    V_n is the Lyapunov function, eq. (13) of the paper. No rate of convergence in the norm weighted
    with V_n (Theorem 5 of the paper) can be larger. Far out V_n is quadratic, noise does not
    matter, and the drift is linear with a matrix J: paths are exp(J t) z there, and the rate is
    twice that of the slowest eigenvalue of J.

    Parameters
    ----------
    scene : Scene
        With a finite n.

    Returns
    -------
    Estimate
        The error is the difference of the rates at two distances, plus rounding.

    Raises
    ------
    SceneError
        If the drift is not linear far out.
    """
    began = time.perf_counter()
    far_out, mismatch = tuning.LINEAR_DRIFT.distances, tuning.LINEAR_DRIFT.mismatch
    symbols = tuple(symbol for symbol in scene.variables if symbol.name in scene.state)
    drift = scene.numerical_drift()
    rates = [vectorised(drift[symbol], symbols) for symbol in symbols]

    def slopes(direction):
        with np.errstate(all="ignore"):  # what is infinite is not linear and is refused below
            values = np.array([rate(*np.outer(direction, far_out)) for rate in rates])
            return np.diff(values) / np.diff(far_out)

    near, far = np.moveaxis(np.array([slopes(unit) for unit in np.eye(len(symbols))]), 2, 0)
    for corner in itertools.product([-1.0, 1.0], repeat=len(symbols)):
        linear = (corner @ near)[:, None]
        if not np.allclose(slopes(corner), linear, rtol=mismatch, atol=mismatch):
            raise SceneError(
                "the drift is not linear far out, where the rate of decay is read from it; choose "
                "potentials that grow quadratically"
            )
    value, other = (-2 * float(np.linalg.eigvals(part).real.max()) for part in (far, near))
    # where eigenvalues coincide, they are in error by the square root of the rounding error
    rounding = 4 * math.sqrt(np.finfo(float).eps) * float(np.linalg.norm(far))
    error = abs(value - other) + rounding
    return Estimate(value, error, "linear drift", time.perf_counter() - began)
