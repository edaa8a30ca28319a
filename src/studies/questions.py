"""What a study can ask: for each question a function of the library, and what its numbers are.

How to add one: an entry of `QUESTIONS`. The arguments are those of the function that a study may
give, each with what it is: powers of the base quantities, with ``"g"`` for the observable,
``"variable"`` for the variable of the state and ``"parameter"`` for the parameter that the question
names; `PLAIN` for numbers without units; `OF_TIME` for a formula in t. The values are the variables
of the answer; those that are not named are plain numbers. Errors have the units of what they belong
to.

Functions are named, not imported: an answer then depends on the modules of its question and not on
those of all others.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from studies.units import Powers

PLAIN: Powers = {}
OF_TIME = "formula in t"
TIME = {"time": 1}
RATE = {"time": -1}
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
_COUNTED = {"precision": PLAIN, "envelope": OF_TIME}
_THRESHOLDS, _LEVELS = (
    {
        "threshold": (kind, "threshold"),
        "threshold_lower": (kind, "lower end of the interval"),
        "threshold_upper": (kind, "upper end of the interval"),
    }
    for kind in (INTEGRAL, VARIABLE)
)
_STATE = {
    "variable": PLAIN,
    "threshold": VARIABLE,
    "horizons": TIME,
    "method": PLAIN,
    "tol": PLAIN,
    "step": TIME,
    "paths": PLAIN,
}
_INDEX = {
    "reliability_index": (PLAIN, "reliability index beta of not having crossed"),
    "lower": (PLAIN, "the index is above"),
    "upper": (PLAIN, "the index is below"),
    "horizon": (TIME, "time"),
}


@dataclass(frozen=True)
class Question:
    """A question.

    Attributes
    ----------
    title : str
        As a heading.
    function : str
        With its module. It takes a scene and arguments by name and returns an Estimate or an
        xarray.Dataset.
    values : dict
        From variables and coordinates of the answer to (what it is, long name); the first one is
        the name of an Estimate.
    arguments : dict
        From arguments to what they are: powers, or `OF_TIME`.
    required : tuple of str
        Arguments that must be given.
    sampled : bool
        Whether the function takes a seed and threads.
    then : str
        A function with its module that turns what the first one returns into the answer, if any.
    """

    title: str
    function: str
    values: Mapping[str, tuple[Powers, str]]
    arguments: Mapping[str, Powers | str] = field(default_factory=dict)
    required: tuple[str, ...] = ()
    sampled: bool = True
    then: str = ""

    @property
    def solve(self) -> Callable:
        """The function."""
        return _imported(self.function)

    def turned(self, found: Any) -> Any:
        """Turn what the function returns into the answer."""
        return _imported(self.then)(found) if self.then else found

    @property
    def modules(self) -> list[str]:
        """Modules of the functions."""
        return [name.rpartition(".")[0] for name in (self.function, self.then) if name]


def _imported(name):
    module, _, function = name.rpartition(".")
    return getattr(import_module(module), function)


QUESTIONS: dict[str, Question] = {
    "asymptotic_variance": Question(
        "Asymptotic variance",
        "nonsmooth.statistics.asymptotic_variance.asymptotic_variance",
        {"gamma2": ({"g": 2, "time": 1}, "asymptotic variance gamma^2 of the integral of g")},
        {"tol": PLAIN, "method": PLAIN},
    ),
    "mean": Question(
        "Mean",
        "nonsmooth.statistics.mean.mean",
        {"mean": ({"g": 1}, "stationary mean of g")},
        {"tol": {"g": 1}, "method": PLAIN},
    ),
    "variance": Question(
        "Variance at finite times",
        "nonsmooth.statistics.variance.variance",
        {
            "v": ({"g": 2, "time": 2}, "variance of the integral of g"),
            "w": (INTEGRAL, "mean of the integral of g, less its stationary growth"),
            "time": (TIME, "time"),
        },
        {"times": TIME, "tol": {"g": 2, "time": 1}, "method": PLAIN, "envelope": OF_TIME},
        required=("times",),
    ),
    "invariant_density": Question(
        "Invariant densities",
        "nonsmooth.statistics.density.invariant_density.invariant_density",
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
        {"tol": PLAIN, "method": PLAIN},
    ),
    "spectral_gap": Question(
        "Spectral gap",
        "nonsmooth.statistics.spectral_gap.spectral_gap",
        {"gap": (RATE, "rate at which correlations decay")},
        {"tol": PLAIN},
        sampled=False,
    ),
    "extrapolation_length": Question(
        "Extrapolation length",
        "nonsmooth.boundary_layer.extrapolation_length.extrapolation_length",
        {"kappa": (INTEGRAL, "distance of the Brownian threshold beyond that of the scene")},
        {"tol": INTEGRAL, "side": PLAIN},
    ),
    "crossing_probability": Question(
        "Probability of crossing",
        "nonsmooth.crossing.probability.crossing_probability",
        {
            "probability": (PLAIN, "probability that the integral of g has left the interval"),
            "lower": (PLAIN, "the probability is above"),
            "upper": (PLAIN, "the probability is below"),
            "horizon": (TIME, "time"),
        }
        | _THRESHOLDS,
        {"threshold": INTEGRAL, "horizons": TIME} | _CROSSING | _COUNTED,
        required=("threshold", "horizons"),
    ),
    "reliability_index": Question(
        "Reliability index",
        "nonsmooth.crossing.probability.crossing_probability",
        _INDEX | _THRESHOLDS,
        {"threshold": INTEGRAL, "horizons": TIME} | _CROSSING | _COUNTED,
        required=("threshold", "horizons"),
        then="nonsmooth.reliability.index.reliability_index",
    ),
    "hazard_rate": Question(
        "Hazard rate",
        "nonsmooth.reliability.hazard.hazard_rate",
        {
            "hazard_rate": (RATE, "rate at which those cross that have not crossed yet"),
            "lower": (RATE, "the rate is above"),
            "upper": (RATE, "the rate is below"),
            "horizon": (TIME, "time"),
        },
        {"threshold": INTEGRAL, "horizons": TIME} | _CROSSING,
        required=("threshold", "horizons"),
    ),
    "crossing_threshold": Question(
        "Threshold that is crossed with a probability",
        "nonsmooth.reliability.quantiles.crossing_threshold",
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
        "nonsmooth.reliability.quantiles.failure_time",
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
        "nonsmooth.reliability.mean_time.mean_time_to_failure",
        {"time": (TIME, "mean time at which the integral of g leaves the interval")},
        {"threshold": INTEGRAL}
        | {name: kind for name, kind in _CROSSING.items() if name != "order"},
        required=("threshold",),
    ),
    "asymptotic_variance_sensitivity": Question(
        "Derivative of the asymptotic variance",
        "nonsmooth.sensitivity.gamma2.asymptotic_variance_sensitivity",
        {"derivative": ({"g": 2, "time": 1}, "derivative of gamma^2 by the parameter")},
        {"parameter": PLAIN, "tol": PLAIN},
        required=("parameter",),
        sampled=False,
    ),
    "crossing_sensitivity": Question(
        "Derivative of the probability of crossing",
        "nonsmooth.sensitivity.crossing.crossing_sensitivity",
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
        "nonsmooth.crossing.state.crossing.state_crossing_probability",
        {
            "probability": (PLAIN, "probability that the variable has left the interval"),
            "lower": (PLAIN, "the probability is above"),
            "upper": (PLAIN, "the probability is below"),
            "horizon": (TIME, "time"),
        }
        | _LEVELS,
        _STATE | _COUNTED,
        required=("variable", "threshold", "horizons"),
    ),
    "state_reliability_index": Question(
        "Reliability index of the state",
        "nonsmooth.crossing.state.crossing.state_crossing_probability",
        _INDEX | _LEVELS,
        _STATE | _COUNTED,
        required=("variable", "threshold", "horizons"),
        then="nonsmooth.reliability.index.reliability_index",
    ),
}
