"""Figure 1: the three rheological models, drawn from springs, dashpots and sliders."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from nonsmooth.scenes.models.elasto_plastic import ELASTO_PLASTIC
from nonsmooth.scenes.models.friction import FRICTION
from nonsmooth.scenes.models.obstacle import OBSTACLE
from reproduction.rendering.plots import TEXT_WIDTH, draw

LINE = {"color": "black", "linewidth": 1.1, "solid_capstyle": "butt"}


def line(axis, *points):
    """Connect points."""
    axis.plot(*np.array(points).T, **LINE)


def wall(axis, x, side=-1):
    """Draw a fixed wall at x, hatched on one side."""
    line(axis, (x, -1), (x, 1))
    for height in np.linspace(-1, 0.875, 16):
        axis.plot([x, x + side * 0.125], [height + 0.125 * (side > 0), height + 0.125 * (side < 0)],
                  color="0.5", linewidth=0.7)  # fmt: skip


def dashpot(axis, left, right, height):
    """Draw a linear damper, the term C_b y."""
    middle = (left + right) / 2
    line(axis, (left, height), (middle + 0.1, height))
    line(axis, (middle + 0.1, height - 0.1), (middle + 0.1, height + 0.1))
    line(
        axis,
        (middle - 0.25, height + 0.14),
        (middle + 0.25, height + 0.14),
        (middle + 0.25, height - 0.14),
        (middle - 0.25, height - 0.14),
    )
    line(axis, (middle + 0.25, height), (right, height))


def spring(axis, left, right, height):
    """Draw a spring, the potential U."""
    lead = 0.12 * (right - left)
    t = np.linspace(0, 1, 300)
    span = right - left - 2 * lead
    coils = 9
    x = left + lead + span * t - 0.05 * np.sin(2 * np.pi * coils * t)
    y = height + 0.11 * np.sin(2 * np.pi * coils * t + np.pi / 2) - 0.11 * np.cos(0)
    axis.plot(x, y + 0.11, **LINE)
    line(axis, (left, height), (left + lead, height), (x[0], y[0] + 0.11))
    line(axis, (x[-1], y[-1] + 0.11), (right - lead, height), (right, height))


def slider(axis, left, right, height):
    """Draw a dry-friction element, which slips at the threshold force 1."""
    middle = (left + right) / 2
    line(axis, (left, height), (middle + 0.25, height))
    line(axis, (middle - 0.25, height + 0.13), (right - 0.1, height + 0.13), (right - 0.1, height))
    line(axis, (right - 0.1, height), (right, height))
    for x in (middle - 0.15, middle + 0.15):
        axis.annotate(
            "",
            (x, height),
            (x, height + 0.26),
            arrowprops={"arrowstyle": "-|>", "linewidth": 0.9, "color": "black",
                        "mutation_scale": 7, "shrinkA": 0, "shrinkB": 0},
        )  # fmt: skip


def mass(axis, x):
    """Draw the mass and the forcing N_t."""
    line(axis, (1, 0), (x, 0))
    axis.add_patch(Rectangle((x, -0.14), 0.28, 0.28, facecolor="black"))
    axis.annotate(
        "",
        (x + 0.3, 0),
        (x + 0.78, 0),
        arrowprops={"arrowstyle": "-|>", "linewidth": 1.0, "color": "black", "shrinkA": 0},
    )
    axis.text(x + 0.8, 0, "$N_t$", va="center", ha="left")


def rheology():
    """Draw the elasto-plastic, friction and obstacle models.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(1, 3, figsize=(TEXT_WIDTH, 1.6))
    for axis, label, model in zip(axes, "abc", (ELASTO_PLASTIC, FRICTION, OBSTACLE), strict=True):
        axis.set(xlim=(-1.2, 2.75), ylim=(-1.05, 1.05), aspect="equal")
        axis.axis("off")
        axis.set_title(f"({label}) {model.title.lower()}", fontsize=8)
        wall(axis, -1)
        dashpot(axis, -1, 1, 0.5)
        line(axis, (1, -0.5), (1, 0.5))
        mass(axis, 1.5)
    spring(axes[0], -1, 0.1, -0.5)
    slider(axes[0], 0.1, 1, -0.5)
    spring(axes[1], -1, 1, 0)
    slider(axes[1], -1, 1, -0.5)
    spring(axes[2], -1, 1, -0.5)
    wall(axes[2], 1.25)
    wall(axes[2], 2.03, side=1)
    return figure


if __name__ == "__main__":
    draw(rheology, snakemake)
