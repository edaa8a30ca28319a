"""Threshold crossing probabilities W_g(b, T) = P(max_{t <= T} |int_0^t g| >= b)."""

import math

import numpy as np
import xarray as xr
from scipy.special import betainccinv, betaincinv

from nonsmooth import spectral
from nonsmooth import strang as splitting
from nonsmooth.brownian import brownian_crossing
from nonsmooth.errors import SceneError
from nonsmooth.kernels import kernel
from nonsmooth.streams import blocks, generator
from nonsmooth.trajectories import initial_state, parallel, require_finite, require_positive
from nonsmooth.variance import asymptotic_variance


@kernel
def _first_passage(rng, s, start, threshold, outputs, steps_per_output, crossed):
    """Count in `crossed` the paths by the output interval in which |Delta| reaches the threshold.

    A path is dropped as soon as it has crossed. Returns nan if a path diverged, else 0.
    """
    remainder = 0.0
    for i in range(start.shape[1]):
        zeta, eta, y, x = start[0, i], start[1, i], start[2, i], start[3, i]
        delta = 0.0
        before = splitting.observe(s, zeta, eta, y, x)
        for k in range(outputs * steps_per_output):
            kick = splitting.increments(s, rng)
            zeta, eta, y, x = splitting.advance(s, zeta, eta, y, x, kick)
            after = splitting.observe(s, zeta, eta, y, x)
            delta += 0.5 * s.step * (before + after)
            before = after
            if abs(delta) >= threshold:
                crossed[k // steps_per_output] += 1
                break
        remainder += 0.0 * delta
    return remainder


@kernel
def _first_passage_pair(rng, fine, coarse, start, threshold, steps, sums):
    """Add to `sums` the powers 0 to 2 of log(time with step h / time with step h/2).

    Both steps run on the same noise; first-passage times are interpolated within their step.
    """
    for i in range(start.shape[1]):
        a, b, c, d = start[0, i], start[1, i], start[2, i], start[3, i]
        zeta, eta, y, x = a, b, c, d
        g_coarse = splitting.observe(coarse, a, b, c, d)
        g_fine = g_coarse
        delta_coarse = delta_fine = 0.0
        time_coarse = time_fine = 0.0
        for k in range(steps):
            early = splitting.increments(fine, rng)
            late = splitting.increments(fine, rng)
            kick = early
            for part in range(2):
                if part == 1:
                    kick = late
                zeta, eta, y, x = splitting.advance(fine, zeta, eta, y, x, kick)
                after = splitting.observe(fine, zeta, eta, y, x)
                before = abs(delta_fine)
                delta_fine += 0.5 * fine.step * (g_fine + after)
                g_fine = after
                if time_fine == 0.0 and abs(delta_fine) >= threshold:
                    part_done = (threshold - before) / (abs(delta_fine) - before)
                    time_fine = (2 * k + part + part_done) * fine.step
            kick = splitting.join(fine, early, late)
            a, b, c, d = splitting.advance(coarse, a, b, c, d, kick)
            after = splitting.observe(coarse, a, b, c, d)
            before = abs(delta_coarse)
            delta_coarse += 0.5 * coarse.step * (g_coarse + after)
            g_coarse = after
            if time_coarse == 0.0 and abs(delta_coarse) >= threshold:
                part_done = (threshold - before) / (abs(delta_coarse) - before)
                time_coarse = (k + part_done) * coarse.step
            if time_coarse > 0.0 and time_fine > 0.0:
                ratio = math.log(time_coarse / time_fine)
                sums[0] += 1.0
                sums[1] += ratio
                sums[2] += ratio**2
                break


def first_passage_counts(
    scene, threshold, horizons, p, step, paths, seed, first_path=0, threads=None
):
    """Count the paths that cross sqrt(p) b in each interval between the horizons p T.

    Parameters
    ----------
    scene : Scene
    threshold : float
        b, "1".
    horizons : array_like, shape (k,)
        Equidistant T, starting at their spacing, "1".
    p : float
        Scale of the functional central limit theorem.
    step : float
        Longest time step, "1"; the step is shortened to divide the spacing of p T.
    paths, seed, first_path, threads
        As for `simulate`.

    Returns
    -------
    numpy.ndarray of int, shape (k,)
    """
    horizons, steps = _steps_per_output(horizons, p, step)
    scheme = splitting.strang(scene, p * horizons[0] / steps)

    def run(job):
        block, count = job
        crossed = np.zeros(len(horizons), dtype=np.int64)
        remainder = _first_passage(
            generator(scene, seed, block),
            scheme,
            initial_state(scene, count),
            np.sqrt(p) * threshold,
            len(horizons),
            steps,
            crossed,
        )
        require_finite([remainder])
        return crossed

    return sum(parallel(run, blocks(first_path, paths), threads))


def first_passage_shift(scene, threshold, horizon, p, step, paths, seed, threads=None):
    """Measure how halving the time step shifts the first-passage times.

    Parameters
    ----------
    scene, threshold, p, paths, seed, threads
        As for `first_passage_counts`.
    horizon : float
        T; paths that have not crossed by p T with both steps are left out.
    step : float
        The longer of the two steps, "1".

    Returns
    -------
    numpy.ndarray, shape (3,)
        Sums over the paths of the powers 0 to 2 of log(time with step / time with step/2).
    """
    fine, coarse = splitting.strang(scene, step / 2), splitting.strang(scene, step)

    def run(job):
        block, count = job
        sums = np.zeros(3)
        _first_passage_pair(
            generator(scene, seed, block),
            fine,
            coarse,
            initial_state(scene, count),
            np.sqrt(p) * threshold,
            int(np.ceil(p * horizon / step)),
            sums,
        )
        return sums

    return sum(parallel(run, blocks(0, paths), threads))


def proportion(successes, trials, level=0.95):
    """Estimate a probability with its exact (Clopper-Pearson) confidence interval.

    Parameters
    ----------
    successes, trials : array_like of int
    level : float
        Confidence level of the two-sided interval.

    Returns
    -------
    estimate, lower, upper : numpy.ndarray
    """
    successes, trials = np.broadcast_arrays(successes, trials)
    tail = (1 - level) / 2
    with np.errstate(invalid="ignore"):
        lower = betaincinv(successes, trials - successes + 1, tail)
        upper = betainccinv(successes + 1, trials - successes, tail)
    lower = np.where(successes == 0, 0.0, lower)
    upper = np.where(successes == trials, 1.0, upper)
    return successes / trials, lower, upper


def crossing_probability(
    scene, threshold, horizons, p=1.0, method="monte_carlo", step=0.02, paths=100_000, seed=0
):
    """Probability that |int_0^t g| reaches sqrt(p) b before p T.

    Parameters
    ----------
    scene : Scene
    threshold : float
        b > 0, "1".
    horizons : array_like, shape (k,)
        T, "1"; for ``"monte_carlo"`` equidistant, starting at their spacing.
    p : float
        Scale of the functional central limit theorem, > 0.
    method : {"monte_carlo", "asymptotic"}
        ``"asymptotic"`` is W_star(b / gamma, T), the limit p -> infinity (eq. equivalent).
    step, paths, seed
        Time step, number of paths and seed of ``"monte_carlo"``.

    Returns
    -------
    xarray.Dataset
        Over `horizon`: `probability` and `probability_error`, for ``"monte_carlo"`` the
        standard error and the 95 % confidence limits `lower` and `upper`; for ``"asymptotic"``
        the error inherited from gamma^2 only, not the distance to the finite-p probability.

    Raises
    ------
    SceneError
        If a parameter is out of range or the method unknown.
    """
    for name, value in (("threshold", threshold), ("p", p), ("step", step), ("paths", paths)):
        require_positive(name, value)
    horizons = np.atleast_1d(np.asarray(horizons, dtype=float))
    if method == "monte_carlo":
        crossed = first_passage_counts(scene, threshold, horizons, p, step, paths, seed)
        values = crossing_estimate(np.cumsum(crossed), paths)
    elif method == "asymptotic":
        gamma2 = asymptotic_variance(scene)
        mean = spectral.mean(scene)
        if abs(mean) > 1e-8 * np.sqrt(gamma2.value):
            raise SceneError(
                f"the asymptotic formula needs E g = 0, but g = {scene.observable!r} has the mean "
                f"{mean:.10g}; subtract it from g"
            )
        values = dict(
            zip(
                ("probability", "probability_error"),
                asymptotic_crossing(threshold, horizons, gamma2.value, gamma2.error),
                strict=True,
            )
        )
    else:
        raise SceneError(f"unknown method {method!r}; choose 'monte_carlo' or 'asymptotic'")
    return xr.Dataset(
        {name: ("horizon", value) for name, value in values.items()}, coords={"horizon": horizons}
    )


def crossing_estimate(crossed, paths):
    """Turn numbers of crossed paths into `probability`, its standard error and 95 % limits."""
    probability, lower, upper = proportion(crossed, paths)
    return {
        "probability": probability,
        "probability_error": np.sqrt(probability * (1 - probability) / paths),
        "lower": lower,
        "upper": upper,
    }


def asymptotic_crossing(threshold, horizons, variance, variance_error):
    """W_star(b / gamma, T) and the error it inherits from gamma^2."""
    value, below, above = (
        brownian_crossing(threshold / np.sqrt(variance + shift), horizons)
        for shift in (0.0, -variance_error, variance_error)
    )
    return value, np.maximum(np.abs(above - value), np.abs(value - below)) + 4e-16


def _steps_per_output(horizons, p, step):
    horizons = np.asarray(horizons, dtype=float)
    require_positive("first horizon", horizons[0])
    if not np.allclose(horizons, horizons[0] * np.arange(1, len(horizons) + 1), rtol=1e-9):
        raise SceneError(
            "Monte Carlo needs horizons k*spacing, k = 1, 2, ...; "
            "use numpy.linspace(0, T, k + 1)[1:]"
        )
    return horizons, max(1, int(np.ceil(p * horizons[0] / step - 1e-9)))
