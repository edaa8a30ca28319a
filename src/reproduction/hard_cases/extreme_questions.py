"""Hard cases: extreme thresholds and horizons, unsuitable grids, long sums."""

from reproduction.hard_cases.calls import (
    accumulated,
    brownian_value,
    crossed,
    finite_differences,
    friction,
    simulated,
    solved,
)
from reproduction.hard_cases.record import Case, Result
from reproduction.hard_cases.references import (
    brownian_by_images,
    friction_mean_square,
    integrated_ornstein_uhlenbeck,
    other_method,
)

CASES = [
    Case(
        "$p = 10^6$",
        "crossing, deterministic",
        crossed(friction(), 0.6, 2.0, p=1e6, method="deterministic"),
        lambda: other_method(crossed(friction(), 0.6, 2.0, p=1e6, method="corrected", order=3)),
    ),
    Case(
        "$p = 10^{-3}$",
        "crossing, Monte Carlo",
        crossed(friction(), 1e-3, 2.0, p=1e-3),
        lambda: other_method(crossed(friction(), 1e-3, 2.0, p=1e-3, method="deterministic")),
    ),
    Case(
        "$p = 10^{-3}$",
        "crossing, corrected formula",
        crossed(friction(), 1e-3, 2.0, p=1e-3, method="corrected", order=2),
        lambda: other_method(crossed(friction(), 1e-3, 2.0, p=1e-3, method="deterministic")),
    ),
    Case("$b = 10^{-6}$", "brownian_crossing", brownian_value(1e-6, 2.0), lambda: Result(1.0, 0.0)),
    Case(
        "$b = 10^{-6}$",
        "crossing, Monte Carlo",
        crossed(friction(), 1e-6, 2.0, p=10),
        lambda: Result(1.0, 0.0),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "brownian_crossing",
        brownian_value(7.3, 1.0),
        lambda: brownian_by_images(7.3, 1.0),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "crossing, deterministic",
        crossed(friction(), 3.75, 2.0, p=1000, method="deterministic"),
        lambda: other_method(crossed(friction(), 3.75, 2.0, p=1000, method="corrected", order=3)),
    ),
    Case(
        "$b$ of probability $10^{-12}$",
        "crossing, Monte Carlo",
        crossed(friction(), 3.75, 2.0, p=1000, step=0.1),
        lambda: Result(1e-12, 1e-12),
    ),
    Case(
        r"$T = 10^{-6}$",
        "variance",
        solved(friction(), 1e-6),
        lambda: integrated_ornstein_uhlenbeck(101.0, 1e-6),
    ),
    Case(
        r"$T = 10^{-6}$",
        "simulate",
        simulated(friction(), 1e-6, step=1e-7),
        lambda: integrated_ornstein_uhlenbeck(101.0, 1e-6),
    ),
    Case(
        "$L = 1$ in the paper's scheme",
        "finite_difference",
        finite_differences(friction(), 10.0, 1.0, 401),
        None,
    ),
    Case(
        r"$\Delta y$ so large that the cell P\'eclet number is 5",
        "finite_difference",
        finite_differences(friction(), 10.0, 10.0, 41),
        None,
    ),
    Case(
        "$10^9$ steps of 32 paths, single precision",
        "simulate, mean",
        accumulated(friction(observable="y**2"), step=0.02),
        lambda: friction_mean_square(100.0),
    ),
]
