"""Single against double precision on the same noise: whether a published digit changes.

`python -m benchmarks.precision` prints the differences, also in units of the standard error.
"""

import numpy as np

import nonsmooth as ns
from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.moments import moments
from nonsmooth.paths.sampling import Sampling

SCENE, PATHS = ns.Scene("friction", n=100), 200_000


def main():
    """Compare figure 2a's variance curve and figure 2b's crossing counts."""
    tau = np.geomspace(0.02, 10, 20)
    single, double = (
        moments(gram(SCENE, tau, Sampling(0.005, PATHS, 1, precision=precision)))
        for precision in ("float32", "float64")
    )
    change = np.abs(single["variance"] - double["variance"])
    print(
        f"v(0, tau): relative change at most {np.max(change / double['variance']):.1e}, "
        f"at most {np.max(change / double['variance_error']):.1e} standard errors"
    )
    horizons = np.linspace(0, 20, 41)[1:]
    for p in (1.0, 10.0, 100.0):
        paths = min(PATHS, int(2e7 / p / 20 * 10))
        counts = [
            np.cumsum(
                first_passage_counts(
                    SCENE, 0.6, horizons, p, Sampling(0.02, paths, 1, precision=precision)
                )
            )
            for precision in ("float32", "float64")
        ]
        moved = np.max(np.abs(counts[0] - counts[1]))
        error = np.sqrt(np.max(counts[1] * (paths - counts[1]) / paths))
        print(
            f"W at p = {p:g}: at most {moved} of {paths} paths, {moved / error:.1e} standard errors"
        )


if __name__ == "__main__":
    main()
