"""Figure 12: distances to the non-smooth limit against n, with their fits."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullFormatter

from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.noises import NOISES
from nonsmooth.scenes.scene import Scene
from reproduction.rendering.plots import BLUE, ORANGE, TEXT_WIDTH, draw

LOOKS = {
    "pathwise": (BLUE, "o", "-", r"paths, $E \sup |\cdot|$"),
    "weak": (ORANGE, "s", "--", "law, variances"),
}


def distances(rates, scenes):
    """Draw one panel per model, and per kind of noise.

    Parameters
    ----------
    rates : xarray.Dataset
        Distances over (scene, point).
    scenes : dict
        Name -> entry of the configuration.

    Returns
    -------
    matplotlib.figure.Figure
    """
    of = {name: Scene(**entry["scene"], n=1.0) for name, entry in scenes.items()}
    columns = [model for model in MODELS if any(s.model == model for s in of.values())]
    rows = [kind for kind in NOISES if any(s.noise.kind == kind for s in of.values())]
    figure, axes = plt.subplots(
        len(rows), len(columns), figsize=(TEXT_WIDTH, 2.1 * len(rows)), squeeze=False
    )
    for name, scene in of.items():
        panel = axes[rows.index(scene.noise.kind), columns.index(scene.model)]
        run = rates.sel(scene=name)
        n = run["n"].values
        for kind, (color, marker, dashes, text) in LOOKS.items():
            value, error = np.abs(run[kind].values), run[f"{kind}_error"].values
            kept = value > 2 * error
            exponent, half = (float(run[f"{kind}_exponent{s}"]) for s in ("", "_error"))
            panel.errorbar(
                n[kept],
                value[kept],
                2 * error[kept],
                color=color,
                marker=marker,
                markersize=3.5,
                linestyle="none",
                capsize=1.5,
            )
            centre = np.exp(np.mean(np.log(value[kept] / n[kept] ** exponent)))
            label = rf"{text}: ${exponent:.2f} \pm {half:.2f}$"
            panel.plot(n, centre * n**exponent, color=color, linestyle=dashes, label=label)
        panel.set(xscale="log", yscale="log", xlabel="$n$")
        panel.xaxis.set_minor_formatter(NullFormatter())
        low, high = panel.get_ylim()
        panel.set_ylim(low, high * (high / low) ** 0.45)
        panel.legend(loc="upper right", fontsize=6.5, handlelength=1.2, borderaxespad=0.1)
        title = f"{MODELS[scene.model].title.lower()}, {scene.noise.kind}"
        panel.set_title(title, fontsize=8, loc="left")
    return figure


if __name__ == "__main__":
    draw(distances, snakemake)
