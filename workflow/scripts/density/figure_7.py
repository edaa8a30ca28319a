"""Figure 7: invariant densities of every scene, by solvers and by simulation."""

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.panels import scene_panels
from reproduction.rendering.plots import BLUE, ORANGE, draw

LOOKS = {
    "y": (BLUE, "o", "-", "velocity $y$"),
    "x": (ORANGE, "s", "--", "displacement $x$"),
}


def invariant(densities, check, scenes, names):
    """Draw one panel per scene, models in rows and noises in columns.

    Parameters
    ----------
    densities : list of xarray.Dataset
    check : xarray.Dataset
        They agree with the histograms, or it would not exist.
    scenes : dict
        Name -> the scene's parameters, of these scenes and of others.
    names : list of str
        Of the scenes, in the order of the densities.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes, panel_of = scene_panels(1, "$y$, $x$", "density")
    handles = {}
    for name, data in zip(names, densities, strict=True):
        scene = Scene(**scenes[name]["scene"])
        panel = panel_of(scene)
        for variable in (v for v in LOOKS if v in data.coords):
            color, marker, dashes, text = LOOKS[variable]
            z, line = data[variable].values, data[f"density_{variable}"].values
            dots = data[f"histogram_{variable}"].values
            error = data[f"histogram_{variable}_error"].values
            seen, known = dots > 0, line > data[f"density_{variable}_error"].values
            (solved,) = panel.plot(z[known], line[known], color=color, linestyle=dashes)
            sampled = panel.errorbar(
                z[seen],
                dots[seen],
                error[seen],
                color=color,
                marker=marker,
                markersize=2.2,
                markerfacecolor="white",
                markeredgewidth=0.6,
                linestyle="none",
                elinewidth=0.6,
            )
            handles |= {f"{text}, solved": solved, f"{text}, simulated": sampled}
    axes[0, 0].set(yscale="log", ylim=(2e-4, 60))
    figure.legend(handles.values(), handles.keys(), loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    draw(invariant, snakemake)
