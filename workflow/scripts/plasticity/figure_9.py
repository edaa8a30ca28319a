"""Figure 9: probability of exceeding a permanent deformation, by formulas and Monte Carlo."""

import matplotlib.pyplot as plt

from reproduction.plasticity import relaxation_time
from reproduction.rendering.plots import BLUE, GREEN, ORANGE, TEXT_WIDTH, draw, from_zero

COLORS = [GREEN, BLUE, ORANGE]
LOOKS = {
    "asymptotic": ("probability", "difference", (0, (1, 1.5))),
    "corrected": ("corrected", "corrected_difference", "-"),
}


def exceedance(monte_carlo, check, oscillator):
    """Draw the probability against the duration above the differences to Monte Carlo.

    Parameters
    ----------
    monte_carlo : list of xarray.Dataset
        One per limit, drawn as 95 % bands.
    check : xarray.Dataset
        The formulas over (limit, duration), drawn as lines.
    oscillator : dict
        Its damping gives the second scale of time.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(0.75 * TEXT_WIDTH, 4.6), sharex=True, height_ratios=[2, 1]
    )
    duration = from_zero(check["duration"])
    for run, color in zip(monte_carlo, COLORS, strict=False):
        limit = float(run["limit"])
        formulas = check.sel(limit=limit)
        lower, upper = from_zero(run["lower"]), from_zero(run["upper"])
        options = {"color": color, "alpha": 0.45, "linewidth": 0}
        top.fill_between(duration, lower, upper, label=f"{limit:g}, Monte Carlo", **options)
        for text, (probability, difference, dashes) in LOOKS.items():
            value = from_zero(formulas[probability])
            line = {"color": color, "linestyle": dashes}
            top.plot(duration, value, label=f"{limit:g}, {text}", **line)
            bottom.fill_between(duration, value - upper, value - lower, **options)
            bottom.plot(duration[1:], formulas[difference], linewidth=0.7, **line)
    bottom.axhline(0, color="0.3", linewidth=0.6, zorder=1)
    unit = relaxation_time(oscillator)
    scale = top.secondary_xaxis("top", functions=(lambda t: t / unit, lambda t: t * unit))
    scale.set_xlabel("duration in relaxation times $2/C_b$")
    top.set(ylabel="probability of exceeding the limit", ylim=(0, 1))
    bottom.set(xlabel="duration", ylabel="formulas less\nMonte Carlo", xlim=(0, duration[-1]))
    figure.legend(
        loc="outside upper center", ncols=len(monte_carlo), title="limit in yield displacements"
    )
    return figure


if __name__ == "__main__":
    draw(exceedance, snakemake)
