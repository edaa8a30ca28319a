"""Non-stationary noise: an envelope s(t) >= 0 that multiplies dW."""

import numpy as np
import sympy

from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.formulas import parse, vectorised

_TIME = sympy.Symbol("t", real=True)
# Gauss points and weights on [0, 1], by which the mean square over a step is found
_POINTS, _WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(4))


def scales(envelope: str, began: float, step: float, count: int) -> np.ndarray:
    """Root mean square of an envelope over steps, by which their noise is multiplied.

    The variance of the noise in each step is then that of the envelope.

    Parameters
    ----------
    envelope : str
        s, a formula in ``t``.
    began, step : float
        Time of the first step, and length of all.
    count : int
        Of steps.

    Returns
    -------
    numpy.ndarray, shape (count,)

    Raises
    ------
    ExpressionError
        If the formula cannot be read.
    SceneError
        If it, or its square, is negative or not finite at some time.
    """
    function = vectorised(parse(envelope, (_TIME,)), (_TIME,))
    times = began + step * (np.arange(count)[:, None] + 0.5 + _POINTS)
    with np.errstate(all="ignore"):
        values = np.broadcast_to(function(times), times.shape)
        squares = values**2
    wrong = ~(np.isfinite(squares) & (values >= 0))
    if np.any(wrong):
        at = times[wrong][0]
        raise SceneError(
            f"envelope = {quoted(envelope)} is {values[wrong][0]:g} at t = {at:.3g}; give a "
            "formula that is moderate and not negative"
        )
    return np.sqrt(squares @ _WEIGHTS)
