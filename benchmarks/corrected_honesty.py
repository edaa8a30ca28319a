"""Whether the corrected formulas of two variables are as close as they state.

`python -m benchmarks.corrected_honesty` draws random scenes, as `plane_crossing_honesty` does, and
for each of them intervals at several p. Orders 1, 2 and 3 are compared with the deterministic
solution. It prints one line per order; `--first` is the first seed and `--scenes` how many.
"""

import sys
import time

import numpy as np

import nonsmooth as ns
from benchmarks.plane_crossing_honesty import draw
from benchmarks.seeds import compared
from nonsmooth.crossing.corrected_formula import corrected_crossing
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import NonsmoothError

SCALES = (1, 10, 100, 1000)
TOLERANCE = 3e-4  # of the deterministic solution


def compare(seed):
    """Yield for each order and p the largest true error and what is stated there."""
    rng = np.random.default_rng(seed)
    scene, _, _ = draw(rng)
    spread = np.sqrt(ns.asymptotic_variance(scene, tol=1e-2).value)
    times = np.array([0.2, 0.5, 1.0, 2.0, 4.0])
    for p in SCALES:
        b = spread * 10 ** rng.uniform(-0.3, 0.4)
        interval = [(-b, b), (-b, b * rng.uniform(0.5, 2)), (-np.inf, b)][rng.integers(3)]
        levels = np.sqrt(p) * np.array([interval])
        try:
            exact = deterministic_crossing(scene, levels, p * times, TOLERANCE)
        except NonsmoothError as refused:
            exact = getattr(refused, "result", None)
        if exact is None:
            continue
        exact, uncertain = exact["probability"][0], exact["probability_error"][0]
        for order in (1, 2, 3):
            began = time.process_time()
            found, stated = corrected_crossing(scene, interval, times, float(p), order)
            seconds = time.process_time() - began
            true = np.abs(found - exact)
            worst = int(np.argmax(true / (stated + uncertain)))
            yield {
                "order": order,
                "p": p,
                "true": true[worst],
                "stated": stated[worst],
                "ratio": true[worst] / (stated[worst] + uncertain[worst]),
                "largest": true.max(),
                "seconds": seconds,
            }


def main(arguments):
    """Compare and print the table."""
    rows = compared(arguments, "stated against true errors of the formulas", compare)
    table = rows.groupby(["order", "p"]).agg(
        intervals=("ratio", "size"),
        wrong=("ratio", lambda ratio: int(np.sum(ratio > 1))),
        median_ratio=("ratio", "median"),
        largest_ratio=("ratio", "max"),
        median_error=("largest", "median"),
        largest_error=("largest", "max"),
    )
    print(table.to_string(float_format="{:.2g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
