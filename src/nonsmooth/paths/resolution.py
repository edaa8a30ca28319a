"""How many paths, and how long a time step, a tolerance takes."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError
from nonsmooth.paths import tuning
from nonsmooth.paths.absorption.moving import moments_under_envelope
from nonsmooth.paths.ensembles import coupled, gram
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import bias_over_change, mean_bias, moments, step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene


def coarse_step(scene: Scene, scheme: str = "strang") -> float:
    """Step of the first pilot, from which a step with a small enough bias is found."""
    longest = registry.longest_step(scene, scheme)
    chosen = tuning.MONTE_CARLO
    return min(chosen.coarse_step * min(1.0, 1 / scene.damping), chosen.stable_share * longest)


def first_step(scene: Scene, times: np.ndarray, scheme: str = "strang") -> float:
    """Step of the first pilot if the paths end at the last of the times."""
    return min(coarse_step(scene, scheme), float(times[-1]) / tuning.MONTE_CARLO.least_steps)


def paths_for(deviation: float, tol: float) -> int:
    """Count the paths whose average is known to `tol`, if each has the given deviation."""
    chosen = tuning.MONTE_CARLO
    return math.ceil((chosen.sigmas * deviation / (chosen.spread_share * tol)) ** 2)


def paths_of_variance(tol: float) -> int:
    """Count the paths that sample a variance to a relative tolerance."""
    # The sample variance of normal variables has the relative standard error sqrt(2 / paths).
    # That makes 32 / tol^2 for three standard errors within three quarters of the tolerance.
    return math.ceil(32 / tol**2)


def halving_paths(paths: int) -> int:
    """Count how many of the paths are used to measure the bias of the step."""
    return min(paths, max(tuning.MONTE_CARLO.pilot_paths, paths // tuning.MONTE_CARLO.halved))


def require_possible(
    paths: float,
    steps: float,
    what: str,
    tol: float,
    most: float = tuning.MONTE_CARLO.most_steps,
    result: object = None,
) -> None:
    """Refuse a tolerance that would take more steps of all paths together than can be waited for.

    Raises
    ------
    ToleranceError
        The message begins with `what`, such as the best value and its error; it has the `result`.
    """
    if paths * steps > most:
        reachable = 1.1 * tol * math.sqrt(paths * steps / most)  # more than rounding takes away
        raise ToleranceError(
            f"{what}; tol = {tol:g} would take Monte Carlo {paths:.1e} paths of {steps:.1e} steps; "
            f"use tol >= {reachable:.2g}",
            result,
        )


def refined_step(step: float, bias: float, allowed: float, order: float) -> float:
    """Step whose bias is as small as allowed, from a known bias at `step` and the weak order."""
    if bias <= 0:
        return step
    return float(step * min(1.0, (allowed / bias) ** (1 / order)))


def halved_step_bias(scene: Scene, times: ArrayLike, sampling: Sampling) -> dict:
    """Measure what halving the step changes in the mean and in the variance of D.

    Returns
    -------
    dict
        `mean` and `variance`: the bias by the step of each, over the times, and its standard error.
    """
    chosen = registry.scheme(scene, sampling.scheme)
    order = chosen.weak_order(scene)
    if chosen.shares_noise:
        change, _ = coupled(scene, times, sampling)
        return {"mean": mean_bias(change, order), "variance": step_bias(change, order)}
    # without common noise: independent runs with the steps and with their halves
    more = replace(sampling, paths=4 * sampling.paths)
    coarse, fine = (moments(gram(scene, times, more.labelled(k), parts=k)) for k in (1, 2))
    factor = bias_over_change(order)
    return {
        name: (
            factor * (coarse[name] - fine[name]),
            factor * np.hypot(coarse[f"{name}_error"], fine[f"{name}_error"]),
        )
        for name in ("mean", "variance")
    }


def sampled_step_bias(
    scene: Scene, times: ArrayLike, sampling: Sampling, found: dict[str, np.ndarray]
) -> dict:
    """Measure the bias of the step on as few paths as its error asks for.

    Parameters
    ----------
    scene, times
        As for `halved_step_bias`.
    sampling : Sampling
        Of the moments.
    found : dict
        Their standard errors, beside which that of the bias shall be small.

    Returns
    -------
    dict
        As of `halved_step_bias`.
    """
    chosen = tuning.MONTE_CARLO
    pilot = min(sampling.paths, chosen.pilot_paths)
    halving = replace(sampling.labelled("halving"), paths=pilot, precision="float32")
    bias = halved_step_bias(scene, times, halving)
    errors = np.array([error for _, error in bias.values()])
    spreads = np.array([found[f"{name}_error"] for name in bias])
    seen = spreads > 0  # at early times it may be that no path has moved
    worst = np.max(errors[seen] / spreads[seen], initial=0.0)
    asked = math.ceil(pilot * (worst / chosen.bias_share) ** 2)
    paths = min(asked, halving_paths(sampling.paths))
    return bias if paths <= pilot else halved_step_bias(scene, times, replace(halving, paths=paths))


def choose_step(
    scene: Scene,
    times: np.ndarray,
    tol: float,
    seed: int | tuple,
    threads: int | None,
    scheme: str,
    envelope: str | None = None,
) -> float:
    """Find the step whose relative bias of the variance is below `tol`.

    The bias is measured at a long step, in a small sample, the pilot, and extrapolated.
    """
    step = first_step(scene, times, scheme)
    pilot = Sampling(
        step,
        tuning.MONTE_CARLO.pilot_paths,
        labelled(seed, "pilot"),
        threads=threads,
        scheme=scheme,
    )
    if envelope is None:
        found = moments(gram(scene, times, pilot))
        bias, error = halved_step_bias(scene, times, pilot)["variance"]
    else:
        found = moments_under_envelope(scene, times, pilot, envelope)
        bias, error = found["variance_bias"], found["variance_bias_error"]
    worst = (np.abs(bias) + 2 * error)[-1] / found["variance"][-1]
    return refined_step(step, worst, tol, registry.scheme(scene, scheme).weak_order(scene))


def require_resolved(step: float, variance: float, bias: float, error: float) -> None:
    """Refuse a step so long that halving it does not measure its bias.

    The bias follows the weak order only if the step is short against every time scale of the scene,
    that of g included. It is then small against the variance; if it is not, the step is refused.

    Parameters
    ----------
    step : float
    variance, bias, error : float
        Of D at the last time: its variance, the bias of the step and its standard error.

    Raises
    ------
    ToleranceError
        If the bias is significantly above a fifth of the variance.
    """
    if abs(bias) > max(tuning.MONTE_CARLO.measurable * variance, 4 * error):
        raise ToleranceError(
            f"step = {step:g} is too long for this scene: by halving it the bias of the variance "
            f"of int g, {variance:.3g}, is found to be {abs(bias):.2g}, too much for this to "
            "measure it; choose a smaller step"
        )
