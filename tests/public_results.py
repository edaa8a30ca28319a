"""A result of each public function, at sizes that take no time."""

from functools import cache

import numpy as np
import xarray as xr

import nonsmooth as ns
from references import COLORED_FRICTION, FRICTION, OBSTACLE

TIMES = [0.5, 1.0, 2.0]
STEPS = {"step": 0.1, "paths": 2000, "seed": 1}


def _density():
    points = {"x": np.linspace(-1, 1, 15), "y": np.linspace(-2, 2, 21)}
    return ns.invariant_density(OBSTACLE, points=points)


def _levels():
    horizons = xr.DataArray(TIMES, dims="horizon", coords={"horizon": TIMES})
    return ns.brownian_crossing(1.0, horizons)


RESULTS = {
    name: cache(make)
    for name, make in {
        "asymptotic_variance": lambda: ns.asymptotic_variance(FRICTION),
        "mean": lambda: ns.mean(FRICTION),
        "spectral_gap": lambda: ns.spectral_gap(FRICTION),
        "extrapolation_length": lambda: ns.extrapolation_length(FRICTION),
        "variance": lambda: ns.variance(FRICTION, TIMES),
        "invariant_density": _density,
        "density of one variable": lambda: ns.invariant_density(FRICTION),
        "crossing_probability": lambda: ns.crossing_probability(FRICTION, 0.6, TIMES, tol=1e-4),
        "asymptotic": lambda: ns.crossing_probability(FRICTION, 0.6, TIMES, method="asymptotic"),
        "counted": lambda: ns.crossing_probability(FRICTION, (-0.6, np.inf), TIMES, **STEPS),
        "thresholds": lambda: ns.crossing_probability(FRICTION, [0.5, 0.6], TIMES, tol=1e-4),
        "intervals": lambda: ns.crossing_probability(
            FRICTION, [(-0.5, 0.6), (-1, 0.4)], TIMES, method="asymptotic"
        ),
        "state_crossing_probability": lambda: ns.state_crossing_probability(
            FRICTION, "y", 1.0, TIMES
        ),
        "simulate": lambda: ns.simulate(FRICTION, 2.0, times=TIMES, **STEPS),
        "paths": lambda: ns.simulate(
            COLORED_FRICTION, 2.0, step=0.1, paths=3, times=TIMES, keep="paths"
        ),
        "brownian_crossing": _levels,
        "crossing_threshold": lambda: ns.crossing_threshold(
            FRICTION, [0.1, 0.5], TIMES, method="asymptotic"
        ),
        "failure_time": lambda: ns.failure_time(FRICTION, 0.6, [0.1, 0.5], method="asymptotic"),
        "hazard_rate": lambda: ns.hazard_rate(FRICTION, 0.6, TIMES, **STEPS),
        "reliability_index": lambda: ns.reliability_index(
            ns.crossing_probability(FRICTION, [0.5, 0.6], TIMES, method="asymptotic")
        ),
    }.items()
}
