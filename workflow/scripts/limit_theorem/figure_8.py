"""Figure 8: distances of every scene to the limits of the functional central limit theorem."""

import numpy as np

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.panels import scene_panels
from reproduction.rendering.plots import BLUE, ORANGE, draw

# the factor of p moves the points apart, so that their error bars do not cover each other
LOOKS = {
    "final": (BLUE, "o", "-", 0.92, r"$\Xi_p(1)/\gamma$ to the normal law"),
    "maximum": (ORANGE, "s", "--", 1.08, r"$\max\,|\Xi_p|/\gamma$ to that of $|W|$"),
}


def distances(check, scenes):
    """Draw one panel per scene, models in rows and noises in columns.

    Parameters
    ----------
    check : xarray.Dataset
        Distances with their errors over (scene, p).
    scenes : dict
        Name -> the scene's parameters, of these scenes and of others.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes, panel_of = scene_panels(1, "$p$", "distance", sharex=True)
    p, floor = check["p"].values, float(check["floor"])
    lowest = floor / 5
    for name in check["scene"].values:
        scene, run = Scene(**scenes[name]["scene"]), check.sel(scene=name)
        panel = panel_of(scene)
        for quantity, (color, marker, dashes, factor, text) in LOOKS.items():
            distance, error = run[quantity].values, run[f"{quantity}_error"].values
            panel.errorbar(
                factor * p,
                distance,
                # to the lower edge where nothing is known below
                [distance - np.maximum(distance - error, lowest / 2), error],
                color=color,
                marker=marker,
                markersize=3.5,
                linestyle=dashes,
                elinewidth=0.7,
                capsize=1.5,
                label=text,
            )
        panel.axhspan(lowest / 2, floor, color="0.9", linewidth=0, zorder=0, label="sampling error")
        last = float(run["maximum"][-1])
        panel.plot(
            p,
            last * np.sqrt(p[-1] / p),
            color="0.5",
            linewidth=0.6,
            zorder=1,
            label=r"$\propto p^{-1/2}$",
        )
    legend = panel.get_legend_handles_labels()
    axes[0, 0].set(xscale="log", yscale="log", ylim=(lowest, 1.5))
    figure.legend(*legend, loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    draw(distances, snakemake)
