"""Figure 2a: v(0, tau)/tau by three methods."""

import matplotlib.pyplot as plt

from reproduction.rendering.plots import BLACK, BLUE, ORANGE, SKY, TEXT_WIDTH, draw


def three_methods(spectral, finite_difference, monte_carlo, check):
    """Draw the three methods above their deviations from the reference.

    Returns
    -------
    matplotlib.figure.Figure
    """
    tau, v = spectral["tau"].values, spectral["v"].values
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(0.75 * TEXT_WIDTH, 4.0), sharex=True, height_ratios=[2.2, 1]
    )
    band = 1.96 * monte_carlo["v_error"].values
    estimate = monte_carlo["v"].values
    top.fill_between(
        tau, (estimate - band) / tau, (estimate + band) / tau, color=SKY, alpha=0.6, linewidth=0
    )
    paths = int(monte_carlo["paths"])
    top.plot(tau, estimate / tau, "--", color=BLUE, label=f"Monte Carlo, {paths:,} paths")
    top.plot(tau, v / tau, color=ORANGE, linewidth=2.2, label="spectral elements", zorder=1)
    sparse = slice(None, None, 4)
    top.plot(
        tau[sparse],
        (finite_difference["v"].values / tau)[sparse],
        "o",
        color=BLACK,
        markersize=3,
        fillstyle="none",
        label="paper's finite differences",
    )
    gamma2 = float(spectral["gamma2"])
    top.axhline(gamma2, color="0.4", linestyle=":", label=r"$\gamma_n^2$ in closed form")
    top.set(xscale="log", ylim=(0, 0.14 if gamma2 < 0.14 else None), ylabel=r"$v(0,\tau)/\tau$")
    top.legend(loc="upper left")

    bottom.fill_between(
        tau,
        1e4 * (estimate - band - v) / tau,
        1e4 * (estimate + band - v) / tau,
        color=SKY,
        alpha=0.6,
        linewidth=0,
        label="Monte Carlo, 95 % band",
    )
    bottom.plot(tau, 1e4 * (estimate - v) / tau, "--", color=BLUE)
    bottom.plot(
        tau,
        1e4 * (finite_difference["v"].values - v) / tau,
        color=BLACK,
        label="paper's finite differences",
    )
    bottom.axhline(0, color=ORANGE)
    bottom.set(xlabel=r"$\tau$", ylabel="deviation $\\times\\,10^4$", xlim=(tau[0], tau[-1]))
    bottom.legend(loc="upper left")
    return figure


if __name__ == "__main__":
    draw(three_methods, snakemake)
