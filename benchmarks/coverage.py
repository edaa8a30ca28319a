"""How often the 95 % intervals of many small runs contain the truth.

`python -m benchmarks.coverage` prints one line per quantity for 1000 independent runs each.
Expected are 930 to 970; the number itself has a standard deviation of 7.
"""

import numpy as np
import pandas as pd
from scipy import stats

import nonsmooth as ns
from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.crossing.proportions import proportion
from nonsmooth.paths.ensembles import gram, integrals_at
from nonsmooth.paths.moments import moments
from nonsmooth.paths.sampling import Sampling
from nonsmooth.statistics.sampled_gamma2 import slopes

FRICTION = ns.Scene("friction", n=100)
# gamma^2 of the whole restoring force is the forcing's spectral density at 0, with or without yield
BALANCE = ns.Scene("elasto_plastic", n=np.inf, potential="x**2/2", observable="x + y")
TIMES = (10.0, 30.0, 60.0)
RARE, RARE_HORIZON, RARE_STEP = 1.24, 1.0, 0.02  # a threshold that one path in 10,000 crosses


def within(value, error, truth):
    """Tell whether the normal 95 % interval contains the truth."""
    return bool(abs(value - truth) <= stats.norm.isf(0.025) * error)


def of_moments(run, exact, control, paths=512):
    """Test mean and variance of D(5)."""
    found = moments(gram(FRICTION, [5.0], Sampling(0.02, paths, (run, "moments")), control))
    return {name: within(found[name][0], found[f"{name}_error"][0], exact[name]) for name in exact}


def of_growth(run, scene, truth, step, control, paths=512):
    """Test gamma^2."""
    sample = integrals_at(scene, TIMES, Sampling(step, paths, (run, "growth")), control)
    found = slopes(sample, TIMES)
    return within(found.gamma2, found.gamma2_error, truth)


def of_crossing(run, threshold, horizon, truth, paths):
    """Test a crossing probability by the interval for proportions."""
    crossed = first_passage_counts(
        FRICTION, threshold, [horizon], 1.0, Sampling(RARE_STEP, paths, (run, "crossing"))
    )
    _, lower, upper = proportion(crossed[0], paths)
    return bool(lower <= truth <= upper)


# Limits that account for the bias of the step: scene, threshold, p, horizon, step, paths. Steps are
# coarse: the bias is up to four standard errors.
COARSE = {
    "b = 0.6, p = 1, step 0.1": (FRICTION, 0.6, 1.0, 2.0, 0.1, 2_000),
    "b = 0.6, p = 4, step 0.5": (FRICTION, 0.6, 4.0, 2.0, 0.5, 2_000),
    "b = 0.6, p = 4, step 0.5, more paths": (FRICTION, 0.6, 4.0, 2.0, 0.5, 20_000),
    "b = 0.3, p = 10, step 0.4": (FRICTION, 0.3, 10.0, 1.0, 0.4, 4_000),
    "b = 0.3, p = 10, step 0.4, more paths": (FRICTION, 0.3, 10.0, 1.0, 0.4, 20_000),
    "n = 2, b = 0.5, p = 4, step 0.4": (FRICTION.with_n(2.0), 0.5, 4.0, 1.0, 0.4, 4_000),
    "n = inf, b = 0.6, p = 1, step 0.4": (FRICTION.with_n(np.inf), 0.6, 1.0, 2.0, 0.4, 4_000),
    "b = 1, p = 1, step 0.2": (FRICTION, 1.0, 1.0, 2.0, 0.2, 4_000),
}


def of_limits(scene, threshold, p, horizon, step, paths, runs, first=1):
    """Count the runs whose limits, with the bias of the step in them, contain the truth.

    Parameters
    ----------
    scene, threshold, p, horizon, step, paths
        As for `crossing_probability`.
    runs, first : int
        Number of runs, and the first seed.

    Returns
    -------
    dict
        `covered`, a proportion; `bias`, the mean one over the mean standard error; `truth`.
    """
    problem = scene, threshold, [horizon], p
    truth = float(ns.crossing_probability(*problem, method="deterministic").probability[0])
    hits, bias = [], []
    for seed in range(first, first + runs):
        run = ns.crossing_probability(*problem, step=step, paths=paths, seed=seed, threads=1)
        hits.append(bool(run.lower[0] <= truth <= run.upper[0]))
        bias.append(float(run.step_bias[0] / run.standard_error[0]))
    return {"covered": np.mean(hits), "bias": np.mean(bias), "truth": truth}


def rare_probability(paths):
    """Probability of the rare crossing with the runs' own step, from independent paths."""
    crossed = first_passage_counts(
        FRICTION, RARE, [RARE_HORIZON], 1.0, Sampling(RARE_STEP, paths, (0, "truth"))
    )
    return crossed[0] / paths


def coverage(runs, truth_paths=100_000_000):
    """Count the intervals that contain the truth.

    Parameters
    ----------
    runs : int
        Independent runs per quantity.
    truth_paths : int
        Paths from which the rare probability is known.

    Returns
    -------
    pandas.DataFrame
        Quantity and proportion covered.
    """
    exact = {"mean": 0.0, "variance": float(ns.variance(FRICTION, [5.0])["v"][0])}
    gamma2 = ns.asymptotic_variance(FRICTION).value
    rare = rare_probability(truth_paths)
    hits = {}
    for run in range(1, runs + 1):
        for control, name in ((False, ""), (True, ", control variate")):
            for quantity, hit in of_moments(run, exact, control).items():
                hits.setdefault(quantity + name, []).append(hit)
            hits.setdefault("gamma^2" + name, []).append(
                of_growth(run, FRICTION, gamma2, 0.01, control)
            )
        hits.setdefault("gamma^2, elasto-plastic, n = inf", []).append(
            of_growth(run, BALANCE, 1.0, 0.02, False)
        )
        # the exact value is known to seven digits by a Laplace transform of the crossing problem
        hits.setdefault("W = 0.16", []).append(of_crossing(run, 0.6, 2.0, 0.1606775, 1_000))
        hits.setdefault(f"W = {rare:.2e}", []).append(
            of_crossing(run, RARE, RARE_HORIZON, rare, 100_000)
        )
    return pd.DataFrame(
        {"quantity": list(hits), "covered": [np.mean(hit) for hit in hits.values()]}
    )


if __name__ == "__main__":
    limits = {name: of_limits(*case, runs=1000) for name, case in COARSE.items()}
    print(pd.DataFrame(limits).T.to_string(), end="\n\n")
    print(coverage(1000).to_string(index=False))
