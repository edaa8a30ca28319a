"""Hard cases: extreme scenes and steps, such as stiffness, damping, ringing ground, wells."""

import math

from nonsmooth.scenes.noises import KanaiTajimi
from nonsmooth.scenes.scene import Scene
from reproduction.hard_cases.calls import (
    crossed,
    finite_differences,
    friction,
    gamma2,
    simulated,
    solved,
)
from reproduction.hard_cases.record import DEVIATIONS, Case, Result
from reproduction.hard_cases.references import (
    gamma2_to_40_digits,
    kanai_tajimi_variance,
    obstacle_mean_square,
    other_method,
)

_STIFF, _LIMIT = friction(n=1e6), friction(n=math.inf)
_STRONG, _WEAK = friction(damping=1e3), friction(damping=1e-3)


def _ground():
    """Build ground motion that rings for 200 units of time."""
    return Scene("friction", KanaiTajimi(1.0, 0.01), observable="eta")


def _grazing():
    """Build an obstacle that starts at rest on the wall."""
    return Scene(
        "obstacle", n=1e6, potential="x**2/2", observable="x**2", start={"x": 1.0, "y": 0.0}
    )


def _wells():
    """Build two wells; the barrier between them is 4, eight times kT = 1/2."""
    return Scene("obstacle", potential="4*(1 - 2*x**2)**2", observable="x")


CASES = [
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate",
        simulated(_STIFF, 10.0, step=0.1),
        lambda: other_method(solved(_LIMIT, 10.0), 1e-9),
    ),
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate, drift-implicit",
        simulated(_STIFF, 10.0, step=0.1, scheme="drift_implicit"),
        lambda: other_method(solved(_LIMIT, 10.0), 1e-9),
    ),
    Case(
        "$n = 10^6$, $h = 0.1$",
        "simulate, Euler-Maruyama",
        simulated(_STIFF, 10.0, step=0.1, scheme="euler_maruyama"),
        None,
    ),
    Case("$n = 10^6$", "asymptotic_variance", gamma2(_STIFF), lambda: gamma2_to_40_digits(1e6, 1)),
    Case(
        "$h = 1$, as long as the relaxation",
        "simulate",
        simulated(friction(), 100.0, step=1.0),
        lambda: other_method(solved(friction(), 100.0)),
    ),
    Case(
        "$h = 50$, above every time scale",
        "simulate",
        simulated(friction(), 500.0, step=50.0),
        None,
    ),
    Case(
        "$h = 50$, above every time scale",
        "crossing, Monte Carlo",
        crossed(friction(), 0.6, 2.0, p=250, step=50.0),
        None,
    ),
    Case(
        "$C_b = 10^{-3}$",
        "asymptotic_variance",
        gamma2(_WEAK),
        lambda: gamma2_to_40_digits(100, 1e-3),
    ),
    Case(
        "$C_b = 10^{-3}$",
        "variance",
        solved(_WEAK, 10.0),
        lambda: other_method(finite_differences(_WEAK, 10.0, 30.0, 8001)),
    ),
    Case(
        "$C_b = 10^{-3}$",
        "simulate",
        simulated(_WEAK, 10.0, step=0.05),
        lambda: other_method(solved(_WEAK, 10.0)),
    ),
    Case(
        "$C_b = 10^3$",
        "asymptotic_variance",
        gamma2(_STRONG),
        lambda: gamma2_to_40_digits(100, 1e3),
    ),
    Case(
        "$C_b = 10^3$",
        "variance",
        solved(_STRONG, 1.0, tol=1e-15),
        lambda: other_method(finite_differences(_STRONG, 1.0, 0.3, 1001, 1e-3)),
    ),
    Case(
        "$C_b = 10^3$",
        "simulate",
        simulated(_STRONG, 1.0, step=2e-4),
        lambda: other_method(solved(_STRONG, 1.0, tol=1e-15)),
    ),
    Case(
        r"Kanai--Tajimi, $\gamma_0 = 0.01$",
        "simulate",
        simulated(_ground, 50.0, step=0.05),
        lambda: kanai_tajimi_variance(1.0, 0.01, 50.0),
    ),
    Case(
        r"Kanai--Tajimi, $\gamma_0 = 0.01$",
        "asymptotic_variance, Monte Carlo",
        gamma2(_ground, DEVIATIONS, tol=0.2, method="monte_carlo"),
        lambda: Result(1.0, 0.0),  # the force that is left over time balances the noise
    ),
    Case(
        "obstacle, $n = 10^6$, grazing start",
        "simulate, mean",
        simulated(_grazing, 400.0, "mean", 400.0, share=0.2, step=0.05),
        lambda: obstacle_mean_square(1e6),
    ),
    Case(
        "double well, barrier $8 kT$",
        "simulate",
        simulated(_wells, 20.0, step=0.02),
        lambda: other_method(solved(_wells, 20.0, tol=2e-2)),
    ),
    Case(
        "double well, barrier $8 kT$",
        "asymptotic_variance",
        gamma2(_wells, tol=1e-2),
        lambda: other_method(gamma2(_wells, tol=1e-4)),
    ),
    Case(
        "double well, barrier $8 kT$",
        "asymptotic_variance, Monte Carlo",
        gamma2(_wells, tol=0.2, method="monte_carlo"),
        None,
    ),
]
