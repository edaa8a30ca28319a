"""Figure 2b: threshold crossing probabilities for growing p and their limit."""

import matplotlib.pyplot as plt
import numpy as np

from nonsmooth.plotting import BLACK, BLUE, GREEN, ORANGE, SKY, TEXT_WIDTH, draw
from nonsmooth.tables import sorted_by


def crossing(monte_carlo, asymptotic, check):
    """Draw W(sqrt(p) b, p T) with 95 % bands, and W_star(b / gamma, T).

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axis = plt.subplots(figsize=(0.75 * TEXT_WIDTH, 3.2))
    looks = [(GREEN, (0, (1, 2))), (SKY, (0, (1, 1))), (BLUE, "-."), (BLACK, "--")]
    for k, run in enumerate(sorted_by("p", monte_carlo)):
        color, dashes = looks[k % len(looks)]
        horizon = np.concatenate([[0.0], run["horizon"].values])
        curve = {
            name: np.concatenate([[0.0], run[name].values])
            for name in ("probability", "lower", "upper")
        }
        axis.fill_between(
            horizon, curve["lower"], curve["upper"], color=color, alpha=0.25, linewidth=0
        )
        axis.plot(
            horizon,
            curve["probability"],
            color=color,
            linestyle=dashes,
            label=f"$p = {float(run['p']):g}$",
        )
    horizon = np.concatenate([[0.0], asymptotic["horizon"].values])
    limit = np.concatenate([[0.0], asymptotic["probability"].values])
    axis.plot(horizon, limit, color=ORANGE, label=r"$W_\star(b/\gamma, T)$", zorder=1)
    axis.set(xlabel="$T$", ylabel=r"$W(\sqrt{p}\,b,\, pT)$", xlim=(0, horizon[-1]), ylim=(0, 1))
    axis.legend(loc="lower right")
    return figure


if __name__ == "__main__":
    draw(crossing, snakemake)
