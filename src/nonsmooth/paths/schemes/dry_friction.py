"""An exact sampler of dry friction's non-smooth limit, in a Strang splitting with the damping.

For dY = -sgn(Y) dt + sigma dW the size |Y| is a Brownian motion with drift -1 reflected at 0
(Skorokhod): |Y(h)| = X(h) - min(0, min X) with X(t) = |Y(0)| - t + sigma W(t). Given X(h), the
minimum of X over the step has an explicit law, that of a Brownian bridge. After a visit to 0 both
signs are equally likely. One step is D(h/2) S(h) D(h/2), where S is this sampler and D the damping;
neighbouring D are merged.

Weak order 2: the kink, which costs other splittings half an order, is inside the exact part.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import fma, like, minimum, where
from nonsmooth.paths.kernels.panel import GAIN, Y, observe
from nonsmooth.paths.schemes import drift_implicit
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.scenes.scene import Scene


class DryFriction(NamedTuple):
    """Coefficients of the scheme; `damping` is exp(-C_b h/2) - 1 and `variance` sigma^2 h."""

    step: float
    normals: int
    transition: tuple
    factor: tuple
    damping: float
    variance: float


def handles(scene: Scene) -> bool:
    """Whether n = inf, the state is the velocity alone, the noise is white, and g = y."""
    return math.isinf(scene.n) and drift_implicit.handles(scene)


@lru_cache(maxsize=1024)
def coefficients(scene: Scene, step: float, precision: str = "float32") -> DryFriction:
    """Return the coefficients of a scene's scheme; see `strang.coefficients`."""
    number = np.dtype(precision).type
    variance = scene.noise.sigma**2 * step
    return DryFriction(
        step=number(step),
        normals=4,
        transition=(number(0),) * 4,
        factor=(number(math.sqrt(variance)), number(0), number(0)),
        damping=number(math.expm1(-scene.damping * step / 2)),
        variance=number(variance),
    )


@inlined
def flow(s, data, first, last, lanes):
    """Damping between two exact steps, or its first or last half."""
    for i in range(lanes):
        y = fma(s.damping, data[Y, i], data[Y, i])
        data[Y, i] = y if first or last else fma(s.damping, y, y)


@inlined
def kick(s, data, normal, lanes):
    """One exact step: the end of X, its minimum and the sign, from four normal numbers."""
    half, zero = s.step / like(s.step, 2.0), like(s.step, 0.0)
    for i in range(lanes):
        before = data[Y, i]
        size = abs(before)
        end = fma(s.factor[0], data[normal, i], size - s.step)
        exponential = fma(data[normal + 2, i], data[normal + 2, i], data[normal + 3, i] ** 2)
        spread = math.sqrt(fma(end - size, end - size, s.variance * exponential))
        least = (size + end - spread) / like(s.step, 2.0)
        side = where(least > zero, before, data[normal + 1, i])
        after = math.copysign(end - minimum(least, zero), side)
        data[Y, i] = after
        data[GAIN, i] = half * (before + after)
    observe(data, lanes)


DRY_FRICTION = Scheme(
    name="dry_friction",
    kind=DryFriction,
    coefficients=coefficients,
    flow=flow,
    kick=kick,
    smooth_order=2.0,
    kink_order=2.0,
    handles=handles,
    shares_noise=False,  # the minimum and the sign of a step do not follow from those of its halves
)
