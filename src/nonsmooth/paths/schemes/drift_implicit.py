"""The drift-implicit Euler scheme for dry friction alone: weak order 1, stable at every step.

A step solves y + h (C_b y + a_n'(y)) = w for y, w being the velocity after the noise. The solution
is explicit in w: linear near 0, a shifted line beyond.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import fma, like, minimum
from nonsmooth.paths.kernels.panel import GAIN, Y, observe
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.scenes import symbols
from nonsmooth.scenes.scene import Scene


class DriftImplicit(NamedTuple):
    """Coefficients of the scheme.

    For w > 0 the solution is `inner` w up to w = `bound`, and `outer` (w - `shift`) beyond.
    """

    step: float
    normals: int
    transition: tuple
    factor: tuple
    bound: float
    inner: float
    outer: float
    shift: float


def handles(scene: Scene) -> bool:
    """Whether the state is the velocity alone, under dry friction and white noise, and g = y."""
    return (
        scene.state == ("y",)
        and scene.noise.kind == "white"
        and scene.mechanics.is_dry_friction
        and scene.observable_expression == symbols.y
    )


@lru_cache(maxsize=1024)
def coefficients(scene: Scene, step: float, precision: str = "float32") -> DriftImplicit:
    """Return the coefficients of a scene's scheme; see `strang.coefficients`."""
    number = np.dtype(precision).type
    knot, inner, _ = scene.mechanics.penalty.at(scene.n)
    damped = 1 + step * scene.damping
    return DriftImplicit(
        step=number(step),
        normals=1,
        transition=(number(0),) * 4,
        factor=(number(math.sqrt(step) * scene.noise.sigma), number(0), number(0)),
        bound=number(knot * damped + step),
        inner=number(1 / (damped + step * inner)),
        outer=number(1 / damped),
        shift=number(step),
    )


@inlined
def flow(s, data, first, last, lanes):
    """Do nothing: the whole step is in `kick`."""


@inlined
def kick(s, data, normal, lanes):
    """One step, with the trapezoidal rule for int g."""
    half = s.step / like(s.step, 2.0)
    for i in range(lanes):
        before = data[Y, i]
        moved = fma(s.factor[0], data[normal, i], before)
        size = abs(moved)
        near = s.inner * minimum(size, s.bound)
        after = math.copysign(near if size <= s.bound else s.outer * (size - s.shift), moved)
        data[Y, i] = after
        data[GAIN, i] = half * (before + after)
    observe(data, lanes)


DRIFT_IMPLICIT = Scheme(
    name="drift_implicit",
    kind=DriftImplicit,
    coefficients=coefficients,
    flow=flow,
    kick=kick,
    smooth_order=1.0,
    kink_order=1.0,
    handles=handles,
)
