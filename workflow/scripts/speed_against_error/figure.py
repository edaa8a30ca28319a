"""Work-precision diagrams: error against time, error against step, or time against size."""

from itertools import cycle

import matplotlib.pyplot as plt
import numpy as np

from reproduction.rendering.plots import BLACK, BLUE, GREEN, ORANGE, SKY, TEXT_WIDTH, draw
from reproduction.speed_against_error.work_precision import front

LOOKS = [
    (BLUE, "o", "-"),
    (ORANGE, "s", "-"),
    (GREEN, "^", "-"),
    (BLACK, "D", "-"),
    (SKY, "v", "-"),
    ("#CC79A7", "P", "--"),
    ("#8C6D00", "X", "--"),
    ("0.5", "*", "--"),
    ("0.3", "<", ":"),
    ("#8800CC", ">", "-"),
]
LABELS = {"seconds": "time in s", "error": "error", "size": "time step"}
COLUMNS = 3


def diagram(measurements, x, y):
    """Draw one panel per problem and one curve per method, with bars from least to largest.

    Parameters
    ----------
    measurements : xarray.Dataset
        From `reproduction.speed_against_error.work_precision.measured`.
    x, y : {"seconds", "error", "size"}
        y is drawn against x. If these are error and time, the curve joins the cases that no other
        case of the method beats in both. An error below its own uncertainty is drawn at that.

    Returns
    -------
    matplotlib.figure.Figure
    """
    table = measurements.to_dataframe()
    panels, methods = (list(dict.fromkeys(table[name])) for name in ("panel", "method"))
    columns = min(COLUMNS, len(panels))
    rows = -(-len(panels) // columns)
    shared = y if (x == "size" and y == "error") or x == "seconds" else False
    figure, axes = plt.subplots(
        rows,
        columns,
        figsize=(TEXT_WIDTH, 0.75 + 1.95 * rows),
        squeeze=False,
        sharey=bool(shared),
        sharex=x != "size" or y == "error",
    )
    for axis, panel in zip(axes.flat, panels, strict=False):
        for k, (method, (color, marker, dashes)) in enumerate(
            zip(methods, cycle(LOOKS), strict=False)
        ):
            here = table[(table["panel"] == panel) & (table["method"] == method)]
            if len(here):
                # later ones are smaller, so that those beneath them are seen
                looks = {"color": color, "marker": marker, "markersize": 4.5 - 0.2 * k}
                _curve(axis, here, x, y, linestyle=dashes, label=method, **looks)
        axis.set(xscale="log", yscale="log")
        axis.set_title(panel, fontsize=8)
        sizes = np.unique(table["size"][table["panel"] == panel])
        if y == "seconds" and sizes[-1] < 10:  # a count
            axis.set_xticks(sizes, [f"{size:g}" for size in sizes])
            axis.set_xticks([], minor=True)
    for axis in axes.flat[len(panels) :]:
        axis.set_axis_off()
    for row in axes:
        row[0].set_ylabel(LABELS[y])
    if y == "error":  # otherwise each panel's title says it
        for axis in axes[-1]:
            axis.set_xlabel(LABELS[x])
    found = {}
    for axis in axes.flat[: len(panels)]:
        handles, labels = axis.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    names = [method for method in methods if method in found]
    figure.legend([found[name] for name in names], names, loc="outside upper center", ncols=COLUMNS)
    return figure


def _curve(axis, table, x, y, linestyle, **options):
    values = {"size": table["size"].to_numpy(), "seconds": table["seconds"].to_numpy()}
    bars = {
        "seconds": np.abs(
            table[["seconds_least", "seconds_most"]].to_numpy().T - values["seconds"]
        ),
        "size": None,
    }
    if "error" in (x, y):
        doubt = table["error_error"].to_numpy()
        values["error"] = np.maximum(table["error"].to_numpy(), doubt)
        # no lower than to a tenth, where a logarithmic axis has no end
        bars["error"] = np.array([np.minimum(doubt, 0.9 * values["error"]), doubt])
    joined = np.argsort(values[x])
    if x == "seconds":
        joined = front(values[x], values[y])
    label = options.pop("label")
    axis.errorbar(
        values[x],
        values[y],
        xerr=bars[x],
        yerr=bars[y],
        linestyle="none",
        elinewidth=0.5,
        alpha=0.45,
        **options,
    )
    axis.plot(
        values[x][joined],
        values[y][joined],
        linestyle=linestyle,
        label=label,
        **options,
    )


if __name__ == "__main__":
    draw(diagram, snakemake)
