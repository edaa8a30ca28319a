"""The Strang splitting of every scene: exact mechanical half-flows around an exact noise step.

One step of length h is X(h/2) Y(h/2) N(h) Y(h/2) X(h/2):

X   the displacement with the velocity frozen; for the obstacle, where the penalty is a
    spring, both together (free flight and elastic contact);
Y   the velocity with displacement and forcing frozen;
N   the noise: an exact Gaussian step if its equation is linear; otherwise half a step of
    its drift alone (classical Runge-Kutta), the Brownian increment, and half a step again.
    For white noise the linear equation is d y = -C_b y dt + sigma dW.

Between two noise steps neighbouring half-flows are merged into Y(h/2) X(h) Y(h/2), or into
Y(h) where the displacement is not needed. A noise step adds to int g the mean of g before and
after it. If g is the penalty force, its integral over a flow is instead what the force has taken
from the displacement or from the velocity in the flow. This is exact except for dry friction under
colored noise, where the damping acts in the same flow.

The weak order is 2 where the drift is smooth and 1.5 across the kink of the friction law. The
scheme is stable for every n. Scenes that differ only in n use the same random numbers: they are
driven by the same Brownian path.
"""

import math
import warnings
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy
import sympy

from nonsmooth.errors import SceneError
from nonsmooth.paths import tuning
from nonsmooth.paths.control_variate import DEGREE
from nonsmooth.paths.kernels import exact_flows
from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.compiled_formulas import compiled, evaluate
from nonsmooth.paths.kernels.instructions import fma, larger, like, minimum, where
from nonsmooth.paths.kernels.panel import (
    BASE,
    DELTA,
    ETA,
    GAIN,
    MARTINGALE,
    PEAK,
    VARIATION,
    WIDTH,
    WORK,
    ZETA,
    X,
    Y,
    observe,
)
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import ABSOLUTE_VALUE, BARRIER
from nonsmooth.scenes.scene import Scene

# Kernels compare integers instead of names.
_PLASTIC, _FRICTION, _SPRING = 0, 1, 2  # what the penalty force is
_WHITE, _LANGEVIN, _HAMILTONIAN = 0, 1, 2
_NOISE_CODE = {"white": _WHITE, "langevin": _LANGEVIN, "hamiltonian": _HAMILTONIAN}
_VELOCITY, _PENALTY_FORCE, _DISPLACEMENT, _FORMULA = 0, 1, 2, 3  # observables


class Strang(NamedTuple):
    """Coefficients of the splitting for one scene, one step and one precision.

    `penalty`, `noise` and `observable` are codes of their kinds. `moves` tells whether the
    displacement is part of the state, `limit` whether n = inf, `dry` whether the penalty is the
    dry friction of the paper, `linear` whether the noise's equation is linear, `pushed` whether
    U' acts, and `shaken` whether a noise step changes g. `knot`, `inner` and `outer` define the
    penalty force; `omega` is the root of `outer`, and `rate` the damping in the flow of the
    velocity (0 for white noise, whose step has it). `transition` (2 x 2, row by row, less the
    identity) and `factor` (lower triangle) are the exact Gaussian step of the linear noise's
    (zeta, eta), or of one variable alone in the first entries. `spring` holds the coefficients of
    x and x^3 in U', if there is nothing else in it. `slope`, `first_drift`, `second_drift` and
    `formula` are addresses of U', of the noise's drifts and of g; 0 where they are not used, as
    compiling the first one takes a quarter of a second. `control` holds the
    coefficients of polynomials in |y| / `reach` for y < 0 and for y >= 0, the integrand of the
    control variate, which is used if `controlled`.
    """

    step: float
    normals: int
    penalty: int
    noise: int
    observable: int
    moves: bool
    limit: bool
    dry: bool
    linear: bool
    pushed: bool
    shaken: bool
    knot: float
    inner: float
    outer: float
    omega: float
    rate: float
    transition: tuple
    factor: tuple
    spring: tuple
    slope: int
    first_drift: int
    second_drift: int
    formula: int
    controlled: bool
    reach: float
    control: tuple


