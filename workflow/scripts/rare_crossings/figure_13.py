"""Figure 13: rare crossings of every scene by importance sampling, and the formulas."""

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.panels import scene_panels
from reproduction.rendering.plots import BLACK, BLUE, GREEN, ORANGE, draw

LEAST = 1e-11  # lower end of the axis


def rare(sampled, formulas, scenes, p, horizon):
    """Draw one panel per scene, models in rows and noises in columns.

    Parameters
    ----------
    sampled : list of xarray.Dataset
        One per scene, in the order of `scenes`.
    formulas : xarray.Dataset
    scenes : dict
        Name -> the scene's parameters and its thresholds.
    p, horizon : float

    Returns
    -------
    matplotlib.figure.Figure
    """
    label = rf"$W(\sqrt{{{p:g}}}\,b, {p * horizon:g})$"
    figure, axes, panel_of = scene_panels(1.05, "$b$", label)
    handles = {}
    for (name, parameters), run in zip(scenes.items(), sampled, strict=True):
        panel, b = panel_of(Scene(**parameters["scene"])), formulas["threshold"].sel(scene=name)
        handles["asymptotic formula"] = panel.plot(
            b, formulas["asymptotic"].sel(scene=name), color=ORANGE
        )[0]
        if name in formulas["solved"]:
            handles["its first correction"] = panel.plot(
                b, formulas["corrected"].sel(solved=name), color=BLUE, linestyle="--"
            )[0]
        if "exact" in run:
            handles["exact"] = panel.plot(
                run["threshold"], run["exact"], color=GREEN, marker="o", ms=6, mfc="none", lw=0
            )[0]
        limits = [run["probability"] - run["lower"], run["upper"] - run["probability"]]
        handles["importance sampling, 95 %"] = panel.errorbar(
            run["threshold"],
            run["probability"],
            limits,
            color=BLACK,
            marker=".",
            ms=3,
            lw=0.8,
            ls="",
        )
    axes[0, 0].set(yscale="log", ylim=(LEAST, 2))
    figure.legend(handles.values(), handles, loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    draw(rare, snakemake)
