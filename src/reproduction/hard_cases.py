"""Nasty cases: what the public functions return there, against independent references.

A result may be refused with a message, or come with an error that is larger than the true one.
Anything else is wrong: a value that is off by more than it says, or is not a number.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import mpmath
import numpy as np
import scipy.linalg
from scipy.integrate import quad

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.errors import AssumptionWarning, NonsmoothError
from nonsmooth.line.finite_differences import moments_with_error
from nonsmooth.paths.simulation import simulate
from nonsmooth.scenes.noises import KanaiTajimi, Langevin
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.variance import asymptotic_variance, variance

DEVIATIONS = 5.0  # standard errors within which a sampled result lies; beyond by chance: 6e-7

# Halving is turned into a bias by the weak order; half an order less would make it so much larger.
_ORDER = (1 - 2**-1.5) / (1 - 2**-1.0)

MET, REFUSED, WARNED, WRONG = "met", "refused", "warned", "WRONG"


@dataclass(frozen=True)
class Result:
    """A value and the error that is stated with it.

    Attributes
    ----------
    value, error : float
        Of a sampled value the error is the bias of the step, half an order granted, plus
        `DEVIATIONS` standard errors.
    """

    value: float
    error: float


@dataclass(frozen=True)
class Case:
    """One method in one nasty case.

    Attributes
    ----------
    title, method : str
        LaTeX, and the function called.
    evaluate : callable
        Takes the number of paths, which Monte Carlo alone uses, and returns a Result.
    reference : callable or None
        Returns an independent Result; None where only a refusal or a warning is right.
    """

    title: str
    method: str
    evaluate: Callable
    reference: Callable | None


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes
    ----------
    verdict : {"met", "refused", "warned", "WRONG"}
        ``"warned"``: with a warning, and within its error where there is a reference.
    value, error, reference, deviation : float
        Of the result; not a number where there is none. The deviation is from the reference.
    message : str
        The error or the warning.
    """

    verdict: str
    value: float = math.nan
    error: float = math.nan
    reference: float = math.nan
    deviation: float = math.nan
    message: str = ""