@lru_cache(maxsize=1024)
def coefficients(scene: Scene, step: float, precision: str = "float32") -> Strang:
    """Return the coefficients of a scene's splitting.

    Parameters
    ----------
    scene : Scene
    step : float
        Time step h > 0, "1".
    precision : {"float32", "float64"}

    Returns
    -------
    Strang
    """
    number = np.dtype(precision).type
    white = scene.noise.kind == "white"
    equations = {symbols.y: -scene.damping * symbols.y} if white else scene.noise.drift
    jacobian = sympy.Matrix(list(equations.values())).jacobian(list(equations))
    linear = _is_linear(equations)
    transition, factor = gaussian_step(
        np.array(jacobian, dtype=float) if linear else np.zeros((1, 1)), scene.noise.sigma, step
    )
    knot, inner, outer = scene.mechanics.penalty.at(scene.n)
    slope = sympy.diff(scene.potential_expression, symbols.x)
    pushed = slope != 0 and "x" in scene.state
    spring = _spring(slope)
    observable = _observable_code(scene)

    def formula(expression, used):
        if not used:
            return 0
        return compiled(sympy.sympify(expression), symbols.STATE_VARIABLES, precision).address

    return Strang(
        step=number(step),
        normals=2 if linear and scene.noise.kind == "hamiltonian" else 1,
        penalty=_penalty_code(scene.mechanics),
        noise=_NOISE_CODE[scene.noise.kind],
        observable=observable,
        moves="x" in scene.state,
        limit=math.isinf(scene.n),
        dry=scene.mechanics.is_dry_friction,
        linear=linear,
        pushed=pushed,
        shaken=not scene.observable_expression.free_symbols.isdisjoint(equations),
        knot=number(knot),
        inner=number(inner),
        outer=number(outer),
        omega=number(math.sqrt(outer)),
        rate=number(0.0 if white else scene.damping),
        transition=tuple(map(number, transition)),
        factor=tuple(map(number, factor)),
        spring=tuple(map(number, spring or (0.0, 0.0))),
        slope=formula(slope, pushed and spring is None),
        first_drift=formula(scene.noise.drift.get(scene.noise.driven), not linear),
        second_drift=formula(scene.noise.drift.get(symbols.eta), not linear),
        formula=formula(scene.observable_expression, observable == _FORMULA),
        controlled=False,
        reach=number(1.0),
        control=((number(0),) * (DEGREE + 1),) * 2,
    )


def handles(scene: Scene) -> bool:
    """Whether there is an exact flow of the scene's penalty, and a step of its noise.

    At n = inf there is a flow for the penalties of the paper; at a finite n for all but springs
    that also act below the knot.
    """
    model = scene.mechanics
    if scene.noise.kind not in _NOISE_CODE:
        return False
    if math.isinf(scene.n):
        return model.penalty == (ABSOLUTE_VALUE if model.is_friction else BARRIER)
    return not model.in_potential or model.penalty.at(scene.n)[1] == 0


def longest_step(scene: Scene) -> float:
    """Step below which the parts of the splitting that are not exact are stable.

    These are the action of U' on the velocity, which needs h < 2 / sqrt(max U''), and the
    Runge-Kutta half-steps of a nonlinear noise, which need h/2 < 2.8 / (their fastest rate). The
    largest values are looked for between the walls and a bit beyond, or within a few units of 0.
    The penalty sets no limit.
    """
    limit = math.inf
    if "x" in scene.state:
        wall = scene.mechanics.wall
        reach = wall + tuning.STABLE_STEP.beyond if math.isfinite(wall) else tuning.STABLE_STEP.free
        stiffness = vectorised(sympy.diff(scene.potential_expression, symbols.x, 2), (symbols.x,))
        with np.errstate(all="ignore"):
            largest = np.nanmax(stiffness(np.linspace(-reach, reach, tuning.STABLE_STEP.points)))
        limit = tuning.STABLE_STEP.kick / math.sqrt(largest) if largest > 0 else limit
    drift = scene.noise.drift
    if drift and not _is_linear(drift):
        variables = tuple(drift)
        jacobian = sympy.Matrix(list(drift.values())).jacobian(variables)
        around = tuning.STABLE_STEP.noise
        axis = np.linspace(-around, around, tuning.STABLE_STEP.noise_points)
        place = np.meshgrid(*[axis] * len(variables))
        entries = [vectorised(entry, variables)(*place) for entry in jacobian]
        limit = min(limit, tuning.STABLE_STEP.runge_kutta / np.max(np.linalg.norm(entries, axis=0)))
    return limit


