"""Whether derivatives of crossings of two variables are as close as they state.

`python -m benchmarks.plane_sensitivity_honesty` draws the random scenes of
`plane_crossing_honesty`, and a parameter each. The derivative by the differentiated equations to
1e-2 is compared with one to a fifth of the error that it states. It prints a line for each scene
and a table; `--first` is the first seed and `--scenes` how many.
"""

import sys
import time

import numpy as np

from benchmarks.plane_crossing_honesty import draw
from benchmarks.seeds import compared
from nonsmooth.errors import ToleranceError
from nonsmooth.sensitivity import plane
from nonsmooth.sensitivity.questions import Question

TOLERANCE, FINER = 1e-2, 5.0  # the latter is the stated error over the finer tolerance
PARAMETERS = "threshold", "p", "damping", "sigma", "n"


def timed(question, parameter, tol):
    """Return value, error and seconds; a refusal has the best."""
    began = time.process_time()
    try:
        value, error = plane.logarithmic_derivative(question, parameter, tol)
    except ToleranceError as refused:
        value, error = refused.result
    return value, error, time.process_time() - began


def compare(seed):
    """Yield what is stated and how far off it is."""
    rng = np.random.default_rng(seed)
    scene, interval, times = draw(rng)
    parameter = str(rng.choice([name for name in PARAMETERS if plane.applies(scene, name)]))
    question = Question(scene, *interval, times, 1.0)
    value, error, seconds = timed(question, parameter, TOLERANCE)
    finer = min(TOLERANCE, error.max()) / FINER
    exact, uncertain, seconds_of_finer = timed(question, parameter, finer)
    ratio = np.max(np.abs(value - exact) / (error + uncertain))
    yield {
        "model": scene.model,
        "parameter": parameter,
        "largest": np.max(np.abs(exact)),
        "stated": error.max(),
        "stated_finer": uncertain.max(),
        "ratio": ratio,
        "missed": int(error.max() > TOLERANCE),
        "seconds": seconds,
        "seconds_of_finer": seconds_of_finer,
    }


def main(arguments):
    """Compare and print the table."""
    rows = compared(arguments, "stated against true errors of derivatives", compare)
    table = rows.groupby("parameter", as_index=False).agg(
        scenes=("ratio", "size"),
        wrong=("ratio", lambda ratio: int(np.sum(ratio > 1))),
        largest_ratio=("ratio", "max"),
        missed=("missed", "sum"),
        median_seconds=("seconds", "median"),
        most_seconds=("seconds", "max"),
    )
    print(table.to_string(index=False, float_format="{:.2g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
