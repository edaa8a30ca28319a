"""gamma^2 by Monte Carlo: the growth rate of the variance of int_0^t g, for every scene.

Var D(t) = gamma^2 t + const + an exponentially small rest, D(t) = int_0^t g. The slope between
two times is therefore free of the constant, which Var D(t) / t is not.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth import schemes
from nonsmooth.control import poisson_slope
from nonsmooth.march import march
from nonsmooth.panel import new_panel
from nonsmooth.streams import blocks
from nonsmooth.times import equal_steps
from nonsmooth.trajectories import coupled, parallel, require_finite, step_bias


@dataclass(frozen=True)
class Growth:
    """Slopes of the mean and of the variance of D between two times.

    Attributes
    ----------
    rate, rate_error : float
        gamma^2 and its standard error.
    mean, mean_error : float
        Stationary mean of g and its standard error.
    """

    rate: float
    rate_error: float
    mean: float
    mean_error: float


def integrals(
    scene, times, step, paths, seed, first_path=0, threads=None, precision="float32", control=True
):
    """Simulate D and its martingale part at a few times.

    Parameters
    ----------
    scene, times, step, paths, seed, first_path, threads, precision, control
        As for `trajectories.gram`.

    Returns
    -------
    numpy.ndarray, shape (t, 3, paths)
        D, M and <M>; the last two are 0 without a control variate.
    """
    grid = equal_steps(times, step)
    slope = poisson_slope(scene) if control else None
    coefficients = [schemes.coefficients(scene, "strang", h, precision, slope) for _, h in grid]

    def run(job):
        block, count = job
        panel = new_panel(scene, seed, block, precision)
        kept = []
        for (steps, _), s in zip(grid, coefficients, strict=True):
            march(s, panel, count, steps, np.inf)
            kept.append(panel.total[:, :count].copy())
        return np.array(kept)

    results = parallel(run, blocks(first_path, paths), threads)
    require_finite(results)
    return np.concatenate(results, axis=2)


def growth(sample, times):
    """Estimate the slopes from a sample of `integrals` at two times.

    Parameters
    ----------
    sample : numpy.ndarray, shape (2, 3, paths)
    times : tuple of float

    Returns
    -------
    Growth
    """
    (d1, m1, q1), (d2, m2, q2) = sample
    span, paths = times[1] - times[0], len(d1)
    square = ((d2 - d2.mean()) ** 2 - (d1 - d1.mean()) ** 2) / span * (paths / (paths - 1))
    rate, rate_error = _regressed(square, (m2**2 - q2 - m1**2 + q1) / span)
    mean, mean_error = _regressed((d2 - d1) / span, (m2 - m1) / span)
    return Growth(rate, rate_error, mean, mean_error)


def growth_bias(scene, times, step, paths, seed, threads=None):
    """Bias of gamma^2 by the time step, as measured by halving it, and its standard error.

    The error is that of two independent variances, which is larger than that of the slope.
    """
    change, _ = coupled(scene, times, step, paths, seed, threads)
    order = schemes.scheme(scene, "strang").weak_order(scene)
    bias, error = step_bias(change, np.zeros(2), order)
    span = times[1] - times[0]
    return (bias[1] - bias[0]) / span, np.hypot(*error) / span


def _regressed(values, control):
    """Mean of values and its standard error, given a control variate of mean 0."""
    spread = control.var()
    slope = np.mean((values - values.mean()) * control) / spread if spread > 0 else 0.0
    rest = values - slope * control
    return float(rest.mean()), float(rest.std(ddof=1) / np.sqrt(len(values)))
