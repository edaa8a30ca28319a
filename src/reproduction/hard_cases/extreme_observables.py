"""Hard cases: extreme observables and starts, and parameters that are not a number."""

import math

from nonsmooth.scenes.noises import Langevin
from nonsmooth.scenes.scene import Scene
from reproduction.hard_cases.calls import crossed, friction, gamma2, simulated, solved
from reproduction.hard_cases.record import Case, Result
from reproduction.hard_cases.references import (
    gamma2_by_nested_quadrature,
    integrated_ornstein_uhlenbeck,
    other_method,
)

_FAR_START = friction(start={"y": 50.0})


def _steep():
    return Scene("obstacle", potential="exp(500*x**2)", observable="x")


def _quartic():
    return Scene("friction", Langevin("eta**4/4"), start={"eta": 50.0})


def _variance_from_far():
    """Take the friction as 1 until t = 2, when y, from 50, is still 8 deviations above 0."""
    return integrated_ornstein_uhlenbeck(1.0, 2.0)


def _crossed_from_far():
    """P(int y >= 40) at t = 1.6 by a normal law: y, from 50, is above 8, so the friction is 1."""
    t = 1.6
    mean = -51 * math.expm1(-t) - t
    deviation = math.sqrt(integrated_ornstein_uhlenbeck(1.0, t).value)
    return Result(math.erfc((40 - mean) / deviation / math.sqrt(2)) / 2, 1e-12)


CASES = [
    Case(
        r"$g = \sin 50 y$, many zeros",
        "asymptotic_variance",
        gamma2(friction(n=math.inf, observable="sin(50*y)")),
        lambda: gamma2_by_nested_quadrature(lambda s: math.sin(50 * s)),
    ),
    Case(
        r"$g = \sin 50 y$, many zeros",
        "simulate",
        simulated(friction(observable="sin(50*y)"), 10.0, step=0.02),
        None,
    ),
    Case(
        r"$g = \operatorname{sgn} y$",
        "asymptotic_variance",
        gamma2(friction(n=math.inf, observable="sign(y)")),
        lambda: gamma2_by_nested_quadrature(lambda s: math.copysign(1.0, s)),
    ),
    Case(
        r"$g = \operatorname{sgn} y$",
        "simulate",
        simulated(friction(observable="sign(y)"), 10.0, step=0.02),
        lambda: other_method(solved(friction(observable="sign(y)"), 10.0)),
    ),
    Case(
        "$g = y^4$, against $g^2 \\leq V$",
        "asymptotic_variance",
        gamma2(friction(n=math.inf, observable="y**4")),
        lambda: gamma2_by_nested_quadrature(lambda s: s**4),
    ),
    Case(
        "$g = e^{y^2}$, against $g^2 \\leq V$",
        "asymptotic_variance",
        gamma2(friction(observable="exp(y**2)")),
        None,
    ),
    Case(
        "$g = e^{y^2}$, against $g^2 \\leq V$",
        "simulate",
        simulated(friction(observable="exp(y**2)"), 10.0, step=0.02),
        None,
    ),
    Case(
        "start at $y = 50$", "simulate", simulated(_FAR_START, 2.0, step=0.02), _variance_from_far
    ),
    Case("start at $y = 50$", "variance", solved(_FAR_START, 2.0), None),
    Case(
        "start at $y = 50$",
        "crossing, deterministic",
        crossed(_FAR_START, 40.0, 1.6, method="deterministic"),
        _crossed_from_far,
    ),
    Case(
        "start at $\\eta = 50$, $v = \\eta^4\\!/4$",
        "simulate",
        simulated(_quartic, 5.0, step=0.1),
        None,
    ),
    Case("overflow in $U$", "simulate", simulated(_steep, 1.0, step=0.05), None),
    Case(
        "overflow in $g = e^{50 y}$",
        "simulate",
        simulated(friction(observable="exp(50*y)"), 10.0, step=0.1),
        None,
    ),
    Case(
        "overflow in $g = e^{50 y}$",
        "asymptotic_variance",
        gamma2(friction(observable="exp(50*y)")),
        None,
    ),
    Case(r"$g = \log y$", "variance", solved(friction(observable="log(y)"), 10.0), None),
    Case(
        r"$g = \log y$",
        "crossing, Monte Carlo",
        crossed(friction(observable="log(y)"), 0.6, 2.0, step=0.1),
        None,
    ),
    Case("$n$ not a number", "Scene", gamma2(friction(n=math.nan)), None),
    Case("$T$ not a number", "variance", solved(friction(), math.nan), None),
    Case("$b$ not a number", "crossing, Monte Carlo", crossed(friction(), math.nan, 2.0), None),
]
