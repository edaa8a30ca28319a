"""Figure 2b: threshold crossing probabilities for growing p, exact and sampled."""

import matplotlib.pyplot as plt
import numpy as np

from reproduction.rendering.plots import BLACK, LOOKS, ORANGE, TEXT_WIDTH, draw, from_zero
from reproduction.rendering.tables import sorted_by


def crossing(monte_carlo, exact, asymptotic, check, contained):
    """Draw W(sqrt(p) b, p T) and W_star(b / gamma, T), their differences, and the 95 % bands.

    Lines are exact and bands are by Monte Carlo. The lowest panel has the bands less the exact
    curves. The artifacts of the checks are not drawn, but there is no figure unless they exist.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (top, middle, bottom) = plt.subplots(
        3, 1, figsize=(0.75 * TEXT_WIDTH, 5.2), sharex=True, height_ratios=[2.2, 1, 1]
    )
    limit = from_zero(asymptotic["probability"])
    runs = zip(sorted_by("p", monte_carlo), sorted_by("p", exact), strict=True)
    for k, (run, curve) in enumerate(runs):
        color, dashes = LOOKS[k % len(LOOKS)]
        horizon = from_zero(run["horizon"])
        lower, upper = from_zero(run["lower"]), from_zero(run["upper"])
        solved, probability = curve["horizon"].values, curve["probability"].values
        late = slice(-len(solved), None)  # the exact curves begin later
        for axis, shift in ((top, np.zeros_like(limit)), (middle, limit)):
            axis.fill_between(
                horizon, lower - shift, upper - shift, color=color, alpha=0.3, linewidth=0
            )
            axis.plot(
                solved,
                probability - shift[late],
                color=color,
                linestyle=dashes,
                label=f"$p = {float(run['p']):g}$",
            )
        bounds = lower[late] - probability, upper[late] - probability
        bottom.fill_between(solved, *bounds, color=color, alpha=0.15, linewidth=0)
        for bound in bounds:
            bottom.plot(solved, bound, color=color, linestyle=dashes, linewidth=0.7)
    top.plot(horizon, limit, color=ORANGE, label=r"$W_\star(b/\gamma, T)$", zorder=1)
    middle.axhline(0, color=ORANGE, zorder=1)
    bottom.axhline(0, color=BLACK, linewidth=0.6)
    top.set(ylabel=r"$W(\sqrt{p}\,b,\, pT)$", ylim=(0, 1))
    top.legend(loc="lower right")
    middle.set(ylabel=r"$W - W_\star$")
    bottom.set(xlabel="$T$", ylabel="bands $- W$", xlim=(0, horizon[-1]))
    return figure


if __name__ == "__main__":
    draw(crossing, snakemake)
