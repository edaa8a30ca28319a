"""Crossing probabilities of a penalized scene at growing n, their limit and the exponent of n."""

import numpy as np

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.scenes.scene import Scene
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rates import power_of_n


def approach(scene, threshold, p, horizon, tol, first, ratio, points):
    """Solve at each n and extrapolate; compare with the limit where a solver has it.

    Parameters
    ----------
    scene : dict
        Parameters without n.
    threshold, p, horizon, tol : float
    first, ratio : float
        The smallest n, and each n over the one before.
    points : int
        Number of n.

    Returns
    -------
    xarray.Dataset
        Over `n`; with `solved` for one variable.

    Raises
    ------
    CheckError
        If the extrapolated limit is farther from the solved one than both errors allow.
    """
    n = first * ratio ** np.arange(points, dtype=float)
    of = [Scene(**scene, n=k) for k in n]

    def solved(one):
        found = crossing_probability(
            one, threshold, [horizon], p, method="deterministic", tol=tol
        ).isel(horizon=0)
        return found["probability"].item(), found["probability_error"].item()

    value, error = np.transpose([solved(one) for one in of])
    (exponent, exponent_error), (limit, limit_error) = power_of_n(ratio, value, error)
    variables = {
        "probability": ("n", value, "probability of crossing sqrt(p) b by p T"),
        "probability_error": ("n", error, "difference of two resolutions"),
        "exponent": ((), exponent, "power of n in the distance to the limit"),
        "exponent_error": ((), exponent_error, "bound, from errors and from the next smaller n"),
        "limit": ((), limit, "extrapolated probability at n = infinity"),
        "limit_error": ((), limit_error, "bound, from errors and from that of the exponent"),
    }
    if of[0].is_line:
        exact, exact_error = solved(of[0].with_n(np.inf))
        if not abs(limit - exact) <= limit_error + exact_error:
            raise CheckError(
                f"rates: the limit n -> infinity of W is {limit:.10g} by extrapolation and "
                f"{exact:.10g} if solved for, which their errors do not allow; look for a mistake"
            )
        variables |= {
            "solved": ((), exact, "solved probability at n = infinity"),
            "solved_error": ((), exact_error, "difference of two resolutions"),
        }
    return artifact.dataset(
        "Crossing probabilities as the penalization grows",
        f"{of[0]} and larger n, b = {threshold}, p = {p}, T = {horizon}",
        {"n": ("n", n, "penalization")},
        variables,
    )


if __name__ == "__main__":
    produce(approach, snakemake)
