"""How fast a penalized scene approaches its non-smooth limit as n grows, on paths and in law.

In simulations the penalized scene and the limit are driven by the same Brownian path with the same
steps, so that errors of the steps that both share cancel in the difference. Where probabilities are
solved for, the limit need not be known.
"""

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from nonsmooth.errors import ToleranceError
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.kernels.panel import STATE, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_loop import compile_march, march
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


def largest_distances(
    scene: Scene, variable: str, horizon: float, sampling: Sampling
) -> np.ndarray:
    """Simulate sup_{t <= T} |z_n(t) - z(t)|, z one of the variables of the state, over the steps.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    variable : {"y", "x"}
    horizon : float
        T, "1".
    sampling : Sampling
        Its precision is ignored: double precision is used, because the differences are small.

    Returns
    -------
    numpy.ndarray, shape (paths,)
    """
    row = STATE[[s.name for s in STATE_VARIABLES].index(variable)]
    steps = math.ceil(horizon / sampling.step)
    pair = [
        (one, registry.coefficients(one, sampling.scheme, horizon / steps, "float64"))
        for one in (scene, scene.with_n(math.inf))
    ]
    for one, s in pair:
        compile_march(s, new_panel(one, sampling.seed, 0, "float64"))

    def run(job):
        block, count = job
        panels = [new_panel(one, sampling.seed, block, "float64") for one, _ in pair]
        largest = np.zeros(count)
        for _ in range(steps):
            for panel, (_, s) in zip(panels, pair, strict=True):
                march(s, panel, count, 1, -np.inf, np.inf)
            difference = panels[0].data[row, :count] - panels[1].data[row, :count]
            np.maximum(largest, np.abs(difference), out=largest)
        return largest

    return np.concatenate(list(parallel(run, sampling, 2 * steps)))


def variance_difference(scene: Scene, horizon: float, sampling: Sampling) -> tuple[float, float]:
    """Difference of Var D(T) / T between a penalized scene and its limit, on the same paths.

    Parameters
    ----------
    scene, horizon, sampling
        As for `largest_distances`.

    Returns
    -------
    value, error : float
        The error is the standard error.
    """
    penalized, limit = (
        integrals_at(one, [horizon], sampling, control=False)[0, 0]
        for one in (scene, scene.with_n(math.inf))
    )
    square = (penalized - penalized.mean()) ** 2 - (limit - limit.mean()) ** 2
    return square.mean() / horizon, square.std(ddof=1) / math.sqrt(sampling.paths) / horizon


def gamma2_difference(scene: Scene) -> tuple[float, float]:
    """gamma_n^2 - gamma^2 of dry friction with white noise and g = y, and its error."""
    (value, error), (limit, limit_error) = (
        friction_variance(n, scene.damping) for n in (scene.n, math.inf)
    )
    return value - limit, error + limit_error


def slope(
    n: ArrayLike, value: ArrayLike, error: ArrayLike, level: float = 0.05
) -> tuple[float, float]:
    """Fit log |value| = c + slope log n by weighted least squares.

    Parameters
    ----------
    n, value, error : array_like, shape (k,)
        Values of independent errors; those not above two of their errors are left out.
    level : float
        Probability with which the interval misses the slope by chance.

    Returns
    -------
    slope, half_width : float
        The half width is that of a confidence interval by the delta method: the error of the
        logarithm is the relative error. If the points scatter about the line more than their errors
        explain, because a further order matters, the scatter takes the place of the errors, with
        Student's factor.

    Raises
    ------
    ToleranceError
        If fewer than three values are left.
    """
    n, value, error = (np.asarray(item, dtype=float) for item in (n, np.abs(value), error))
    kept = value > 2 * error
    if np.count_nonzero(kept) < 3:
        raise ToleranceError(
            f"of the {len(n)} differences to the limit {np.count_nonzero(kept)} are above two of "
            "their errors, and a slope needs three; take more paths or a longer horizon"
        )
    x, y = np.log(n[kept]), np.log(value[kept])
    weight = (value / np.maximum(error, 1e-12 * value))[kept] ** 2
    # A relative error below a tenth of the typical one counts as that tenth.
    weight = np.minimum(weight, 100 * np.median(weight))
    centre = np.average(x, weights=weight)
    spread = np.sum(weight * (x - centre) ** 2)
    found = np.sum(weight * (x - centre) * y) / spread
    rest = y - np.average(y, weights=weight) - found * (x - centre)
    freedom = len(x) - 2
    scatter = np.sum(weight * rest**2) / freedom
    by_errors = stats.norm.ppf(1 - level / 2) / math.sqrt(spread)
    by_scatter = stats.t.ppf(1 - level / 2, freedom) * math.sqrt(scatter / spread)
    return float(found), float(max(by_errors, by_scatter))


def power_of_n(
    ratio: float, value: ArrayLike, error: ArrayLike
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Lay value = limit + C n^exponent through the three largest n.

    The differences of neighbours fall by the same power as the distance to the limit.

    Parameters
    ----------
    ratio : float
        Of each n to the one before, at least 4.
    value, error : array_like, shape (k,)
        At k >= 4 increasing n, with bounds of their errors.

    Returns
    -------
    exponent, limit : (float, float)
        Each with its error. That of the exponent is what the errors of the values can change in
        it, and how far the exponent of the three n before the largest one may be from it. If the
        next order falls by the factor n^(-1/2) or faster, it is a bound. That of the limit is what
        both kinds of errors change in it.

    Raises
    ------
    ToleranceError
        If differences of neighbours are not above their errors, or if the exponent might not be
        negative.
    """
    value, error = np.asarray(value, dtype=float), np.asarray(error, dtype=float)
    step, slack = np.diff(value)[-3:], (error[1:] + error[:-1])[-3:]
    if np.any(np.sign(step[-1]) * step <= slack):
        raise ToleranceError(
            "neighbouring n change the probability by less than its error, or in different "
            "directions; take a smaller tolerance or other n"
        )
    before, last = np.diff(np.log(np.abs(step))) / np.log(ratio)
    of_logarithms = -np.log1p(-slack / np.abs(step)) / np.log(ratio)
    # its own error; and the change from the exponent before, as large as both errors allow
    before_by_errors, by_errors = of_logarithms[1:] + of_logarithms[:-1]
    spread = by_errors + (abs(last - before) + by_errors + before_by_errors)
    if last + spread >= 0:
        raise ToleranceError(
            f"the exponent of n is {last:.2f} with an error of {spread:.2f}, so that there might "
            "be no limit; take a smaller tolerance or other n"
        )
    # the sum of all further differences, over the last one
    rest, least, most = 1 / (ratio ** -np.array([last, last - spread, last + spread]) - 1)
    extrapolated = abs(step[-1]) * max(rest - least, most - rest)
    limit_error = error[-1] + rest * slack[-1] + extrapolated
    return (last, spread), (value[-1] + rest * step[-1], limit_error)
