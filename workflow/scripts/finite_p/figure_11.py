"""Figure 11: time against error for crossing probabilities."""

import matplotlib.pyplot as plt

from nonsmooth.plotting import BLACK, BLUE, GREEN, ORANGE, SKY, TEXT_WIDTH, draw

LOOKS = {
    "Monte Carlo": (ORANGE, "o", "-"),
    "spectral": (BLUE, "s", "-"),
    "plain": (SKY, "D", "none"),
    "order 1": (GREEN, "v", "none"),
    "order 2": (BLACK, "^", "none"),
}


def time_against_error(work):
    """Draw one panel for each p.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(
        1, work.sizes["p"], figsize=(TEXT_WIDTH, 2.6), sharex=True, sharey=True, squeeze=False
    )
    for axis, p in zip(axes[0], work["p"].values, strict=True):
        here = work.sel(p=p)
        for method, (color, marker, dashes) in LOOKS.items():
            runs = here.isel(run=(here["method"] == method).values)
            axis.plot(
                runs["distance"],
                runs["seconds"],
                color=color,
                marker=marker,
                markersize=4,
                linestyle=dashes,
                label=method,
            )
        axis.axvline(float(here["floor"]), color="0.5", linestyle=":", linewidth=0.8)
        axis.set(xlabel="error", title=f"$p = {p:g}$", xscale="log", yscale="log")
    axes[0, 0].set_ylabel("seconds on one core")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


if __name__ == "__main__":
    draw(time_against_error, snakemake)
