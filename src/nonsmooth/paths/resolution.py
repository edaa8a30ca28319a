"""How many paths, and how long a time step, a tolerance takes."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError
from nonsmooth.paths import schemes
from nonsmooth.paths.ensembles import coupled, gram
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import mean_bias, moments, step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene

MOST_STEPS = 1e13  # of all paths together: hours


_LONGEST_STEP = 0.1  # times the smaller of 1 and 1/C_b


PILOT_PATHS = 4096


# A tolerance is met if these many standard errors and the bias of the step are within it: one
# result in 400 misses it.
SIGMAS = 3.0


SPREAD_SHARE = 0.75  # of the tolerance, for the standard errors; least work at the weak order 3/2


def coarse_step(scene, scheme="strang"):
    """Step from which the search for one with a given bias starts."""
    longest = schemes.scheme(scene, scheme).longest_step(scene)
    return min(_LONGEST_STEP * min(1.0, 1 / scene.damping), longest / 4)


def paths_for(deviation, tol):
    """Count the paths on whose average, of a given standard deviation, `tol` can be promised."""
    return math.ceil((SIGMAS * deviation / (SPREAD_SHARE * tol)) ** 2)


def require_possible(paths, steps, what, tol, most=MOST_STEPS):
    """Refuse a tolerance that would take more steps of all paths together than can be waited for.

    Raises
    ------
    ToleranceError
        The message begins with `what`, such as the best value and its error.
    """
    if paths * steps > most:
        reachable = tol * math.sqrt(paths * steps / most)
        raise ToleranceError(
            f"{what}; tol = {tol:g} would take Monte Carlo {paths:.1e} paths of {steps:.1e} steps; "
            f"use tol >= {reachable:.1g}"
        )


def refined_step(step, bias, allowed, order):
    """Step at which a bias known at a coarser one is as small as allowed, by the weak order."""
    return float(step * min(1.0, (allowed / bias) ** (1 / order)))


def halved_step_bias(scene: Scene, times: ArrayLike, sampling: Sampling) -> dict:
    """Measure what halving the step changes in the mean and in the variance of D.

    Returns
    -------
    dict
        `mean` and `variance`: the bias by the step of each, over the times, and its standard error.
    """
    chosen = schemes.scheme(scene, sampling.scheme)
    order = chosen.weak_order(scene)
    if chosen.coupled:
        change, _ = coupled(scene, times, sampling)
        return {"mean": mean_bias(change, order), "variance": step_bias(change, order)}
    # independent runs on a grid and on its halves
    more = replace(sampling, paths=4 * sampling.paths)
    coarse, fine = (moments(gram(scene, times, more.labelled(k), parts=k)) for k in (1, 2))
    factor = 1 / (1 - 2**-order)
    return {
        name: (
            factor * (coarse[name] - fine[name]),
            factor * np.hypot(coarse[f"{name}_error"], fine[f"{name}_error"]),
        )
        for name in ("mean", "variance")
    }


def choose_step(
    scene: Scene,
    times: np.ndarray,
    tol: float,
    seed: int | tuple,
    threads: int | None,
    scheme: str,
) -> float:
    """Find the step whose relative bias of the variance is below `tol`, from a coarse pilot."""
    step = min(coarse_step(scene, scheme), float(times[-1]) / 32)
    pilot = Sampling(step, PILOT_PATHS, labelled(seed, "pilot"), threads=threads, scheme=scheme)
    found = moments(gram(scene, times, pilot))
    bias, error = halved_step_bias(scene, times, pilot)["variance"]
    worst = (np.abs(bias) + 2 * error)[-1] / found["variance"][-1]
    return refined_step(step, worst, tol, schemes.scheme(scene, scheme).weak_order(scene))


_MEASURABLE = 0.2  # largest relative bias of Var D at which halving the step measures it


def require_resolved(step, variance, bias, error):
    """Refuse a step so long that halving it does not measure its bias.

    The bias follows the weak order for steps that are short against every time scale of the
    scene, on which g varies included; then it is small against the variance.

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
    if abs(bias) > max(_MEASURABLE * variance, 4 * error):
        raise ToleranceError(
            f"step = {step:g} is too long for this scene: halving it puts the bias of the variance "
            f"of int g at {abs(bias) / variance:.0%}, where it is no measure of it; "
            "choose a smaller step"
        )
