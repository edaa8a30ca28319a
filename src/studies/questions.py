"""What a study can ask: for each question a function of the library, and what its numbers are.

How to add one: an entry of `QUESTIONS`. The arguments are those of the function that a study may
give, each with what it is: powers of the base quantities, with ``"g"`` for the observable,
``"variable"`` for the variable of the state and ``"parameter"`` for the parameter that the question
names; `PLAIN` for numbers without
units. The values are the variables of the answer; those that are not named are
plain numbers. Errors have the units of what they belong to.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from nonsmooth.boundary_layer.extrapolation_length import extrapolation_length
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.crossing.state.crossing import state_crossing_probability
from nonsmooth.reliability.mean_time import mean_time_to_failure
from nonsmooth.reliability.quantiles import crossing_threshold, failure_time
from nonsmooth.sensitivity.crossing import crossing_sensitivity
from nonsmooth.sensitivity.gamma2 import asymptotic_variance_sensitivity
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.invariant_density import invariant_density
from nonsmooth.statistics.mean import mean
from nonsmooth.statistics.spectral_gap import spectral_gap
from nonsmooth.statistics.variance import variance
from studies.units import Powers

PLAIN: Powers = {}
TIME = {"time": 1}
INTEGRAL = {"g": 1, "time": 1}
VARIABLE = {"variable": 1}
# of the state; the accelerations of the ground are those of the noise
VARIABLES = {
    "y": {"length": 1, "time": -1},
    "x": {"length": 1},
    "eta": {"length": 1, "time": -2},
    "zeta": {"length": 1, "time": -3},
}
_DENSITIES = {(name,): powers for name, powers in VARIABLES.items()} | {
    ("y", "x"): {"length": 2, "time": -1},
    ("eta", "y"): {"length": 2, "time": -3},
}

# of all questions about the crossing of the integral
_CROSSING = {
    "p": PLAIN,
    "method": PLAIN,
    "tol": PLAIN,
    "step": TIME,
    "paths": PLAIN,
    "order": PLAIN,
}


@dataclass(frozen=True)
class Question:
    """A question.

    Attributes
    ----------
    title : str
        As a heading.
    solve : callable
        Takes a scene and arguments by name; returns an Estimate or an xarray.Dataset.
    values : dict
        From variables and coordinates of the answer to (what it is, long name); the first one is
        the name of an Estimate.
    arguments : dict
        From arguments to what they are.
    required : tuple of str
        Arguments that must be given.
    sampled : bool
        Whether the function takes a seed and threads.
    """

    title: str
    solve: Callable
    values: Mapping[str, tuple[Powers, str]]
    arguments: Mapping[str, Powers] = field(default_factory=dict)
    required: tuple[str, ...] = ()
    sampled: bool = True


QUESTIONS: dict[str, Question] = {
    "asymptotic_variance": Question(
        "Asymptotic variance",
        asymptotic_variance,
        {"gamma2": ({"g": 2, "time": 1}, "asymptotic variance gamma^2 of the integral of g")},
        {"tol": PLAIN, "method": PLAIN},
    ),
    "mean": Question(
        "Mean",
        mean,
        {"mean": ({"g": 1}, "stationary mean of g")},
        {"tol": {"g": 1}, "method": PLAIN},
    ),
    "variance": Question(
        "Variance at finite times",
        variance,
        {
            "v": ({"g": 2, "time": 2}, "variance of the integral of g"),
            "w": (INTEGRAL, "mean of the integral of g - E g"),
            "time": (TIME, "time"),
        },
        {"times": TIME, "tol": {"g": 2, "time": 1}, "method": PLAIN},
        required=("times",),
    ),
    "invariant_density": Question(
        "Invariant densities",
        invariant_density,
        {
            f"density_{'_'.join(names)}": (
                {base: -power for base, power in powers.items()},
                f"invariant density of {', '.join(names)}",
            )
            for names, powers in _DENSITIES.items()
        }
        | {
            "y": (VARIABLES["y"], "velocity"),
            "x": (VARIABLES["x"], "displacement, or elastic deformation"),
            "eta": (VARIABLES["eta"], "noise eta, which drives the velocity"),
            "zeta": (VARIABLES["zeta"], "noise zeta, the rate of eta"),
        },
        {"tol": PLAIN},
        sampled=False,
    ),
    "spectral_gap": Question(
        "Spectral gap",
        spectral_gap,
        {"gap": ({"time": -1}, "rate at which correlations decay")},
        {"tol": PLAIN},
        sampled=False,
    ),
    "extrapolation_length": Question(
        "Extrapolation length",
        extrapolation_length,
        {"kappa": (INTEGRAL, "distance of the Brownian threshold beyond that of the scene")},
        {"tol": INTEGRAL, "side": PLAIN},
    ),
    "crossing_probability": Question(
        "Probability of crossing",
        crossing_probability,
        {
            "probability": (PLAIN, "probability that the integral of g has left the interval"),
            "lower": (PLAIN, "the probability is above"),
            "upper": (PLAIN, "the probability is below"),
            "horizon": (TIME, "time"),
            "threshold": (INTEGRAL, "threshold"),
            "threshold_lower": (INTEGRAL, "lower end of the interval"),
            "threshold_upper": (INTEGRAL, "upper end of the interval"),
        },
        {"threshold": INTEGRAL, "horizons": TIME, "precision": PLAIN} | _CROSSING,
        required=("threshold", "horizons"),
    ),
    "crossing_threshold": Question(
        "Threshold that is crossed with a probability",
        crossing_threshold,
        {
            "threshold": (INTEGRAL, "threshold of the integral of g"),
            "lower": (INTEGRAL, "the threshold is above"),
            "upper": (INTEGRAL, "the threshold is below"),
            "probability": (PLAIN, "probability of having crossed it"),
            "horizon": (TIME, "time"),
        },
        {"probability": PLAIN, "horizons": TIME, "sides": PLAIN} | _CROSSING,
        required=("probability", "horizons"),
    ),
    "failure_time": Question(
        "Time by which a threshold is crossed with a probability",
        failure_time,
        {
            "time": (TIME, "time by which the integral of g has left the interval"),
            "lower": (TIME, "the time is above"),
            "upper": (TIME, "the time is below"),
            "probability": (PLAIN, "probability of having left it"),
        },
        {"threshold": INTEGRAL, "probability": PLAIN} | _CROSSING,
        required=("threshold",),
    ),
    "mean_time_to_failure": Question(
        "Mean time to failure",
        mean_time_to_failure,
        {"time": (TIME, "mean time at which the integral of g leaves the interval")},
        {"threshold": INTEGRAL}
        | {name: kind for name, kind in _CROSSING.items() if name != "order"},
        required=("threshold",),
    ),
    "asymptotic_variance_sensitivity": Question(
        "Derivative of the asymptotic variance",
        asymptotic_variance_sensitivity,
        {"derivative": ({"g": 2, "time": 1}, "derivative of gamma^2 by the parameter")},
        {"parameter": PLAIN, "tol": PLAIN},
        required=("parameter",),
        sampled=False,
    ),
    "crossing_sensitivity": Question(
        "Derivative of the probability of crossing",
        crossing_sensitivity,
        {
            "derivative": ({"parameter": -1}, "derivative of the probability by the parameter"),
            "horizon": (TIME, "time"),
        },
        {
            "threshold": INTEGRAL,
            "horizons": TIME,
            "parameter": PLAIN,
            "p": PLAIN,
            "method": PLAIN,
            "tol": PLAIN,
        },
        required=("threshold", "horizons", "parameter"),
    ),
    "state_crossing_probability": Question(
        "Probability that the state crosses",
        state_crossing_probability,
        {
            "probability": (PLAIN, "probability that the variable has left the interval"),
            "lower": (PLAIN, "the probability is above"),
            "upper": (PLAIN, "the probability is below"),
            "horizon": (TIME, "time"),
        },
        {
            "variable": PLAIN,
            "threshold": VARIABLE,
            "horizons": TIME,
            "method": PLAIN,
            "tol": PLAIN,
            "step": TIME,
            "paths": PLAIN,
            "precision": PLAIN,
        },
        required=("variable", "threshold", "horizons"),
    ),
}