def examine(case, paths):
    """Run a case and judge it.

    Parameters
    ----------
    case : Case
    paths : int
        Number of paths of Monte Carlo.

    Returns
    -------
    Outcome
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", AssumptionWarning)
        try:
            found = case.evaluate(paths)
        except NonsmoothError as error:
            return Outcome(REFUSED, message=str(error))
        said = " ".join(dict.fromkeys(str(warning.message) for warning in caught))
        reference = case.reference() if case.reference else None
    value, error = float(found.value), float(found.error)
    finite = math.isfinite(value) and math.isfinite(error)
    if reference is None:
        return Outcome(WARNED if said and finite else WRONG, value, error, message=said)
    deviation = abs(value - reference.value)
    right = finite and deviation <= error + reference.error
    verdict = (WARNED if said else MET) if right else WRONG
    return Outcome(verdict, value, error, float(reference.value), deviation, said)


# What is called


def _growth(scene, deviations=1.0, **options):
    def evaluate(paths):
        found = asymptotic_variance(scene(), **options)
        return Result(found.value, deviations * found.error)

    return evaluate


def _simulated(scene, time, statistic="variance", scale=1.0, share=1.0, **options):
    """Simulate int g up to a time, on a share of the paths."""

    def evaluate(paths):
        count = max(8, round(share * paths))
        run = simulate(scene(), horizon=time, times=[time], paths=count, **options).isel(time=0)
        value, error, bias, spread = (
            float(run[f"{statistic}{suffix}"]) / scale
            for suffix in ("", "_error", "_bias", "_bias_error")
        )
        return Result(value, _ORDER * abs(bias) + DEVIATIONS * math.hypot(error, spread))

    return evaluate


def _accumulated(scene, step):
    """Simulate E g by a few long paths, in the end 1600 steps for each of the usual paths.

    Of 20000 paths, that is more than the 2^24 after which a sum of similar numbers stands still.
    """

    def evaluate(paths):
        time = 1600 * paths * step
        options = {"share": 32 / paths, "step": step, "precision": "float32"}
        return _simulated(scene, time, "mean", time, **options)(paths)

    return evaluate


def _crossed(scene, threshold, horizon, **options):
    def evaluate(paths):
        sampled = options.get("method", "monte_carlo") == "monte_carlo"
        own = {"paths": paths} if sampled else {}
        run = crossing_probability(scene(), threshold, [horizon], **options, **own).isel(horizon=0)
        value, error = float(run["probability"]), float(run["probability_error"])
        if sampled:
            error = DEVIATIONS * math.hypot(error, float(run["step_bias_error"]))
            error += _ORDER * abs(float(run["step_bias"]))
        return Result(value, error)

    return evaluate


def _solved(scene, time, **options):
    def evaluate(paths):
        run = variance(scene(), [time], **options).isel(time=0)
        return Result(float(run["v"]), float(run["v_error"]))

    return evaluate


def _differences(scene, time, half_width, nodes, time_step=0.01):
    def evaluate(paths):
        _, v, _, error = moments_with_error(scene(), [time], half_width, nodes, time_step)
        return Result(v[0], error[0])

    return evaluate


def _brownian_value(b, T):
    def evaluate(paths):
        value = float(brownian_crossing(b, T))
        return Result(value, 1e-13 * value)

    return evaluate


def _friction(**parameters):
    """Dry friction with white noise, built within the case: it may be refused."""
    return lambda: Scene(**({"model": "friction"} | parameters))


# References


def _by_mpmath(n, C_b):
    """gamma^2 of dry friction to 40 digits: u' is a scaled complementary error function."""

    def reference():
        with mpmath.workdps(40):
            C, N = mpmath.mpf(C_b), mpmath.mpf(n)
            knot = 1 / N

            def outside(s):  # m and m u' beyond the knot
                m = mpmath.exp(-C * s**2 - 2 * s + knot)
                tail = mpmath.exp(knot + 1 / C) * mpmath.sqrt(mpmath.pi / C)
                return m, (m - tail * mpmath.erfc(mpmath.sqrt(C) * s + 1 / mpmath.sqrt(C))) / C

            at_knot, flux_at_knot = outside(knot)

            def inside(s):
                m = mpmath.exp(-(C + N) * s**2)
                return m, flux_at_knot + (m - at_knot) / (C + N)

            far = knot + min(12 / mpmath.sqrt(C), mpmath.mpf(60))
            pieces = [
                (inside, [0, knot]),
                (outside, [knot, *(far * mpmath.mpf(k) / 16 for k in range(1, 17))]),
            ]
            square = mass = mpmath.mpf(0)
            for piece, interval in pieces:
                square += mpmath.quad(lambda s, f=piece: f(s)[1] ** 2 / f(s)[0], interval)
                mass += mpmath.quad(lambda s, f=piece: f(s)[0], interval)
            value = float(square / mass)
        return Result(value, 1e-15 * value)

    return reference


def _nested_quadrature(g):
    """gamma^2 of the non-smooth limit of dry friction, C_b = 1, adaptive in both integrals."""

    def reference():
        def m(s):
            return math.exp(-s * s - 2 * abs(s))

        def integral(f, a, b):
            return quad(
                f,
                a,
                b,
                points=[0.0] if a < 0 < b else None,
                epsabs=1e-12,
                epsrel=1e-10,
                limit=2000,
            )[0]

        end = 5.5
        total = integral(m, -end, end)
        mean = integral(lambda s: g(s) * m(s), -end, end) / total

        def flux(s):
            near, far = (s, end) if s > 0 else (-end, s)
            return math.copysign(2.0, s) * integral(lambda r: (g(r) - mean) * m(r), near, far)

        value = integral(lambda s: flux(s) ** 2 / m(s), -end, end) / total
        return Result(value, 1e-7 * value)

    return reference


def _integrated_ornstein_uhlenbeck(rate, time):
    """Variance of the integral of dY = -rate Y dt + dW; near 0 and far out friction is linear."""
    with mpmath.workdps(40):
        z = mpmath.mpf(rate) * time
        value = (z - 2 * (1 - mpmath.exp(-z)) + (1 - mpmath.exp(-2 * z)) / 2) / mpmath.mpf(
            rate
        ) ** 3
    return Result(float(value), 1e-15 * float(value))


