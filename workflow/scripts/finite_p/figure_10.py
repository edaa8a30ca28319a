"""Figure 10: errors of the asymptotic formula and of its corrections against p."""

import matplotlib.pyplot as plt

from reproduction.rendering.plots import BLACK, BLUE, GREEN, ORANGE, TEXT_WIDTH, draw

LOOKS = {
    "asymptotic": (ORANGE, "o", "-"),
    "order 1": (BLUE, "s", "--"),
    "order 2": (BLACK, "^", "-."),
    "order 3": (GREEN, "D", (0, (3, 1))),
}


def errors(formulas, fit_from):
    """Draw the largest error over T where it is resolved, what is stated, and the fitted powers.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axis = plt.subplots(figsize=(0.75 * TEXT_WIDTH, 3.2))
    p = formulas["p"].values
    for name, (color, marker, dashes) in LOOKS.items():
        row = formulas.sel(formula=name)
        known = row["resolved"].values.any(axis=-1)
        axis.plot(
            p[known],
            row["distance"].values[known],
            color=color,
            marker=marker,
            markersize=3.5,
            linestyle=dashes,
            label=f"{name}: slope ${float(row['slope']):.2f}$",
        )
        if name != "asymptotic":
            stated = row["probability_error"].max("horizon")
            axis.plot(p, stated, color=color, linewidth=0.6, linestyle=dashes, alpha=0.7)
    floor = formulas["exact_error"].max("horizon")
    axis.plot(p, floor, color="0.5", linestyle=":", label="error of the exact value")
    axis.axvspan(p[0] / 2, fit_from, color="0.95", linewidth=0)
    axis.set(
        xlabel="$p$",
        ylabel="largest error over $T$",
        xscale="log",
        yscale="log",
        xlim=(p[0] / 2, p[-1] * 2),
    )
    axis.set_ylim(top=1.0)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


if __name__ == "__main__":
    draw(errors, snakemake)
