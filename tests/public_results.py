"""A result of each public function, at sizes that take no time."""

from functools import cache

import numpy as np
import xarray as xr

import nonsmooth as ns
from references import COLORED_FRICTION, FRICTION, OBSTACLE

TIMES = [0.5, 1.0, 2.0]
_TIMES = xr.DataArray(TIMES, dims="horizon", coords={"horizon": TIMES})
STEPS = {"step": 0.1, "paths": 2000, "seed": 1}


def _density():
    points = {"x": np.linspace(-1, 1, 15), "y": np.linspace(-2, 2, 21)}
    return ns.invariant_density(OBSTACLE, points=points)


def as_dataset(result):
    """Return a result, whatever it is, as the dataset that a file has of it."""
    if isinstance(result, ns.Estimate):
        return result.to_dataset()
    return result if isinstance(result, xr.Dataset) else result.to_dataset(name="values")


RESULTS = {
    name: cache(make)
    for name, make in {
        "asymptotic_variance": lambda: ns.asymptotic_variance(FRICTION),
        "mean": lambda: ns.mean(FRICTION),
        "sampled": lambda: ns.asymptotic_variance(FRICTION, method="monte_carlo", tol=0.2),
        "sensitivity": lambda: ns.asymptotic_variance_sensitivity(FRICTION, "damping"),
        "spectral_gap": lambda: ns.spectral_gap(FRICTION),
        "extrapolation_length": lambda: ns.extrapolation_length(FRICTION),
        "variance": lambda: ns.variance(FRICTION, TIMES),
        "invariant_density": _density,
        "density of one variable": lambda: ns.invariant_density(FRICTION),
        "crossing_probability": lambda: ns.crossing_probability(FRICTION, 0.6, TIMES, tol=1e-4),
        "one horizon": lambda: ns.crossing_probability(FRICTION, 0.6, 2.0, method="asymptotic"),
        "corrected": lambda: ns.crossing_probability(FRICTION, 0.6, TIMES, 100, "corrected"),
        "led": lambda: ns.crossing_probability(
            FRICTION, 0.3, TIMES, method="importance_sampling", **STEPS
        ),
        "envelope": lambda: ns.crossing_probability(
            FRICTION, 0.6, TIMES, envelope="t*exp(1 - t)", **STEPS
        ),
        "crossing_sensitivity": lambda: ns.crossing_sensitivity(
            FRICTION, 0.6, TIMES, "damping", tol=0.2
        ),
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
        "brownian_crossing": lambda: ns.brownian_crossing(1.0, _TIMES),
        "brownian_first_passage_density": lambda: ns.brownian_first_passage_density(1.0, _TIMES),
        "crossing_threshold": lambda: ns.crossing_threshold(
            FRICTION, [0.1, 0.5], TIMES, method="asymptotic"
        ),
        "failure_time": lambda: ns.failure_time(FRICTION, 0.6, [0.1, 0.5], method="asymptotic"),
        "median": lambda: ns.failure_time(FRICTION, 0.6, method="asymptotic"),
        "mean_time_to_failure": lambda: ns.mean_time_to_failure(FRICTION, 0.6, **STEPS),
        "hazard_rate": lambda: ns.hazard_rate(FRICTION, 0.6, TIMES, **STEPS),
        "reliability_index": lambda: ns.reliability_index(
            ns.crossing_probability(FRICTION, [0.5, 0.6], TIMES, method="asymptotic")
        ),
    }.items()
}
