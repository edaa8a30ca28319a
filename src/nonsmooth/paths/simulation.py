"""The public function `simulate`: paths of a scene, or the moments of int g over many of them."""

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    require_choice,
    require_count,
    require_increasing,
    require_positive,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.errors import SceneError
from nonsmooth.paths import tuning
from nonsmooth.paths.absorption.moving import moments_under_envelope, paths_under_envelope
from nonsmooth.paths.ensembles import gram, paths_at
from nonsmooth.paths.moments import moments
from nonsmooth.paths.resolution import (
    choose_step,
    paths_of_variance,
    require_possible,
    require_resolved,
    sampled_step_bias,
)
from nonsmooth.paths.sampling import PRECISIONS, Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.results import dataset
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.symbols import TITLES

_TITLES = {
    f"{name}{suffix}": f"{what}{name} of int g"
    for name in ("mean", "variance")
    for suffix, what in {
        "": "",
        "_error": "standard error of the ",
        "_bias": "bias of the time step in the ",
        "_bias_error": "standard error of the bias in the ",
    }.items()
}


def simulate(
    scene: Scene,
    horizon: float,
    tol: float = 1e-2,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    times: ArrayLike | None = None,
    keep: str = "moments",
    scheme: str = "strang",
    precision: str = "float32",
    threads: int | None = None,
    envelope: str | None = None,
) -> xr.Dataset:
    """Simulate a scene.

    Parameters
    ----------
    scene : Scene
    horizon : float
        Final time, "1".
    tol : float
        Relative error wanted of the variance of D = int_0^horizon g. The number of paths and
        the step follow from it unless they are given: three standard errors are three quarters
        of `tol`, and the bias of the step is a quarter.
    step : float, optional
        Longest time step, "1".
    paths : int, optional
        Number of paths.
    seed : int or tuple
        The same seed gives the same bits whatever the number of threads.
    times : array_like, shape (t,), optional
        Increasing output times in (0, horizon]; 200 equidistant ones unless given.
    keep : {"moments", "paths"}
        Whether to return statistics, whose memory does not grow with the number of paths, or the
        paths at the output times.
    scheme : str
        A name in `schemes.registry.SCHEMES`; `strang` takes every scene of the paper.
    precision : {"float32", "float64"}
        Arithmetic of the moments' steps; their sums, and kept paths, are in double precision.
    threads : int, optional
        All cores unless given.
    envelope : str, optional
        s >= 0, a formula in ``t``, such as ``"t*exp(1 - t)"``: non-stationary noise s(t) sigma dW.

    Returns
    -------
    xarray.Dataset
        ``"moments"``, over time: `mean` and `variance` of int_0^t g with their standard errors
        `mean_error`, `variance_error`, and `mean_bias` and `variance_bias`, the biases of the time
        step as measured by halving it, with `mean_bias_error`, `variance_bias_error`.
        ``"paths"``: the variables of the scene's state and `delta`, each (path, time), time 0
        included. Attributes `step`, `paths`.

    Raises
    ------
    SceneError
        If an argument is out of range, or a path diverges.
    ToleranceError
        If the step is so long that halving it does not measure its bias; if `tol` would take more
        than hours, and the message has one that does not; if a given step would take more than
        `paths.tuning.COST.longest_run`.
    """
    require_random(scene)
    at = _output_times(horizon, times)
    tol = require_tolerance(tol)
    step = None if step is None else require_positive("step", step)
    count = paths_of_variance(tol) if paths is None else require_count("paths", paths)
    seed, threads = require_seed(seed), require_threads(threads)
    keep = require_choice("keep", keep, ("moments", "paths"))
    precision = require_choice("precision", precision, PRECISIONS)
    chosen = registry.scheme(scene, scheme)  # raises an error if it cannot simulate the scene
    if envelope is not None and not chosen.shares_noise:
        raise SceneError(f"scheme is {scheme!r}, which takes no envelope; use 'strang'")
    if keep == "moments" and count == 1:
        raise SceneError("one path has no variance; choose more paths, or keep='paths'")
    if step is None:
        share = (1 - tuning.MONTE_CARLO.spread_share) * tol
        step = choose_step(scene, at[-1:], share, seed, threads, scheme, envelope)
        if paths is None:
            require_possible(count, at[-1] / step, "the variance of int g is sampled", tol)
    sampling = Sampling(step, count, seed, threads=threads, scheme=scheme, precision=precision)
    data = (_paths if keep == "paths" else _statistics)(scene, at, sampling, envelope)
    return data.assign_attrs(step=step, paths=count)


def _paths(scene, times, sampling, envelope):
    double = replace(sampling, precision="float64")
    if envelope is None:
        kept = paths_at(scene, times, double)
    else:
        kept = paths_under_envelope(scene, times, double, envelope)
    names = [*scene.state, "delta"]
    titles = TITLES | {"delta": "int g"}
    return dataset(
        {"time": ("time", np.concatenate([[0.0], times]), "time")},
        {name: (("path", "time"), kept[:, i].T, titles[name]) for i, name in enumerate(names)},
    )


def _statistics(scene, times, sampling, envelope):
    if envelope is None:
        found = moments(gram(scene, times, sampling))
        for name, bias in sampled_step_bias(scene, times, sampling, found).items():
            found[f"{name}_bias"], found[f"{name}_bias_error"] = bias
    else:
        found = moments_under_envelope(scene, times, sampling, envelope)
    last = (found[name][-1] for name in ("variance", "variance_bias", "variance_bias_error"))
    require_resolved(sampling.step, *last)
    return dataset(
        {"time": ("time", times, "time")},
        {name: ("time", values, _TITLES[name]) for name, values in found.items()},
    )


def _output_times(horizon, times):
    horizon = require_positive("horizon", horizon)
    if times is None:
        return np.linspace(0, horizon, 201)[1:]
    times = require_increasing("times", times)
    if times[-1] > horizon:
        raise SceneError(
            f"the last output time, {times[-1]:g}, is beyond horizon = {horizon:g}; choose another"
        )
    return times
