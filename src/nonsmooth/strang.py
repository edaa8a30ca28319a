"""The Strang splitting of every scene: exact mechanical half-flows around an exact noise step.

One step of length h is X(h/2) Y(h/2) N(h) Y(h/2) X(h/2):

X   the displacement with the velocity frozen; for the obstacle, where the penalty is a
    spring, both together (free flight and elastic contact);
Y   the velocity with displacement and forcing frozen;
N   the noise: exact Gaussian step if its equation is linear, otherwise half a deterministic
    flow (classical Runge-Kutta), the Brownian increment, half a flow. For white noise the
    linear equation is d y = -C_b y dt + sigma dW.

Weak order 2 where the drift is smooth, 1.5 across the kink of the friction law, stable for
every n. Scenes that differ only in n consume the same increments: they are driven by the
same Brownian path.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy.linalg
import sympy

from nonsmooth import flows, models
from nonsmooth.expressions import compiled
from nonsmooth.kernels import inlined, kernel

# kernels compare integers, not names
_ELASTO_PLASTIC, _FRICTION, _OBSTACLE = 0, 1, 2
_MODEL_CODE = {"elasto_plastic": _ELASTO_PLASTIC, "friction": _FRICTION, "obstacle": _OBSTACLE}
_WHITE, _LANGEVIN, _HAMILTONIAN = 0, 1, 2
_NOISE_CODE = {"white": _WHITE, "langevin": _LANGEVIN, "hamiltonian": _HAMILTONIAN}
_VELOCITY, _FORMULA = 0, 1  # observables


class Strang(NamedTuple):
    """Coefficients of the splitting for one scene and one step.

    `transition` (2 x 2, row by row) and `factor` (lower triangle) are the exact Gaussian step
    of the linear noise's (zeta, eta), or of one variable alone in the first entries.
    """

    step: float
    model: int
    noise: int
    observable: int
    moves: bool
    limit: bool
    linear: bool
    pushed: bool
    knot: float
    inner: float
    outer: float
    rate: float
    transition: tuple
    factor: tuple
    slope: object
    first_drift: object
    second_drift: object
    formula: object


@lru_cache(maxsize=1024)
def strang(scene, step):
    """Return the coefficients of a scene's splitting.

    Parameters
    ----------
    scene : Scene
    step : float
        Time step h > 0, "1".

    Returns
    -------
    Strang
    """
    white = scene.noise.kind == "white"
    equations = {models.y: -scene.damping * models.y} if white else scene.noise.drift
    jacobian = sympy.Matrix(list(equations.values())).jacobian(list(equations))
    at_rest = [f.subs(dict.fromkeys(equations, 0)) for f in equations.values()]
    linear = not jacobian.free_symbols and not any(at_rest)
    transition, factor = _gaussian_step(
        np.array(jacobian, dtype=float) if linear else np.zeros((1, 1)), scene.noise.sigma, step
    )
    drifts = [
        compiled(scene.noise.drift.get(symbol, sympy.Integer(0)), (models.zeta, models.eta))
        for symbol in (scene.noise.driven, models.eta)
    ]
    knot, inner, outer = scene.mechanics.penalty.at(scene.n)
    slope = sympy.diff(scene.potential_expression, models.x)
    return Strang(
        step=float(step),
        model=_MODEL_CODE[scene.model],
        noise=_NOISE_CODE[scene.noise.kind],
        observable=_VELOCITY if scene.observable_expression == models.y else _FORMULA,
        moves="x" in scene.state,
        limit=math.isinf(scene.n),
        linear=linear,
        pushed=slope != 0,
        knot=knot,
        inner=inner,
        outer=outer,
        rate=0.0 if white else float(scene.damping),
        transition=transition,
        factor=factor,
        slope=compiled(slope, (models.x,)),
        first_drift=drifts[0],
        second_drift=drifts[1],
        formula=compiled(scene.observable_expression, models.STATE_VARIABLES),
    )


def weak_order(scene):
    """Weak order of the splitting: the kink of dry friction costs half an order."""
    return 1.5 if scene.mechanics.velocity_penalty != 0 else 2.0


def _gaussian_step(matrix, sigma, step):
    """Transition and Cholesky factor of d r = matrix r dt + sigma e_1 dW (Van Loan 1978)."""
    size = len(matrix)
    diffusion = np.zeros((size, size))
    diffusion[0, 0] = sigma**2
    block = np.block([[-matrix, diffusion], [np.zeros((size, size)), matrix.T]])
    exponential = scipy.linalg.expm(block * step)
    transition = exponential[size:, size:].T
    covariance = transition @ exponential[:size, size:]
    factor = np.linalg.cholesky((covariance + covariance.T) / 2)
    padded = np.zeros((2, 2, 2))
    padded[0, :size, :size], padded[1, :size, :size] = transition, factor
    lower = padded[1, 0, 0], padded[1, 1, 0], padded[1, 1, 1]
    return tuple(map(float, padded[0].ravel())), tuple(map(float, lower))


@inlined
def increments(s, rng):
    """Draw the Gaussian increments of one step."""
    first = rng.standard_normal()
    second = rng.standard_normal() if s.noise == _HAMILTONIAN and s.linear else 0.0
    return s.factor[0] * first, s.factor[1] * first + s.factor[2] * second


@inlined
def join(s, early, late):
    """Increments of one step of length 2h on the path of two steps of length h, `s` being h's."""
    a, b, c, d = s.transition
    return (
        a * early[0] + b * early[1] + late[0],
        c * early[0] + d * early[1] + late[1],
    )


