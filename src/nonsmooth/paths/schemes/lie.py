"""The Lie splitting of dry friction alone: weak order 1, stable at every step.

One step is the exact Gaussian step of damping and noise, then the exact flow of the friction. int g
is found by the trapezoidal rule over the whole step. The scheme is there to be compared with the
symmetric splitting `strang`.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from nonsmooth.paths.kernels import exact_flows
from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import fma, like
from nonsmooth.paths.kernels.panel import GAIN, Y, observe
from nonsmooth.paths.schemes import drift_implicit, strang
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.scenes.scene import Scene


class Lie(NamedTuple):
    """Coefficients of the scheme: the friction's knot, its rate below it, and the Gaussian step."""

    step: float
    normals: int
    transition: tuple
    factor: tuple
    knot: float
    inner: float


@lru_cache(maxsize=1024)
def coefficients(scene: Scene, step: float, precision: str = "float32") -> Lie:
    """Return the coefficients of a scene's scheme; see `strang.coefficients`."""
    number = np.dtype(precision).type
    matrix = np.array([[-scene.damping]])
    transition, factor = strang.gaussian_step(matrix, scene.noise.sigma, step)
    knot, inner, _ = scene.mechanics.penalty.at(scene.n)
    return Lie(
        step=number(step),
        normals=1,
        transition=tuple(map(number, transition)),
        factor=tuple(map(number, factor)),
        knot=number(knot),
        inner=number(1.0 if math.isinf(scene.n) else inner),
    )


@inlined
def flow(s, data, first, last, lanes):
    """Do nothing: the whole step is in `kick`."""


@inlined
def kick(s, data, normal, lanes):
    """One step, with the trapezoidal rule for int g."""
    half, decay, factor = s.step / like(s.step, 2.0), s.transition[0], s.factor[0]
    for i in range(lanes):
        before = data[Y, i]
        shaken = fma(decay, before, fma(factor, data[normal, i], before))
        after = exact_flows.at_rest(shaken, s.step, s.knot, s.inner)
        data[Y, i] = after
        data[GAIN, i] = half * (before + after)
    observe(data, lanes)


LIE = Scheme(
    name="lie",
    kind=Lie,
    coefficients=coefficients,
    flow=flow,
    kick=kick,
    smooth_order=2.0,  # without friction only the trapezoidal rule for int g is not exact
    kink_order=1.0,
    handles=drift_implicit.handles,
)
