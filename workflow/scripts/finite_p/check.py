"""Check that the Monte Carlo bands of figure 2b contain the exact curves as often as stated."""

import numpy as np
from scipy import stats
from scipy.special import ndtri

from nonsmooth.crossing.proportions import proportion
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rendering.tables import sorted_by

OUTSIDE = 1e-6  # probability that a simultaneous band misses its curve by chance
RARELY = 1e-3  # probability that the 95 % bands contain the curves too rarely by chance
REPLICATES = 10_000  # simulated ensembles that tell how rarely that is


def containment(monte_carlo, exact, seed):
    """Compare the bands with exact probabilities in two ways.

    Simultaneous bands must contain the curves at every p and T.

    Pointwise 95 % bands contain an exact probability in 95 % of all ensembles. But all T share
    their paths, so that the share of p and T at which such bands contain the curves varies widely
    from ensemble to ensemble. How small it may be by chance is found from many ensembles of the
    same size, drawn from the exact curves.

    Both allow for the bias of the time step, which was measured by halving the step.

    Parameters
    ----------
    monte_carlo, exact : list of xarray.Dataset
        One per p; the same number of paths for all.
    seed : int

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    CheckError
        If a simultaneous band misses its curve, or the 95 % bands contain them too rarely.
    """
    monte_carlo, exact = sorted_by("p", monte_carlo), sorted_by("p", exact)
    p = np.array([float(curve["p"]) for curve in exact])
    points = sum(curve.sizes["horizon"] for curve in exact)
    z = -ndtri(OUTSIDE / 2 / points)
    paths = int(monte_carlo[0]["paths"])
    contained, distance, standard_errors, replicates = [], [], [], []
    for run, curve in zip(monte_carlo, exact, strict=True):
        run = run.sel(horizon=curve["horizon"], method="nearest", tolerance=1e-9)
        horizon, truth = curve["horizon"].values, curve["probability"].values
        probability = run["probability"].values
        # a relative shift s of the first-passage times changes W by -s dW/dlog T
        slope = horizon * np.gradient(truth, horizon) / float(run["slope"])
        bias = float(run["bias"]) * slope
        _, lower, upper = proportion(np.round(probability * paths), paths, 1 - OUTSIDE / points)
        allowance = np.abs(bias) + z * float(run["bias_error"]) * np.abs(slope)
        missed = (truth < lower - allowance) | (truth > upper + allowance)
        if np.any(missed):
            raise CheckError(
                f"figure 2b: the exact curve at p = {p[len(contained)]:g} is outside the "
                f"simultaneous band of Monte Carlo from T = {horizon[missed][0]:g} on; "
                "look for a mistake in either"
            )
        contained.append(
            float(np.mean((run["lower"].values <= truth) & (truth <= run["upper"].values)))
        )
        distance.append(np.abs(probability - truth).max())
        standard_errors.append(np.max(np.abs(probability - truth) / run["probability_error"]))
        replicates.append(_shares(truth, bias, paths, [seed, len(replicates)]))
    share, shares = np.mean(contained), np.mean(replicates, axis=0)
    least = np.quantile(shares, RARELY)
    if share < least:
        raise CheckError(
            f"figure 2b: the 95 % bands contain the exact curves at {share:.1%} of all p and "
            f"T, chance allows {least:.1%}; look for a mistake in the bands or a biased time step"
        )
    return artifact.dataset(
        "Exact crossing probabilities and the bands of Monte Carlo",
        "for each p over all T; the bands of the share are pointwise, of 95 %",
        {"p": ("p", p, "scale p")},
        {
            "contained": ("p", contained, "share of T at which the band contains the curve"),
            "distance": ("p", distance, "largest difference"),
            "standard_errors": ("p", standard_errors, "largest difference in standard errors"),
            "share": ((), share, "share of all p and T"),
            **_moments(shares),
            "least": ((), least, "smallest share that is allowed"),
            "least_half_interval": ((), _half_interval(shares), "half its 95 % interval"),
            "rarely": ((), RARELY, "probability of a smaller share by chance"),
            "outside": ((), OUTSIDE, "probability that a simultaneous band misses by chance"),
        },
    )


def _shares(truth, bias, paths, seed):
    """Draw ensembles from a curve with a bias; find the share of T at which bands contain it."""
    _, lowest, highest = proportion(np.arange(paths + 1), paths)
    sampled = np.maximum.accumulate(np.clip(truth + bias, 0.0, 1.0))
    cells = np.diff(sampled, prepend=0.0, append=1.0)
    random = np.random.default_rng(seed)
    counts = random.multinomial(paths, cells, size=REPLICATES)[:, :-1].cumsum(axis=1)
    inside = (lowest[counts] <= truth) & (truth <= highest[counts])
    return inside.mean(axis=1)


def _moments(shares):
    """Mean and standard deviation of simulated shares, and the standard errors of both."""
    mean, spread, many = shares.mean(), shares.std(), len(shares)
    squares = (shares - mean) ** 2
    return {
        "expected": ((), mean, "its expectation, with the bias of the time step"),
        "expected_standard_error": ((), spread / np.sqrt(many), "of the expectation"),
        "spread": ((), spread, "its standard deviation"),
        "spread_standard_error": (
            (),
            squares.std() / (2 * spread * np.sqrt(many)),
            "of the standard deviation",
        ),
    }


def _half_interval(shares):
    """Half a 95 % interval, of order statistics, of the quantile that is rarely undercut."""
    interval = stats.quantile_test(shares, p=RARELY).confidence_interval()
    return (interval.high - interval.low) / 2


if __name__ == "__main__":
    produce(containment, snakemake)