def gains_in_kicks(scene: Scene) -> bool:
    """Whether g is not the penalty force, whose integral is taken over the flows."""
    return not scene.observes_penalty_force


def _is_linear(equations):
    jacobian = sympy.Matrix(list(equations.values())).jacobian(list(equations))
    at_rest = [f.subs(dict.fromkeys(equations, 0)) for f in equations.values()]
    return not jacobian.free_symbols and not any(at_rest)


def _spring(slope):
    """Coefficients of x and x^3 in a slope that has no other terms."""
    if not slope.is_polynomial(symbols.x):
        return None
    terms = sympy.Poly(slope, symbols.x).as_dict()
    return None if terms.keys() - {(1,), (3,)} else (terms.get((1,), 0), terms.get((3,), 0))


def _penalty_code(model):
    if model.is_friction:
        return _FRICTION
    return _PLASTIC if model.is_plastic else _SPRING


def _observable_code(scene):
    if scene.observes_penalty_force:
        return _PENALTY_FORCE
    simple = {symbols.y: _VELOCITY, symbols.x: _DISPLACEMENT}
    return simple.get(scene.observable_expression, _FORMULA)


def gaussian_step(matrix: np.ndarray, sigma: float, step: float) -> tuple[tuple, tuple]:
    """Exact Gaussian step of d r = matrix r dt + sigma e_1 dW.

    For short steps the covariance is found as in Van Loan (1978), for long steps from the
    stationary covariance.

    Parameters
    ----------
    matrix : numpy.ndarray, shape (1, 1) or (2, 2)
    sigma : float
    step : float

    Returns
    -------
    transition : tuple of 4 floats
        exp(matrix step) less the identity, row by row.
    factor : tuple of 3 floats
        Lower triangle of the Cholesky factor of the covariance.
    """
    size = len(matrix)
    diffusion = np.zeros((size, size))
    diffusion[0, 0] = sigma**2
    transition = scipy.linalg.expm(matrix * step)
    lost = SceneError(
        f"the covariance of the noise over a step = {step:.1e} is lost in rounding; choose "
        "another step, or a noise whose parameters are of similar sizes"
    )
    if step * np.linalg.norm(matrix) < 1:
        block = np.block([[-matrix, diffusion], [np.zeros((size, size)), matrix.T]])
        covariance = transition @ scipy.linalg.expm(block * step)[:size, size:]
    else:  # over a long step, growing exponentials in the block would cost all digits
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)  # of equations changed to be solvable
            warnings.simplefilter("ignore", scipy.linalg.LinAlgWarning)  # examined below
            try:
                stationary = scipy.linalg.solve_continuous_lyapunov(matrix, -diffusion)
            except RuntimeWarning:
                raise lost from None
        covariance = stationary - transition @ stationary @ transition.T
    padded = np.zeros((2, 2, 2))
    padded[0, :size, :size] = transition - np.eye(size)
    try:
        padded[1, :size, :size] = np.linalg.cholesky((covariance + covariance.T) / 2)
    except np.linalg.LinAlgError:
        raise lost from None
    if size == 1:
        padded[0, 0, 0] = math.expm1(matrix[0, 0] * step)
    lower = padded[1, 0, 0], padded[1, 1, 0], padded[1, 1, 1]
    return tuple(map(float, padded[0].ravel())), tuple(map(float, lower))


@inlined
def flow(s, data, first, last, lanes):
    """Mechanical flows between two noise steps, or the first or the last half-flows."""
    # Each part is called at one place of the code only, because every call is compiled separately.
    half = s.step / like(s.step, 2.0)
    merged = not (s.moves or first or last)  # Y(h) in one flow
    for part in range(2):
        skipped = (part == 1 and (merged or last)) or (part == 0 and first)
        if not skipped:
            _accelerate(s, data, s.step if merged else half, lanes)
        if part == 0 and s.moves:
            _displace(s, data, half if first or last else s.step, lanes)


@inlined
def kick(s, data, normal, lanes):
    """Noise step on the normal numbers in row `normal` and, if it takes two, the next row."""
    if s.controlled:
        _gather_martingale(s, data, normal, lanes)
    if s.noise == _WHITE and s.observable == _VELOCITY:
        _shake_and_observe_velocity(s, data, normal, lanes)
        return
    weight = s.step / like(s.step, 2.0) if s.shaken else s.step
    for part in range(2):
        if part == 0 or s.shaken:
            _gain(s, data, weight, lanes)
        if part == 0:
            _shake(s, data, normal, lanes)
    observe(data, lanes)