@inlined
def _displace(s, y, x, t):
    if s.model == _FRICTION:
        return y, x + y * t
    if s.model == _ELASTO_PLASTIC:
        if s.limit:
            return y, flows.confined(x, t, y)
        return y, flows.penalised(x, t, y, 0.0, s.knot, s.inner, s.outer)
    if s.limit:
        return flows.elastic_impact(y, x, t)
    return flows.spring_contact(y, x, t, s.outer)


@inlined
def _accelerate(s, eta, y, x, t):
    drive = eta - s.slope(x) if s.pushed else eta
    if s.model == _FRICTION:
        if s.limit:
            return flows.dry_friction(y, t, drive, s.rate)
        return flows.penalised(y, t, drive, s.rate, s.knot, s.inner, s.outer)
    if s.rate == 0.0:
        return y + drive * t
    return y * math.exp(-s.rate * t) - drive * math.expm1(-s.rate * t) / s.rate


@kernel
def _drift_flow(s, zeta, eta, t):
    """Classical Runge-Kutta step of the deterministic part of a nonlinear noise."""
    if s.noise == _LANGEVIN:
        k1 = s.first_drift(zeta, eta)
        k2 = s.first_drift(zeta, eta + t / 2 * k1)
        k3 = s.first_drift(zeta, eta + t / 2 * k2)
        k4 = s.first_drift(zeta, eta + t * k3)
        return zeta, eta + t / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    k1, l1 = s.first_drift(zeta, eta), s.second_drift(zeta, eta)
    z, e = zeta + t / 2 * k1, eta + t / 2 * l1
    k2, l2 = s.first_drift(z, e), s.second_drift(z, e)
    z, e = zeta + t / 2 * k2, eta + t / 2 * l2
    k3, l3 = s.first_drift(z, e), s.second_drift(z, e)
    z, e = zeta + t * k3, eta + t * l3
    k4, l4 = s.first_drift(z, e), s.second_drift(z, e)
    return zeta + t / 6 * (k1 + 2 * k2 + 2 * k3 + k4), eta + t / 6 * (l1 + 2 * l2 + 2 * l3 + l4)


@inlined
def _shake(s, zeta, eta, y, kick):
    a, b, c, d = s.transition
    if s.noise == _WHITE:
        return zeta, eta, a * y + kick[0]
    if s.noise == _LANGEVIN:
        if s.linear:
            return zeta, a * eta + kick[0], y
        zeta, eta = _drift_flow(s, zeta, eta, s.step / 2)
        zeta, eta = _drift_flow(s, zeta, eta + kick[0], s.step / 2)
        return zeta, eta, y
    if s.linear:
        return a * zeta + b * eta + kick[0], c * zeta + d * eta + kick[1], y
    zeta, eta = _drift_flow(s, zeta, eta, s.step / 2)
    zeta, eta = _drift_flow(s, zeta + kick[0], eta, s.step / 2)
    return zeta, eta, y


@inlined
def advance(s, zeta, eta, y, x, kick):
    """Advance the state by one step."""
    half = s.step / 2
    if s.moves:
        y, x = _displace(s, y, x, half)
    y = _accelerate(s, eta, y, x, half)
    zeta, eta, y = _shake(s, zeta, eta, y, kick)
    y = _accelerate(s, eta, y, x, half)
    if s.moves:
        y, x = _displace(s, y, x, half)
    return zeta, eta, y, x


@inlined
def observe(s, zeta, eta, y, x):
    """Value of the observable g."""
    if s.observable == _VELOCITY:
        return y
    return s.formula(zeta, eta, y, x)
