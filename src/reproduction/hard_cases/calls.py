"""The functions that the cases call.

Each function returns the `evaluate` of a `Case`. A scene is passed as a function that builds it,
because building it may be refused, too.
"""

import math
from collections.abc import Callable

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.line.finite_differences import moments_with_error
from nonsmooth.paths.simulation import simulate
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.variance import variance
from reproduction.hard_cases.record import DEVIATIONS, Result

# The bias of a step follows from halving it and from the weak order of the scheme, say 3/2. If the
# order were only 1, the bias would be larger by this factor.
_LOWER_ORDER = (1 - 2**-1.5) / (1 - 2**-1.0)

Build = Callable[[], Scene]
Evaluate = Callable[[int | None], Result]


def gamma2(scene: Build, deviations: float = 1.0, **options) -> Evaluate:
    """Call `asymptotic_variance`; its error is multiplied by `deviations`."""

    def evaluate(paths):
        found = asymptotic_variance(scene(), **options)
        return Result(found.value, deviations * found.error)

    return evaluate


def simulated(
    scene: Build,
    time: float,
    statistic: str = "variance",
    scale: float = 1.0,
    share: float = 1.0,
    **options,
) -> Evaluate:
    """Simulate the integral of g up to a time with a share of the paths.

    The result is its variance or its mean, divided by `scale`.
    """

    def evaluate(paths):
        count = max(8, round(share * paths))
        run = simulate(scene(), horizon=time, times=[time], paths=count, **options).isel(time=0)
        value, error, bias, spread = (
            float(run[f"{statistic}{suffix}"]) / scale
            for suffix in ("", "_error", "_bias", "_bias_error")
        )
        return Result(value, _LOWER_ORDER * abs(bias) + DEVIATIONS * math.hypot(error, spread))

    return evaluate


def accumulated(scene: Build, step: float) -> Evaluate:
    """Simulate the mean of g with 32 very long paths: 1600 steps for each of the usual paths.

    If 20000 paths are usual, these are 3.2e7 steps. A sum of similar numbers in single precision
    stops changing after about 2^24 of them.
    """

    def evaluate(paths):
        time = 1600 * paths * step
        options = {"share": 32 / paths, "step": step, "precision": "float32"}
        return simulated(scene, time, "mean", time, **options)(paths)

    return evaluate


def crossed(scene: Build, threshold: float, horizon: float, **options) -> Evaluate:
    """Call `crossing_probability`."""

    def evaluate(paths):
        sampled = options.get("method", "monte_carlo") == "monte_carlo"
        own = {"paths": paths} if sampled else {}
        run = crossing_probability(scene(), threshold, [horizon], **options, **own).isel(horizon=0)
        value, error = float(run["probability"]), float(run["probability_error"])
        if sampled:
            parts = float(run["standard_error"]), float(run["step_bias_error"])
            error = DEVIATIONS * math.hypot(*parts)
            error += _LOWER_ORDER * abs(float(run["step_bias"]))
        return Result(value, error)

    return evaluate


def solved(scene: Build, time: float, **options) -> Evaluate:
    """Call `variance`."""

    def evaluate(paths):
        run = variance(scene(), [time], **options).isel(time=0)
        return Result(float(run["v"]), float(run["v_error"]))

    return evaluate


def finite_differences(
    scene: Build, time: float, half_width: float, nodes: int, time_step: float = 0.01
) -> Evaluate:
    """Call the paper's finite differences."""

    def evaluate(paths):
        _, v, _, error = moments_with_error(scene(), [time], half_width, nodes, time_step)
        return Result(v[0], error[0])

    return evaluate


def brownian_value(b: float, T: float) -> Evaluate:
    """Call `brownian_crossing`; its relative error is below 1e-13."""

    def evaluate(paths):
        value = float(brownian_crossing(b, T))
        return Result(value, 1e-13 * value)

    return evaluate


def friction(**parameters) -> Build:
    """Describe a scene of dry friction, with white noise and n = 100 unless told otherwise."""
    return lambda: Scene(**({"model": "friction"} | parameters))
