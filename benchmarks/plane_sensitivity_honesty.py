"""Whether derivatives of crossings of two variables are as close as they state.

`python -m benchmarks.plane_sensitivity_honesty` draws the random scenes of
`plane_crossing_honesty`, and a parameter each. The derivative by the differentiated equations to
1e-2 is compared with one to a fifth of the error that it states. It prints a line for each scene
and a table; `--first` is the first seed and `--scenes` how many.
"""

import sys

import numpy as np

from benchmarks.plane_crossing_honesty import draw
from benchmarks.sensitivity_honesty import tell, timed
from nonsmooth.sensitivity import plane
from nonsmooth.sensitivity.questions import Question

TOLERANCE, FINER = 1e-2, 5.0  # the latter is the stated error over the finer tolerance
PARAMETERS = "threshold", "p", "damping", "sigma", "n"


def compare(seed):
    """Yield what is stated and how far off it is."""
    rng = np.random.default_rng(seed)
    scene, interval, times = draw(rng)
    parameter = str(rng.choice([name for name in PARAMETERS if plane.applies(scene, name)]))
    question = Question(scene, *interval, times, 1.0)
    value, error, seconds = timed(plane, question, parameter, TOLERANCE)
    finer = min(TOLERANCE, error.max()) / FINER
    exact, uncertain, seconds_of_finer = timed(plane, question, parameter, finer)
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


if __name__ == "__main__":
    tell(sys.argv[1:], compare, "parameter")