@inlined
def _shake_and_observe_velocity(s, data, normal, lanes):
    """`kick` for white noise and g = y, in one loop: the scene of the paper's section 5."""
    decay, factor = s.transition[0], s.factor[0]
    half = s.step / like(s.step, 2.0)
    for i in range(lanes):
        before = data[Y, i]
        after = fma(decay, before, fma(factor, data[normal, i], before))
        data[Y, i] = after
        delta = fma(half, before + after, data[DELTA, i])
        data[DELTA, i] = delta
        data[PEAK, i] = larger(data[PEAK, i], abs(data[BASE, i] + delta))


@inlined
def _shake(s, data, normal, lanes):
    (a, b, c, d), (e, f, g) = s.transition, s.factor
    if not s.linear:
        driven = ZETA if s.noise == _HAMILTONIAN else ETA
        for part in range(2):
            _drift_flow(s, data, s.step / like(s.step, 2.0), lanes)
            if part == 0:
                for i in range(lanes):
                    data[driven, i] += e * data[normal, i]
    elif s.noise == _HAMILTONIAN:
        for i in range(lanes):
            zeta, eta = data[ZETA, i], data[ETA, i]
            data[ZETA, i] = zeta + fma(a, zeta, fma(b, eta, e * data[normal, i]))
            data[ETA, i] = eta + fma(
                c, zeta, fma(d, eta, fma(f, data[normal, i], g * data[normal + 1, i]))
            )
    else:
        row = ETA if s.noise == _LANGEVIN else Y
        for i in range(lanes):
            data[row, i] += fma(a, data[row, i], e * data[normal, i])


@inlined
def _drift_flow(s, data, t, lanes):
    """Classical Runge-Kutta step of the deterministic part of a nonlinear noise."""
    # The scratch rows from WORK on are free here, because no value of g is kept in them now.
    stage, slope, total = WORK, WORK + 4, WORK + 6
    two, zero = like(t, 2.0), like(t, 0.0)
    for row in range(2):
        for i in range(lanes):
            data[stage + row, i] = data[ZETA + row, i]
            data[slope + row, i] = data[total + row, i] = zero
    for k in range(4):
        weight = two if k == 1 or k == 2 else like(t, 1.0)
        reach = t / two if k < 2 else t
        if s.noise == _HAMILTONIAN:
            evaluate(s.first_drift, data[slope].ctypes, data[stage:].ctypes, WIDTH, lanes)
        evaluate(s.second_drift, data[slope + 1].ctypes, data[stage:].ctypes, WIDTH, lanes)
        for row in range(2):
            for i in range(lanes):
                data[total + row, i] += weight * data[slope + row, i]
                data[stage + row, i] = fma(reach, data[slope + row, i], data[ZETA + row, i])
    for row in range(2):
        for i in range(lanes):
            data[ZETA + row, i] = fma(t / like(t, 6.0), data[total + row, i], data[ZETA + row, i])


@inlined
def _gain(s, data, weight, lanes):
    """Add g, times a weight, to the step's gain."""
    if s.observable == _VELOCITY:
        for i in range(lanes):
            data[GAIN, i] = fma(weight, data[Y, i], data[GAIN, i])
    elif s.observable == _DISPLACEMENT:
        for i in range(lanes):
            data[GAIN, i] = fma(weight, data[X, i], data[GAIN, i])
    elif s.observable == _FORMULA:
        evaluate(s.formula, data[WORK].ctypes, data[ZETA:].ctypes, WIDTH, lanes)
        for i in range(lanes):
            data[GAIN, i] = fma(weight, data[WORK, i], data[GAIN, i])


