"""Variance of int_0^tau g and its growth rate gamma^2, deterministically."""

import time

import numpy as np
import xarray as xr

from nonsmooth import models, spectral
from nonsmooth.closed_form import friction_variance
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate

_DEGREES = (8, 12, 16, 20, 24)


def asymptotic_variance(scene, tol=1e-10):
    """gamma_g^2 of Theorem thm3: the growth rate of the variance of int_0^t g.

    Parameters
    ----------
    scene : Scene
        With the one-dimensional state y and white noise.
    tol : float
        Requested relative error.

    Returns
    -------
    Estimate
        By closed form for dry friction and g = y, by spectral elements otherwise.

    Raises
    ------
    SceneError
        If the scene has no deterministic solver.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    began = time.perf_counter()
    spectral.potential(scene)  # refuses what is not one-dimensional
    if (
        scene.mechanics.velocity_penalty != 0
        and scene.observable_expression == models.y
        and scene.noise.sigma == 1.0
    ):
        value, error = friction_variance(scene.n, scene.damping)
        method = "closed form"
    else:
        value, error = _refine(
            lambda degree: np.array([spectral.asymptotic_variance(scene, degree)]),
            lambda degree, value: spectral.rounding(scene, degree) * np.abs(value),
            lambda value: tol * np.abs(value),
        )
        value, error, method = float(value[0]), float(error[0]), "spectral elements"
    if error > tol * abs(value):
        raise ToleranceError(
            f"gamma^2 = {value:.16g} has an error of {error:.1e}, above tol = {tol:g} relative; "
            "loosen tol"
        )
    return Estimate(value, error, method, time.perf_counter() - began)


def variance(scene, times, tol=1e-9):
    """Mean w(start, tau) and variance v(start, tau) of int_0^tau g - E g (eq. defvgyt).

    Parameters
    ----------
    scene : Scene
        With the one-dimensional state y and white noise.
    times : array_like, shape (t,)
        tau >= 0, "1".
    tol : float
        Requested absolute error of v(tau)/tau.

    Returns
    -------
    xarray.Dataset
        `w`, `v` and their error bounds `w_error`, `v_error` over `time`.

    Raises
    ------
    SceneError
        If the scene has no deterministic solver, or a time is negative.
    ToleranceError
        If `tol` cannot be met.
    """
    times = np.atleast_1d(np.asarray(times, dtype=float))
    if not np.all(times >= 0):
        raise SceneError("the times of the variance must not be negative; remove those that are")
    scale = tol * np.where(times > 0, times, 1.0)
    (w, v), (w_error, v_error) = _refine(
        lambda degree: np.array(spectral.moments(scene, times, degree)),
        # w is the difference of terms as large as the standard deviation, v of E Delta^2 and w^2
        lambda degree, wv: (
            spectral.rounding(scene, degree)
            * np.array([np.abs(wv[0]) + np.sqrt(np.abs(wv[1])), np.abs(wv[1]) + wv[0] ** 2])
        ),
        lambda wv: np.array([np.full_like(times, np.inf), scale]),
    )
    if np.any(v_error > scale):
        raise ToleranceError(
            f"v(tau)/tau has an error of {np.max(v_error / scale) * tol:.1e}, above tol = {tol:g}; "
            "loosen tol"
        )
    return xr.Dataset(
        {
            name: ("time", values)
            for name, values in (("w", w), ("w_error", w_error), ("v", v), ("v_error", v_error))
        },
        coords={"time": times},
    )


def _refine(solve, rounding, allowed):
    """Raise the polynomial degree until two solutions agree; return the last and its error.

    The difference is the error of the coarser one, which convergence in the degree makes far
    larger than that of the finer one; rounding is added.
    """
    solution = solve(_DEGREES[0])
    for degree in _DEGREES[1:]:
        coarser, solution = solution, solve(degree)
        error = np.abs(solution - coarser) + rounding(degree, solution)
        if np.all(error <= allowed(solution)):
            break
    return solution, error
