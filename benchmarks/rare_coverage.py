"""How often 95 % intervals of importance sampling hold the exact probability.

`python -m benchmarks.rare_coverage [runs] [part ...]`: friction with white noise, p = 10, T = 2, a
single threshold, W = 1e-2, 1e-5 and 1e-8 (parts 0 to 2). All runs together fluctuate by 0.7 % if
there are a thousand of them. Settings are cheap: 4000 paths, and a step whose bias is seen.
"""

import sys

import numpy as np

import nonsmooth as ns
from nonsmooth.errors import ToleranceError

SCENE = ns.Scene("friction")
THRESHOLDS = (1.305, 2.51, 3.58)
CHEAP = {"paths": 4000, "step": 0.1, "tol": 1.0}


def solved(threshold: float) -> float:
    """Return the exact probability."""
    try:
        found = ns.crossing_probability(
            SCENE, (-np.inf, threshold), [2.0], 10.0, method="deterministic", tol=1e-13
        )
    except ToleranceError as refused:
        found = refused.result
    return found.probability.item()


def main() -> None:
    """Print one line for each probability."""
    runs, *parts = map(int, sys.argv[1:] or ["1000"])
    for part in parts or range(len(THRESHOLDS)):
        W, rows, refused = solved(THRESHOLDS[part]), [], 0
        for seed in range(runs):
            try:
                found = ns.crossing_probability(
                    SCENE,
                    (-np.inf, THRESHOLDS[part]),
                    [2.0],
                    10.0,
                    method="importance_sampling",
                    seed=seed,
                    threads=1,
                    **CHEAP,
                )
            except ToleranceError:
                refused += 1
                continue
            names = "probability", "step_bias", "standard_error", "step_bias_error"
            value, bias, *errors = (found[name].item() for name in names)
            distance = (value - bias - W) / np.hypot(*errors)
            rows.append([found.upper.item() < W, found.lower.item() > W, distance])
        below, above, distances = np.transpose(rows)
        print(
            f"W = {W:.3g}: {len(rows)} runs, {refused} refused, "
            f"covered {1 - np.mean(below + above):.3f}, "
            f"too low {below.mean():.3f}, too high {above.mean():.3f}; over the stated error: "
            f"mean {distances.mean():+.3f}, deviation {distances.std():.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
