"""gamma^2 by Monte Carlo: the growth rate of the variance of int_0^t g, for every scene.

Var D(t) = gamma^2 t + const + an exponentially small rest, D(t) = int_0^t g. The slope between
two times is therefore free of the constant, which Var D(t) / t is not.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nonsmooth.paths import schemes
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.moments import step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Slopes:
    """Slopes of the mean and of the variance of D between the first and the last of three times.

    Attributes
    ----------
    gamma2, gamma2_error : float
        gamma^2 and its standard error.
    mean, mean_error : float
        Stationary mean of g and its standard error.
    settling, settling_error : float
        By how much the slope of the second half exceeds that of the first, and its standard
        error: 0 within the error once the scene has forgotten its start and its correlations.
    """

    gamma2: float
    gamma2_error: float
    mean: float
    mean_error: float
    settling: float
    settling_error: float

    @property
    def settled(self):
        """Whether both halves agree within four standard errors, or to a thousandth."""
        return abs(self.settling) <= max(4 * self.settling_error, 1e-3 * abs(self.gamma2))

    def agrees(self, other):
        """Whether the slopes of two samples agree within four standard errors, or a thousandth."""
        return all(
            abs(ours - theirs) <= max(4 * float(np.hypot(error, other_error)), 1e-3 * abs(ours))
            for ours, error, theirs, other_error in (
                (self.gamma2, self.gamma2_error, other.gamma2, other.gamma2_error),
                (self.mean, self.mean_error, other.mean, other.mean_error),
            )
        )


def slopes(sample: np.ndarray, times: Sequence[float]) -> Slopes:
    """Estimate the slopes from a sample of `integrals_at`.

    Parameters
    ----------
    sample : numpy.ndarray, shape (3, 3, paths)
    times : sequence of float, three increasing ones

    Returns
    -------
    Slopes
    """
    first, second, whole = (
        _slopes(sample[[i, k]], times[k] - times[i]) for i, k in ((0, 1), (1, 2), (0, 2))
    )
    settling = second[0] - first[0]
    return Slopes(*whole, settling, float(np.hypot(first[1], second[1])))


def gamma2_bias(scene: Scene, times: Sequence[float], sampling: Sampling) -> tuple[float, float]:
    """Bias of gamma^2 by the time step, as measured by halving it, and its standard error.

    Parameters
    ----------
    scene : Scene
    times : sequence of float
        The slope is from the first to the last.
    sampling : Sampling

    Returns
    -------
    bias, error : float
        The error is that of two independent variances, which is larger than that of the slope.
    """
    change, _ = coupled(scene, [times[0], times[-1]], sampling)
    bias, error = step_bias(change, schemes.scheme(scene, sampling.scheme).weak_order(scene))
    span = times[-1] - times[0]
    return float(bias[1] - bias[0]) / span, float(np.hypot(*error)) / span


def _slopes(sample, span):
    (d1, m1, q1), (d2, m2, q2) = sample
    paths = len(d1)
    square = ((d2 - d2.mean()) ** 2 - (d1 - d1.mean()) ** 2) / span * (paths / (paths - 1))
    rate = _regressed(square, (m2**2 - q2 - m1**2 + q1) / span)
    return *rate, *_regressed((d2 - d1) / span, (m2 - m1) / span)


def _regressed(values, control):
    """Mean of values and its standard error, given a control variate of mean 0."""
    spread = control.var()
    slope = np.mean((values - values.mean()) * control) / spread if spread > 0 else 0.0
    rest = values - slope * control
    return float(rest.mean()), float(rest.std(ddof=1) / np.sqrt(len(values)))
