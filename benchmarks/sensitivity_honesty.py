"""Whether solved derivatives of crossing probabilities are as close as they state.

`python -m benchmarks.sensitivity_honesty` draws random scenes with one state variable, intervals,
p and parameters. The derivative by the adjoint equation to 1e-4 and 1e-6 is compared with that to
1e-8, and with differences of probabilities. It prints one line per tolerance; `--first` is the
first seed and `--scenes` how many.
"""

import sys
import time

import numpy as np

import nonsmooth as ns
from benchmarks.seeds import compared
from nonsmooth.errors import ToleranceError
from nonsmooth.sensitivity import differences, first_passage
from nonsmooth.sensitivity.questions import Question

OBSERVABLES = (
    "y",
    "y**3",
    "tanh(y)",
    "y + 0.3*y**2 - 0.1",
    "max(abs(y) - 0.3, 0)*sign(y)",
    "friction_force",
)
HORIZONS = np.geomspace(0.05, 20, 12)
REFERENCE, OF_DIFFERENCES = 1e-8, 1e-5


def draw(seed):
    """Draw a question and a parameter."""
    rng = np.random.default_rng(seed)
    n = float(rng.choice([1, 3, 30, 1000, np.inf]))
    observable = str(rng.choice(OBSERVABLES))
    if observable == "friction_force" and np.isinf(n):
        observable = "y"
    scene = ns.Scene(
        "friction",
        ns.White(rng.uniform(0.5, 2)),
        n=n,
        damping=rng.uniform(0.1, 3),
        observable=observable,
        start={"y": float(rng.choice([0, 0, 0.5, -1]))},
    )
    b = rng.uniform(0.2, 1.5)
    upper = b * float(rng.choice([1, 1, 1.7, np.inf]))
    parameters = ["threshold", "p", "damping", "sigma"] + ["n"] * int(np.isfinite(n))
    return Question(scene, -b, upper, HORIZONS, 10 ** rng.uniform(-1, 3)), rng.choice(parameters)


def timed(method, question, parameter, tol):
    """Return value, error and seconds; a refusal has the best."""
    began = time.process_time()
    try:
        value, error = method.logarithmic_derivative(question, parameter, tol)
    except ToleranceError as refused:
        if refused.result is None:
            raise
        value, error = refused.result
    return value, error, time.process_time() - began


def compare(seed):
    """Yield for both tolerances and for differences what is stated and how far off it is."""
    question, parameter = draw(seed)
    exact, uncertain, _ = timed(first_passage, question, parameter, REFERENCE)
    asked = [(first_passage, 1e-4), (first_passage, 1e-6), (differences, OF_DIFFERENCES)]
    for method, tol in asked:
        value, error, seconds = timed(method, question, parameter, tol)
        yield {
            "method": method.__name__.rpartition(".")[2],
            "tol": tol,
            "stated": error.max(),
            "ratio": np.max(np.abs(value - exact) / (error + uncertain)),
            "missed": int(error.max() > tol),
            "seconds": seconds,
        }


def tell(arguments, compare, by):
    """Compare scenes of random seeds, and print a table grouped by columns of the rows."""
    rows = compared(arguments, "stated against true errors of derivatives", compare)
    table = rows.groupby(by, as_index=False).agg(
        scenes=("ratio", "size"),
        wrong=("ratio", lambda ratio: int(np.sum(ratio > 1))),
        largest_ratio=("ratio", "max"),
        missed=("missed", "sum"),
        median_seconds=("seconds", "median"),
        most_seconds=("seconds", "max"),
    )
    print(table.to_string(index=False, float_format="{:.2g}".format))


if __name__ == "__main__":
    tell(sys.argv[1:], compare, ["method", "tol"])
