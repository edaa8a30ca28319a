"""The explicit Euler scheme (Maruyama 1955): weak order 1, stable for small steps only."""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import sympy

from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.compiled_formulas import compiled, evaluate
from nonsmooth.paths.kernels.instructions import fma, like
from nonsmooth.paths.kernels.panel import GAIN, WIDTH, WORK, ZETA, observe
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.scenes import symbols
from nonsmooth.scenes.scene import Scene


class EulerMaruyama(NamedTuple):
    """Coefficients of the scheme: addresses of the drift's four components and of g."""

    step: float
    normals: int
    driven: int
    transition: tuple
    factor: tuple
    drift: tuple
    formula: int


@lru_cache(maxsize=1024)
def coefficients(scene: Scene, step: float, precision: str = "float32") -> EulerMaruyama:
    """Return the coefficients of a scene's scheme; see `strang.coefficients`."""
    number = np.dtype(precision).type
    drift = scene.numerical_drift()
    unit = number(math.sqrt(step) * scene.noise.sigma)

    def address(expression):
        return compiled(sympy.sympify(expression), symbols.STATE_VARIABLES, precision).address

    needed = [s if s.name in scene.state else None for s in symbols.STATE_VARIABLES]
    return EulerMaruyama(
        step=number(step),
        normals=1,
        driven=symbols.STATE_VARIABLES.index(scene.noise.driven),
        transition=(number(0),) * 4,
        factor=(unit, number(0), number(0)),
        drift=tuple(address(drift.get(symbol, 0)) for symbol in needed),
        formula=address(scene.numerical_observable()),
    )


def handles(scene: Scene) -> bool:
    """Whether n is finite, since the drift must be a function."""
    return math.isfinite(scene.n)


def longest_step(scene: Scene) -> float:
    """Step below which the scheme is stable for the linear equations within and beyond the knot.

    That is, |1 + h lambda| < 1 for every decaying eigenvalue lambda of the drift's Jacobian there.
    """
    drift = scene.numerical_drift()
    rows = [symbol for symbol in symbols.STATE_VARIABLES if symbol.name in scene.state]
    jacobian = sympy.Matrix([drift[symbol] for symbol in rows]).jacobian(rows)
    knot, _, _ = scene.mechanics.penalty.at(scene.n)
    limits = []
    for place in (0.5 * knot, 2.0 * knot):
        at = dict.fromkeys(rows, sympy.Float(place))
        eigenvalues = np.linalg.eigvals(np.array(jacobian.subs(at).doit(), dtype=float))
        decaying = eigenvalues[eigenvalues.real < 0]
        limits.append(np.min(-2 * decaying.real / np.abs(decaying) ** 2, initial=math.inf))
    return min(limits)


@inlined
def flow(s, data, first, last, lanes):
    """Do nothing: the whole step is in `kick`."""


@inlined
def _gain(s, data, lanes):
    evaluate(s.formula, data[WORK].ctypes, data[ZETA:].ctypes, WIDTH, lanes)
    half = s.step / like(s.step, 2.0)
    for i in range(lanes):
        data[GAIN, i] = fma(half, data[WORK, i], data[GAIN, i])


@inlined
def kick(s, data, normal, lanes):
    """One step, with the trapezoidal rule for int g."""
    _gain(s, data, lanes)
    for row in range(4):
        evaluate(s.drift[row], data[WORK + row].ctypes, data[ZETA:].ctypes, WIDTH, lanes)
    for row in range(4):
        for i in range(lanes):
            data[ZETA + row, i] = fma(s.step, data[WORK + row, i], data[ZETA + row, i])
    for i in range(lanes):
        data[ZETA + s.driven, i] = fma(s.factor[0], data[normal, i], data[ZETA + s.driven, i])
    _gain(s, data, lanes)
    observe(data, lanes)


EULER_MARUYAMA = Scheme(
    name="euler_maruyama",
    kind=EulerMaruyama,
    coefficients=coefficients,
    flow=flow,
    kick=kick,
    smooth_order=1.0,
    kink_order=1.0,
    longest_step=longest_step,
    handles=handles,
)
