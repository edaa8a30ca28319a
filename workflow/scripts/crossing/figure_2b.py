"""Figure 2b: threshold crossing probabilities for growing p, exact and sampled."""

import matplotlib.pyplot as plt
import numpy as np

from nonsmooth.plotting import LOOKS, ORANGE, TEXT_WIDTH, draw
from nonsmooth.tables import sorted_by


def crossing(monte_carlo, exact, asymptotic, check, contained):
    """Draw W(sqrt(p) b, p T) and W_star(b / gamma, T) above their differences.

    Lines are exact, the 95 % bands those of Monte Carlo. The artifacts of the checks are not drawn:
    without them there is no figure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(0.75 * TEXT_WIDTH, 4.4), sharex=True, height_ratios=[2, 1]
    )
    limit = _from_zero(asymptotic["probability"])
    runs = zip(sorted_by("p", monte_carlo), sorted_by("p", exact), strict=True)
    for k, (run, curve) in enumerate(runs):
        color, dashes = LOOKS[k % len(LOOKS)]
        horizon = _from_zero(run["horizon"])
        lower, upper = _from_zero(run["lower"]), _from_zero(run["upper"])
        solved = curve["horizon"].values  # the last of the horizons
        for axis, shift in ((top, np.zeros_like(limit)), (bottom, limit)):
            axis.fill_between(
                horizon, lower - shift, upper - shift, color=color, alpha=0.3, linewidth=0
            )
            axis.plot(
                solved,
                curve["probability"] - shift[-len(solved) :],
                color=color,
                linestyle=dashes,
                label=f"$p = {float(run['p']):g}$",
            )
    top.plot(horizon, limit, color=ORANGE, label=r"$W_\star(b/\gamma, T)$", zorder=1)
    bottom.axhline(0, color=ORANGE, zorder=1)
    top.set(ylabel=r"$W(\sqrt{p}\,b,\, pT)$", ylim=(0, 1))
    top.legend(loc="lower right")
    bottom.set(xlabel="$T$", ylabel=r"$W - W_\star$", xlim=(0, horizon[-1]))
    return figure


def _from_zero(values):
    return np.concatenate([[0.0], values])


if __name__ == "__main__":
    draw(crossing, snakemake)
