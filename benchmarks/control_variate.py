"""What the control variate gains: standard error times the square root of the time.

`python -m benchmarks.control_variate` prints one line per quantity.
"""

import time

import numpy as np
import pandas as pd

import nonsmooth as ns
from nonsmooth.paths.ensembles import gram, integrals_at
from nonsmooth.paths.moments import moments
from nonsmooth.paths.sampling import Sampling
from nonsmooth.statistics.sampled_gamma2 import slopes

SCENE, STEP, PATHS, ROUNDS = ns.Scene("friction", n=100), 0.01, 64_000, 5
TAU = [0.1, 1.0, 10.0, 100.0]
TIMES = (10.0, 60.0, 110.0)


def measured(run):
    """Median seconds of a run and its result."""
    seconds = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        result = run()
        seconds.append(time.perf_counter() - began)
    return np.median(seconds), result


def main():
    """Measure with and without and print the table."""
    cost = {}
    for control in (False, True):
        for tau in TAU:
            seconds, found = measured(
                lambda tau=tau, control=control: moments(
                    gram(SCENE, [tau], Sampling(STEP, PATHS, 1), control)
                )
            )
            for name in ("mean", "variance"):
                error = found[f"{name}_error"][0]
                cost.setdefault(f"{name} at tau = {tau:g}", []).append(error * np.sqrt(seconds))
        seconds, found = measured(
            lambda control=control: slopes(
                integrals_at(SCENE, TIMES, Sampling(STEP, PATHS // 4, 1), control), TIMES
            )
        )
        cost.setdefault("gamma^2", []).append(found.gamma2_error * np.sqrt(seconds))
    table = pd.DataFrame(cost, index=["plain", "control variate"]).T
    table["times less time for the same error"] = (table["plain"] / table["control variate"]) ** 2
    print(table.to_string(float_format="{:.3g}".format))


if __name__ == "__main__":
    main()