def _linear_variance(k, c, time):
    """Variance of int eta of the Kanai-Tajimi filter from rest, by Van Loan (1978)."""
    matrix = np.array([[-c, -k, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    block = np.zeros((6, 6))
    block[:3, :3], block[3:, 3:], block[0, 3] = -matrix, matrix.T, 1.0
    grown = scipy.linalg.expm(block * time)
    value = (grown[3:, 3:].T @ grown[:3, 3:])[2, 2]
    return Result(value, 1e-9 * value)


def _gibbs_square(n):
    """Stationary mean of x^2 of the obstacle with U = x^2/2, C_b = 1."""

    def density(s):
        return math.exp(-(s * s) - n * max(s - 1, 0.0) ** 2)

    def integral(f):
        return sum(quad(f, a, b, epsabs=1e-13)[0] for a, b in ((0, 1), (1, 1 + 10 / math.sqrt(n))))

    value = integral(lambda s: s * s * density(s)) / integral(density)
    return Result(value, 1e-9)


def _stationary_square(n):
    """Stationary mean of y^2 of dry friction, C_b = 1."""

    def density(s):
        return math.exp(-s * s - (n * s * s if s < 1 / n else 2 * s - 1 / n))

    def integral(f):
        return sum(quad(f, a, b, epsabs=1e-13)[0] for a, b in ((0, 1 / n), (1 / n, 6)))

    value = integral(lambda s: s * s * density(s)) / integral(density)
    return Result(value, 1e-9)


def _images(b, T):
    """W_star by the images, to 50 digits."""

    def reference():
        with mpmath.workdps(50):
            r = mpmath.sqrt(2 * mpmath.mpf(T))
            images = [(-1) ** k * mpmath.erfc((2 * k + 1) * mpmath.mpf(b) / r) for k in range(40)]
            value = float(2 * mpmath.fsum(images))
        return Result(value, 1e-15 * value)

    return reference


def _other(evaluate, relative=0.0):
    """Another method's result as the reference, with its own or a relative error."""

    def reference():
        found = evaluate(None)
        return Result(found.value, max(found.error, relative * abs(found.value)))

    return reference


_WELLS = {"potential": "4*(1 - 2*x**2)**2", "observable": "x"}  # kT = 1/2, the barrier 4
_STIFF = _friction(n=1e6)
_STRONG, _WEAK = _friction(damping=1e3), _friction(damping=1e-3)
_TAIL = _friction(start={"y": 50.0})
_LIMIT = math.inf


def _ground():
    """Ground that rings for 200 units of time."""
    return Scene("friction", KanaiTajimi(1.0, 0.01), observable="eta")


def _grazing():
    """Obstacle that starts at rest on the wall."""
    return Scene(
        "obstacle", n=1e6, potential="x**2/2", observable="x**2", start={"x": 1.0, "y": 0.0}
    )


def _wells():
    return Scene("obstacle", **_WELLS)


def _steep():
    return Scene("obstacle", potential="exp(500*x**2)", observable="x")


def _quartic():
    return Scene("friction", Langevin("eta**4/4"), start={"eta": 50.0})


def _tail_reference():
    """Take the friction as 1 until t = 2: y, down from 50, is 8 deviations from 0 then."""
    return _integrated_ornstein_uhlenbeck(1.0, 2.0)


def _flown():
    """P(int y >= 40) at t = 1.6, normal: the friction is 1 until then, y from 50 above 8."""
    t = 1.6
    mean = -51 * math.expm1(-t) - t
    deviation = math.sqrt(_integrated_ornstein_uhlenbeck(1.0, t).value)
    return Result(math.erfc((40 - mean) / deviation / math.sqrt(2)) / 2, 1e-12)


CASES = [
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate",
        _simulated(_STIFF, 10.0, step=0.1),
        _other(_solved(_friction(n=_LIMIT), 10.0), 1e-9),
    ),
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate, drift-implicit",
        _simulated(_STIFF, 10.0, step=0.1, scheme="drift_implicit"),
        _other(_solved(_friction(n=_LIMIT), 10.0), 1e-9),
    ),
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate, Euler-Maruyama",
        _simulated(_STIFF, 10.0, step=0.1, scheme="euler_maruyama"),
        None,
    ),
    Case("$n = 10^6$", "asymptotic_variance", _growth(_STIFF), _by_mpmath(1e6, 1)),
    Case(
        "$h = 1$, as long as the relaxation",
        "simulate",
        _simulated(_friction(), 100.0, step=1.0),
        _other(_solved(_friction(), 100.0)),
    ),
    Case(
        "$h = 50$, above every time scale",
        "simulate",
        _simulated(_friction(), 500.0, step=50.0),
        None,
    ),
    Case(
        "$h = 50$, above every time scale",
        "crossing, Monte Carlo",
        _crossed(_friction(), 0.6, 2.0, p=250, step=50.0),
        None,
    ),
    Case("$C_b = 10^{-3}$", "asymptotic_variance", _growth(_WEAK), _by_mpmath(100, 1e-3)),
    Case(
        "$C_b = 10^{-3}$",
        "variance",
        _solved(_WEAK, 10.0),
        _other(_differences(_WEAK, 10.0, 30.0, 8001)),
    ),
    Case(
        "$C_b = 10^{-3}$",
        "simulate",
        _simulated(_WEAK, 10.0, step=0.05),
        _other(_solved(_WEAK, 10.0)),
    ),
    Case("$C_b = 10^3$", "asymptotic_variance", _growth(_STRONG), _by_mpmath(100, 1e3)),
    Case(
        "$C_b = 10^3$",
        "variance",
        _solved(_STRONG, 1.0, tol=1e-15),
        _other(_differences(_STRONG, 1.0, 0.3, 1001, 1e-3)),
    ),
    Case(
        "$C_b = 10^3$",
        "simulate",
        _simulated(_STRONG, 1.0, step=2e-4),
        _other(_solved(_STRONG, 1.0, tol=1e-15)),
    ),
    Case(
        r"Kanai--Tajimi, $\gamma_0 = 0.01$",
        "simulate",
        _simulated(_ground, 50.0, step=0.05),
        lambda: _linear_variance(1.0, 0.01, 50.0),
    ),
    Case(
        r"Kanai--Tajimi, $\gamma_0 = 0.01$",
        "asymptotic_variance, Monte Carlo",
        _growth(_ground, DEVIATIONS, tol=0.2, method="monte_carlo"),
        lambda: Result(1.0, 0.0),  # the force that is left over time balances the noise
    ),
    Case(
        "obstacle, $n = 10^6$, grazing start",
        "simulate, mean",
        _simulated(_grazing, 400.0, "mean", 400.0, share=0.2, step=0.05),
        lambda: _gibbs_square(1e6),
    ),
    Case(
        "double well, barrier $8 kT$",
        "simulate",
        _simulated(_wells, 20.0, step=0.02),
        _other(_solved(_wells, 20.0, tol=2e-2)),
    ),
    Case(
        "double well, barrier $8 kT$",
        "asymptotic_variance",
        _growth(_wells, tol=1e-2),
        _other(_growth(_wells, tol=1e-4)),
    ),
    Case(
        "double well, barrier $8 kT$",
        "asymptotic_variance, Monte Carlo",
        _growth(_wells, tol=0.2, method="monte_carlo"),
        None,
    ),
    Case(
        "$p = 10^6$",
        "crossing, deterministic",
        _crossed(_friction(), 0.6, 2.0, p=1e6, method="deterministic"),
        _other(_crossed(_friction(), 0.6, 2.0, p=1e6, method="corrected", order=3)),
    ),
    Case(
        "$p = 10^{-3}$",
        "crossing, Monte Carlo",
        _crossed(_friction(), 1e-3, 2.0, p=1e-3),
        _other(_crossed(_friction(), 1e-3, 2.0, p=1e-3, method="deterministic")),
    ),
    Case(
        "$p = 10^{-3}$",
        "crossing, corrected formula",
        _crossed(_friction(), 1e-3, 2.0, p=1e-3, method="corrected", order=2),
        _other(_crossed(_friction(), 1e-3, 2.0, p=1e-3, method="deterministic")),
    ),
    Case(
        "$b = 10^{-6}$", "brownian_crossing", _brownian_value(1e-6, 2.0), lambda: Result(1.0, 0.0)
    ),
    Case(
        "$b = 10^{-6}$",
        "crossing, Monte Carlo",
        _crossed(_friction(), 1e-6, 2.0, p=10),
        lambda: Result(1.0, 0.0),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "brownian_crossing",
        _brownian_value(7.3, 1.0),
        _images(7.3, 1.0),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "crossing, deterministic",
        _crossed(_friction(), 3.75, 2.0, p=1000, method="deterministic"),
        _other(_crossed(_friction(), 3.75, 2.0, p=1000, method="corrected", order=3)),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "crossing, Monte Carlo",
        _crossed(_friction(), 3.75, 2.0, p=1000, step=0.1),
        lambda: Result(1e-12, 1e-12),
    ),
    Case(
        r"$T = 10^{-6}$",
        "variance",
        _solved(_friction(), 1e-6),
        lambda: _integrated_ornstein_uhlenbeck(101.0, 1e-6),
    ),
    Case(
        r"$T = 10^{-6}$",
        "simulate",
        _simulated(_friction(), 1e-6, step=1e-7),
        lambda: _integrated_ornstein_uhlenbeck(101.0, 1e-6),
    ),
    Case(
        "$L = 1$ in the paper's scheme",
        "finite_difference",
        _differences(_friction(), 10.0, 1.0, 401),
        _other(_solved(_friction(), 10.0)),
    ),
    Case(
        r"$\Delta y$ so large that the cell P\'eclet number is 5",
        "finite_difference",
        _differences(_friction(), 10.0, 10.0, 41),
        None,
    ),
    Case(
        "$10^9$ steps of 32 paths, single precision",
        "simulate, mean",
        _accumulated(_friction(observable="y**2"), step=0.02),
        lambda: _stationary_square(100.0),
    ),
    Case(
        r"$g = \sin 50 y$, many zeros",
        "asymptotic_variance",
        _growth(_friction(n=_LIMIT, observable="sin(50*y)")),
        _nested_quadrature(lambda s: math.sin(50 * s)),
    ),
    Case(
        r"$g = \sin 50 y$, many zeros",
        "simulate",
        _simulated(_friction(observable="sin(50*y)"), 10.0, step=0.02),
        None,
    ),
    Case(
        r"$g = \operatorname{sgn} y$",
        "asymptotic_variance",
        _growth(_friction(n=_LIMIT, observable="sign(y)")),
        _nested_quadrature(lambda s: math.copysign(1.0, s)),
    ),
    Case(
        r"$g = \operatorname{sgn} y$",
        "simulate",
        _simulated(_friction(observable="sign(y)"), 10.0, step=0.02),
        _other(_solved(_friction(observable="sign(y)"), 10.0)),
    ),
    Case(
        "$g = y^4$, against $g^2 \\leq V$",
        "asymptotic_variance",
        _growth(_friction(n=_LIMIT, observable="y**4")),
        _nested_quadrature(lambda s: s**4),
    ),
    Case(
        "$g = e^{y^2}$, against $g^2 \\leq V$",
        "asymptotic_variance",
        _growth(_friction(observable="exp(y**2)")),
        None,
    ),
    Case(
        "$g = e^{y^2}$, against $g^2 \\leq V$",
        "simulate",
        _simulated(_friction(observable="exp(y**2)"), 10.0, step=0.02),
        None,
    ),
    Case("start at $y = 50$", "simulate", _simulated(_TAIL, 2.0, step=0.02), _tail_reference),
    Case("start at $y = 50$", "variance", _solved(_TAIL, 2.0), None),
    Case(
        "start at $y = 50$",
        "crossing, deterministic",
        _crossed(_TAIL, 40.0, 1.6, method="deterministic"),
        _flown,
    ),
    Case(
        "start at $\\eta = 50$, $v = \\eta^4\\!/4$",
        "simulate",
        _simulated(_quartic, 5.0, step=0.1),
        None,
    ),
    Case("overflow in $U$", "simulate", _simulated(_steep, 1.0, step=0.05), None),
    Case(
        "overflow in $g = e^{50 y}$",
        "simulate",
        _simulated(_friction(observable="exp(50*y)"), 10.0, step=0.1),
        None,
    ),
    Case(
        "overflow in $g = e^{50 y}$",
        "asymptotic_variance",
        _growth(_friction(observable="exp(50*y)")),
        None,
    ),
    Case(r"$g = \log y$", "variance", _solved(_friction(observable="log(y)"), 10.0), None),
    Case(
        r"$g = \log y$",
        "crossing, Monte Carlo",
        _crossed(_friction(observable="log(y)"), 0.6, 2.0, step=0.1),
        None,
    ),
    Case("$n$ not a number", "Scene", _growth(_friction(n=math.nan)), None),
    Case("$T$ not a number", "variance", _solved(_friction(), math.nan), None),
    Case("$b$ not a number", "crossing, Monte Carlo", _crossed(_friction(), math.nan, 2.0), None),
]
