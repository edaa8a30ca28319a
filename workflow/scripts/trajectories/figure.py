"""Figures 3, 4, 5: trajectories of one model."""

import matplotlib.pyplot as plt

from reproduction.rendering.plots import BLACK, BLUE, GREEN, ORANGE, SKY, TEXT_WIDTH, draw

# the paper's axes
LIMITS = {
    "elasto_plastic": {"Y": (-6, 4), "X": (-4, 2), "phase": ((-3.5, 1.5), (-6, 2))},
    "obstacle": {"Y": (-2, 1.75), "X": (-4, 1.5), "phase": ((-4, 1.5), (-2, 1.25))},
    "friction": {"Y": (-1.75, 1.75), "X": (-8, 1), "phase": ((-7, 2), (-1.75, 1.75))},
}


def figure(trajectories, model):
    """Draw Y(t), X(t) and the phase portrait for every penalization.

    The panels have the paper's axes, wider where the paths need it.

    Parameters
    ----------
    trajectories : xarray.Dataset
        y and x over (n, t).
    model : str

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(
        1, 3, figsize=(TEXT_WIDTH, 2.25), width_ratios=[1.25, 1.25, 1.0], layout="constrained"
    )
    time = trajectories["t"].values
    for n, (color, dashes, width) in _styles(trajectories["n"].values).items():
        run = trajectories.sel(n=n)
        text = r"$n = \infty$" if n == float("inf") else f"$n = {n:g}$"
        options = {"color": color, "linestyle": dashes, "linewidth": width}
        axes[0].plot(time, run["y"], label=text, **options)
        axes[1].plot(time, run["x"], **options)
        axes[2].plot(run["x"], run["y"], **options)
    limits, y, x = LIMITS[model], trajectories["y"].values, trajectories["x"].values
    for axis, name, values in zip(axes, "YX", (y, x), strict=False):
        axis.set(xlabel="time $t$", ylabel=f"${name}$", xlim=(time[0], time[-1]))
        axis.set_ylim(_containing(limits[name], values))
    axes[2].set(xlabel="$X$", ylabel="$Y$")
    axes[2].set_xlim(_containing(limits["phase"][0], x))
    axes[2].set_ylim(_containing(limits["phase"][1], y))
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def _styles(penalizations):
    """Color, dashes and width of each n; the largest finite one and the limit stand out."""
    finite = [n for n in penalizations if n < float("inf")]
    styles = {n: ((SKY, GREEN, BLACK)[k % 3], "--", 0.9) for k, n in enumerate(finite)}
    if finite:
        styles[finite[-1]] = (BLUE, "-", 1.6)
    styles[float("inf")] = (ORANGE, "-", 0.5)
    return {n: styles[n] for n in penalizations}


def _containing(limits, values):
    """Widen axis limits to contain the values."""
    margin = 0.03 * (values.max() - values.min())
    return min(limits[0], values.min() - margin), max(limits[1], values.max() + margin)


if __name__ == "__main__":
    draw(figure, snakemake)
