"""Figure 6: crossing probabilities of every scene for growing p, and their limits."""

from itertools import cycle

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.panels import scene_panels
from reproduction.rendering.plots import LOOKS, ORANGE, draw


def sweep(crossing, limit, check, scenes, p):
    """Draw one panel per scene, models in rows and noises in columns.

    Parameters
    ----------
    crossing, limit, check, scenes, p
        As for table 6.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes, panel_of = scene_panels(1.05, "$T$", r"$W(\sqrt{p}\,b, pT)$", sharex=True)
    for k, (name, parameters) in enumerate(scenes.items()):
        scene = Scene(**parameters["scene"])
        panel = panel_of(scene)
        runs = crossing[k * len(p) : (k + 1) * len(p)]
        for scale, run, (color, dashes) in zip(p, runs, cycle(LOOKS), strict=False):
            horizon = run["horizon"].values
            panel.fill_between(
                horizon, run["lower"], run["upper"], color=color, alpha=0.4, linewidth=0
            )
            panel.plot(
                horizon,
                run["probability"],
                color=color,
                linestyle=dashes,
                label=f"$p = {scale:g}$",
            )
        panel.plot(
            limit["horizon"],
            limit["probability"].sel(scene=name),
            color=ORANGE,
            label=r"$W_\star(b/\gamma, T)$",
            zorder=1,
        )
        panel.set_title(f"$b = {parameters['threshold']:g}$", fontsize=8, loc="right")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    axes[0, 0].set(xlim=(0, float(limit["horizon"][-1])), ylim=(0, None))
    return figure


if __name__ == "__main__":
    draw(sweep, snakemake)