@inlined
def _gather_martingale(s, data, normal, lanes):
    """Add the martingale's increment, c kick + c' (kick^2 - its mean)/2, and its variance.

    c = u' at the state before the kick. This is u(y + kick) - u(y) to second order, minus its mean.
    To first order only, it would leave an error of the order of the square root of the step.
    """
    one, two = like(s.reach, 1.0), like(s.reach, 2.0)
    below, above = s.control
    for i in range(lanes):
        negative = data[Y, i] < like(one, 0.0)
        place = minimum(abs(data[Y, i]) / s.reach, one)
        value, slope = where(negative, below[DEGREE], above[DEGREE]), like(one, 0.0)
        for k in range(DEGREE):
            slope = fma(slope, place, value)
            other = DEGREE - 1 - k
            value = fma(value, place, where(negative, below[other], above[other]))
        first = s.factor[0] * value
        second = s.factor[0] * s.factor[0] / (two * s.reach) * where(negative, -slope, slope)
        kick = data[normal, i]
        data[MARTINGALE, i] += fma(first, kick, second * fma(kick, kick, -one))
        data[VARIATION, i] += fma(first, first, two * second * second)


@inlined
def _displace(s, data, t, lanes):
    """X: the displacement (and the obstacle's velocity) over a time t."""
    weight = like(t, 1.0) if s.observable == _PENALTY_FORCE else like(t, 0.0)
    if s.penalty == _FRICTION:
        for i in range(lanes):
            data[X, i] = fma(t, data[Y, i], data[X, i])
    elif s.penalty == _PLASTIC:
        for i in range(lanes):
            y, x = data[Y, i], data[X, i]
            if s.limit:
                after = exact_flows.confined(x, t, y)
            elif s.inner == like(t, 0.0):
                after = exact_flows.yielding(x, t, y, s.knot, s.outer)
            else:
                after = exact_flows.penalised(x, t, y, like(t, 0.0), s.knot, s.inner, s.outer)
            data[X, i] = after
            data[GAIN, i] += weight * (fma(y, t, x) - after)
    else:
        per_knot = like(t, 1.0) / s.knot
        for i in range(lanes):
            y, x = data[Y, i], data[X, i]
            if s.limit:
                after, x = exact_flows.elastic_impact(y, x, t)
            else:
                # in units of the knot, the displacement at which the contact begins
                after, x = exact_flows.spring_contact(per_knot * y, per_knot * x, t, s.omega)
                after, x = s.knot * after, s.knot * x
            data[Y, i], data[X, i] = after, x
            data[GAIN, i] += weight * (y - after)


@inlined
def _accelerate(s, data, t, lanes):
    """Y: the velocity over a time t, with displacement and forcing frozen."""
    undriven = s.noise == _WHITE and not s.pushed
    if undriven and s.penalty != _FRICTION:
        return
    if undriven and s.dry and s.observable != _PENALTY_FORCE:
        for i in range(lanes):
            data[Y, i] = exact_flows.at_rest(
                data[Y, i], t, s.knot, like(t, 1.0) if s.limit else s.inner
            )
        return
    if s.pushed and s.slope == 0:
        linear, cubic = s.spring
        for i in range(lanes):
            x = data[X, i]
            data[WORK, i] = data[ETA, i] - x * fma(cubic * x, x, linear)
    elif s.pushed:
        evaluate(s.slope, data[WORK].ctypes, data[ZETA:].ctypes, WIDTH, lanes)
        for i in range(lanes):
            data[WORK, i] = data[ETA, i] - data[WORK, i]
    else:
        for i in range(lanes):
            data[WORK, i] = data[ETA, i]
    if s.penalty == _FRICTION:
        weight = like(t, 1.0) if s.observable == _PENALTY_FORCE else like(t, 0.0)
        for i in range(lanes):
            y = data[Y, i]
            if s.limit:
                after = exact_flows.dry_friction(y, t, data[WORK, i], s.rate)
            else:
                after = exact_flows.penalised(y, t, data[WORK, i], s.rate, s.knot, s.inner, s.outer)
            data[Y, i] = after
            damped = s.rate * (y + after) / like(t, 2.0)
            data[GAIN, i] += weight * (fma(data[WORK, i] - damped, t, y) - after)
    else:
        for i in range(lanes):
            data[Y, i] = exact_flows.relax(data[Y, i], t, data[WORK, i], s.rate)


STRANG = Scheme(
    name="strang",
    kind=Strang,
    coefficients=coefficients,
    flow=flow,
    kick=kick,
    smooth_order=2.0,
    kink_order=1.5,
    longest_step=longest_step,
    handles=handles,
    gains_in_kicks=gains_in_kicks,
)
