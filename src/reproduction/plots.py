"""One style for all figures; the same bytes on every run."""

from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt

from reproduction.files import whole
from reproduction.jobs import inputs, job

TEXT_WIDTH = 6.3  # inches
# Wong's colour-blind-safe palette, ordered so that neighbours also differ in grey
BLACK, BLUE, ORANGE, SKY, GREEN = "#000000", "#0072B2", "#D55E00", "#56B4E9", "#009E73"
# looks of the curves of a sweep over p
LOOKS = [(GREEN, (0, (1, 2))), (SKY, (0, (3, 1, 1, 1, 1, 1))), (BLUE, "-."), (BLACK, "--")]

STYLE = {
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.constrained_layout.use": True,
    "font.family": "STIXGeneral",
    "font.size": 8,
    "grid.color": "0.9",
    "grid.linewidth": 0.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "mathtext.fontset": "stix",
    "pdf.fonttype": 42,
    "savefig.dpi": 200,
}


def draw(plot, task):
    """Run a task whose outputs are one figure as PDF and PNG.

    Parameters
    ----------
    plot : callable
        Takes the task's input artifacts and parameters by name, returns a matplotlib Figure.
    task : object
        See `nonsmooth.jobs`.
    """
    with job(task.log[0]), mpl.rc_context(STYLE):
        figure = plot(**inputs(task), **dict(task.params.items()))
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # the layout is found once, for all files
        for path in map(Path, task.output):
            metadata = {"CreationDate": None} if path.suffix == ".pdf" else {"Software": None}
            with whole(path) as partial:
                figure.savefig(partial, metadata=metadata)
        plt.close(figure)


def trajectory(dataset, limits):
    """Draw Y(t), X(t) and the phase portrait for every penalization of a trajectory artifact.

    Parameters
    ----------
    dataset : xarray.Dataset
        y and x over (n, time).
    limits : dict
        Smallest axis limits of the panels: keys ``"Y"``, ``"X"`` and ``"phase"`` (X, Y); they
        are widened where the data need it.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(
        1, 3, figsize=(TEXT_WIDTH, 2.25), width_ratios=[1.25, 1.25, 1.0], layout="constrained"
    )
    finite = [n for n in dataset["n"].values if n < float("inf")]
    styles = {n: ((SKY, GREEN, BLACK)[k % 3], "--", 0.9) for k, n in enumerate(finite)}
    if finite:
        styles[finite[-1]] = (BLUE, "-", 1.6)
    styles[float("inf")] = (ORANGE, "-", 0.5)
    time = dataset["time"].values
    for n in dataset["n"].values:
        color, dashes, width = styles[n]
        run = dataset.sel(n=n)
        text = r"$n = \infty$" if n == float("inf") else f"$n = {n:g}$"
        options = {"color": color, "linestyle": dashes, "linewidth": width}
        axes[0].plot(time, run["y"], label=text, **options)
        axes[1].plot(time, run["x"], **options)
        axes[2].plot(run["x"], run["y"], **options)
    y, x = dataset["y"].values, dataset["x"].values
    for axis, name, values in zip(axes, "YX", (y, x), strict=False):
        axis.set(xlabel="time $t$", ylabel=f"${name}$", xlim=(time[0], time[-1]))
        axis.set_ylim(_containing(limits[name], values))
    axes[2].set(xlabel="$X$", ylabel="$Y$")
    axes[2].set_xlim(_containing(limits["phase"][0], x))
    axes[2].set_ylim(_containing(limits["phase"][1], y))
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def _containing(limits, values):
    """Widen axis limits to contain the values."""
    margin = 0.03 * (values.max() - values.min())
    return min(limits[0], values.min() - margin), max(limits[1], values.max() + margin)
