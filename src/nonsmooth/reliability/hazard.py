"""The hazard rate: the rate at which those cross that have not crossed yet."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.special import ndtri

from nonsmooth.central_differences import central
from nonsmooth.checks import require_increasing, require_positive
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.crossing.proportions import proportion
from nonsmooth.errors import answered
from nonsmooth.reliability import tuning
from nonsmooth.results import between_limits
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.thresholds import bounds


def hazard_rate(
    scene: Scene,
    threshold: float | tuple[float, float],
    horizons: ArrayLike,
    p: float = 1.0,
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
    order: int | None = None,
) -> xr.Dataset:
    """Hazard rate h(T) = W'(T) / (1 - W(T)) of the crossing of a threshold.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        As for `crossing_probability`.
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p, method, tol, step, paths, seed, threads, order
        As for `crossing_probability`; `tol` is the error of W, not that of the hazard rate.

    Returns
    -------
    xarray.Dataset
        Over `horizon`, with the method among its attributes: `hazard_rate`, per unit of T, its
        error `hazard_rate_error`, and `lower` and `upper`, between which it is. W is differentiated
        over a tenth of T to either side, and the error has what the error of W becomes and what
        differences of another width or order change. Where no `tol` is given and W is known to few
        digits, paths may tell more and are taken then. By Monte Carlo, paths are counted that cross
        within this time; the error is the standard error and the biases, and the limits hold with
        95 %.

    Raises
    ------
    SceneError, ToleranceError
        As `crossing_probability`.
    """
    horizons, p = require_increasing("horizons", horizons), require_positive("p", p)
    pair = bounds(threshold)
    # stencils of several horizons may share points but for rounding
    points = horizons[:, None] * np.exp(tuning.HAZARD.spacing * np.arange(-3, 4))
    points = np.array([[float(f"{point:.12g}") for point in row] for row in points])
    times, where = np.unique(points, return_inverse=True)

    def present(run):
        at = {name: run[name].values[where.reshape(points.shape)] for name in run.data_vars}
        if run.attrs["method"] == "monte_carlo":
            found = _counted(at, points, int(run.attrs["paths"]))
        else:
            found = _differentiated(at, horizons)
        over = {"horizon": ("horizon", horizons, "horizon T")}
        return between_limits(over, ("horizon",), "hazard_rate", "hazard rate", found, **run.attrs)

    def ask(method, tol):
        return crossing_probability(
            scene, pair, times, p, method, tol, step, paths, seed, None, threads, order
        )

    def solve():
        found = ask(method, tol)
        solved = method is None and tol is None and found.attrs["method"] == "deterministic"
        if not solved or found["probability_error"].max() <= tuning.HAZARD.few_digits:
            return found
        # differences of what is known to few digits may tell less than paths do
        counted = ask("monte_carlo", tuning.COUNTED)
        return min(found, counted, key=lambda run: present(run)["hazard_rate_error"].max())

    return answered(solve, present, tol_given=tol is not None)


def _differentiated(at, horizons):
    """Differentiate log S at the middle of seven points."""
    spacing = tuning.HAZARD.spacing
    S = at.get("survival", 1 - at["probability"])
    own = at.get("survival_error", at["probability_error"])
    own = own / np.maximum(S, np.finfo(float).tiny)
    log_S = np.log(np.maximum(S, np.finfo(float).tiny))
    inexact = own[:, 2::-1] + own[:, 4:]
    slope, error = central(log_S[:, 2::-1].T, log_S[:, 4:].T, inexact.T, spacing)
    rate, error = -slope / horizons, error / horizons
    # a relative error of S that is not small says nothing of its logarithm
    error = np.where(own.max(axis=1) < tuning.HAZARD.small, 2 * error, np.inf)
    rate, unsure = np.maximum(rate, 0.0), tuning.HAZARD.beyond_doubt * (own[:, 1:] + own[:, :-1])
    jump = _jump(-np.diff(log_S, axis=1), unsure) / (spacing * horizons)
    error = np.maximum(error, jump)
    return rate, error, np.maximum(rate - error, 0.0), rate + error


def _jump(falls, unsure):
    """Largest of the falls from point to point, shape (k, 6), if it is a jump; else 0.

    It is one if it exceeds those on both sides, which a rate that is continuous hardly does, even
    where it grows steeply. Those at the ends change the rate in the middle less.
    """
    beside = np.maximum(falls[:, :-2], falls[:, 2:])
    inside, unsure = falls[:, 1:-1], unsure[:, 1:-1]
    return np.where(inside > tuning.HAZARD.jump * beside + unsure, inside, 0.0).max(axis=1)


def _counted(at, points, paths):
    """Count the paths that cross between points, of those that have not crossed before."""
    crossed = np.rint(at["probability"] * paths).astype(int)
    rates, below, above = {}, {}, {}
    for k in (1, 2, 3):
        first, last = 3 - k, 3 + k
        width = points[:, last] - points[:, first]
        left = paths - crossed[:, first]
        shares = proportion(crossed[:, last] - crossed[:, first], np.maximum(left, 1))
        with np.errstate(divide="ignore"):  # where all have crossed
            rates[k], below[k], above[k] = (
                np.where(left > 0, -np.log1p(-share) / width, np.inf) for share in shares
            )
    known = np.isfinite(rates[3]) & np.isfinite(above[2])
    if not known.all():
        rates, below, above = (
            {k: np.where(known, part, 0.0) for k, part in parts.items()}
            for parts in (rates, below, above)
        )
    # the mean over a window is off like the square of its width
    curved = np.abs(rates[3] - rates[1]) / 2
    width = points[:, 5] - points[:, 1]
    left = np.maximum(1 - at["probability"][:, [1, 5]], 1 / paths)
    shift = at["step_bias"][:, [1, 5]] / left
    bias = np.abs(shift[:, 1] - shift[:, 0]) / width
    spread = np.hypot(*(at["step_bias_error"][:, [1, 5]] / left).T) / width
    two_sided = ndtri(0.975)
    rate, low, high = rates[2], below[2], above[2]
    own = (high - low) / 2 / two_sided
    error = curved + bias + np.hypot(own, spread)
    more = curved + bias
    lower = rate - more - np.hypot(rate - low, two_sided * spread)
    upper = rate + more + np.hypot(high - rate, two_sided * spread)
    counts = np.diff(crossed, axis=1)
    jump = _jump(counts, tuning.HAZARD.beyond_doubt * np.sqrt(counts + 1))
    jump = jump / (paths * left[:, 1] * (points[:, 4] - points[:, 3]))
    return (
        rate,
        np.where(known, np.maximum(error, jump), np.inf),
        np.where(known & (jump == 0), np.maximum(lower, 0.0), 0.0),
        np.where(known, np.maximum(upper, rate + jump), np.inf),
    )
