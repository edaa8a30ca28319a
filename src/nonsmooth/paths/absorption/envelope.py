"""Non-stationary noise: an envelope s(t) >= 0 that multiplies dW."""

import numpy as np
import sympy

from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.formulas import parse, vectorised

_TIME = sympy.Symbol("t", real=True)
# Gauss points and weights on [0, 1], by which the mean square over a step is found
_POINTS, _WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(4))
# chosen: at so many points, or so many in each step, an integral is looked at once more; ...
_LOOKED_AT, _IN_A_STEP = 2**15, 8
# chosen: ... it may differ by this share, or by this share of the largest of a step, since
# envelopes may jump; Gauss points are off by less than half of that
_UNRESOLVED, _OF_A_STEP = 0.05, 0.6
_AT_ONCE = 2**20  # chosen: points of which values are kept


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
        If it, or its square, is negative or not finite at some time, or has poles or pulses that
        the steps do not resolve.
    """
    began_steps = began + step * np.arange(count)[:, None]
    means = squares(envelope, began_steps + step * (0.5 + _POINTS)) @ _WEIGHTS
    many = max(_IN_A_STEP, -(-_LOOKED_AT // count))
    points = (np.arange(many) + 0.5) / many
    pieces = np.array_split(points, -(-many * count // _AT_ONCE))
    looked_at = sum(squares(envelope, began_steps + step * some).sum() for some in pieces) / many
    total = means.sum()
    allowed = max(_UNRESOLVED * max(total, looked_at), _OF_A_STEP * means.max())
    if abs(total - looked_at) > allowed:
        raise SceneError(
            f"envelope = {quoted(envelope)} has a pole, or a pulse that is shorter than the step "
            f"{step:.2g}: between t = {began:.3g} and {began + step * count:.3g} its mean square "
            f"is {total / count:.3g} or {looked_at / count:.3g}; give a smoother formula or a "
            "shorter step"
        )
    return np.sqrt(means)


def squares(envelope: str, times: np.ndarray) -> np.ndarray:
    """Square an envelope at some times.

    Parameters
    ----------
    envelope : str
        As for `scales`.
    times : numpy.ndarray
        Of any shape.

    Raises
    ------
    ExpressionError
        If the formula cannot be read.
    SceneError
        If it, or its square, is negative or not finite at one of them.
    """
    function = vectorised(parse(envelope, (_TIME,)), (_TIME,))
    with np.errstate(all="ignore"):
        values = np.broadcast_to(function(times), times.shape)
        found = values**2
    wrong = ~(np.isfinite(found) & (values >= 0))
    if np.any(wrong):
        at = times[wrong][0]
        raise SceneError(
            f"envelope = {quoted(envelope)} is {values[wrong][0]:g} at t = {at:.3g}; give a "
            "formula that is moderate and not negative"
        )
    return found
