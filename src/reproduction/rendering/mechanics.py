"""Springs, dashpots and the like, drawn between two ends at a height.

Figure 1, the pictures of the manual and the reports of studies are made of them. Elements are
larger by their `size`; lengths are those of the axis.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from nonsmooth.plotting.style import BLACK

_LINE = {"color": BLACK, "linewidth": 1.1, "solid_capstyle": "butt"}
_HATCH = {"color": "0.5", "linewidth": 0.7}
_COILS = 9


def line(axis: Axes, *points: tuple[float, float], **look: Any) -> None:
    """Connect points."""
    axis.plot(*np.array(points).T, **(_LINE | look))


def wall(axis: Axes, x: float, side: int = -1) -> None:
    """Draw a fixed wall from -1 to 1, hatched on one side."""
    line(axis, (x, -1), (x, 1))
    for height in np.linspace(-1, 0.875, 16):
        ends = height + 0.125 * (side > 0), height + 0.125 * (side < 0)
        axis.plot([x, x + side * 0.125], ends, **_HATCH)


def dashpot(axis: Axes, left: float, right: float, height: float, size: float = 1.0) -> None:
    """Draw a linear damper."""
    middle = (left + right) / 2
    piston, end, rim = middle + 0.1 * size, middle + 0.25 * size, 0.14 * size
    line(axis, (left, height), (piston, height))
    line(axis, (piston, height - 0.1 * size), (piston, height + 0.1 * size))
    corners = (middle - 0.25 * size, rim), (end, rim), (end, -rim), (middle - 0.25 * size, -rim)
    line(axis, *((x, height + above) for x, above in corners))
    line(axis, (end, height), (right, height))


def spring(axis: Axes, left: float, right: float, height: float, size: float = 1.0) -> None:
    """Draw a spring."""
    lead = 0.12 * (right - left)
    t = np.linspace(0, 1, 300)
    turned = 2 * np.pi * _COILS * t
    x = left + lead + (right - left - 2 * lead) * t - 0.05 * size * np.sin(turned)
    y = height + 0.11 * size * np.cos(turned)
    line(axis, *zip(x, y, strict=True))
    line(axis, (left, height), (left + lead, height), (x[0], y[0]))
    line(axis, (x[-1], y[-1]), (right - lead, height), (right, height))


def slider(axis: Axes, left: float, right: float, height: float, size: float = 1.0) -> None:
    """Draw two plates that slip on each other, pressed together by two arrows."""
    middle, above, end = (left + right) / 2, height + 0.13 * size, right - 0.1 * size
    line(axis, (left, height), (middle + 0.25 * size, height))
    line(axis, (middle - 0.25 * size, above), (end, above), (end, height))
    line(axis, (end, height), (right, height))
    for x in (middle - 0.15 * size, middle + 0.15 * size):
        arrow(axis, (x, height + 0.26 * size), (x, height), mutation_scale=7)


def arrow(
    axis: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    style: str = "-|>",
    **look: Any,
) -> None:
    """Draw an arrow."""
    known = {"arrowstyle": style, "linewidth": 0.9, "color": BLACK, "shrinkA": 0, "shrinkB": 0}
    axis.annotate("", end, start, arrowprops=known | look)


def sketch(axis: Axes, model: str) -> None:
    """Draw one of the paper's models between a wall at -1 and its mass, which the noise drives.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    model : {"elasto_plastic", "friction", "obstacle"}
    """
    axis.set(xlim=(-1.2, 2.75), ylim=(-1.05, 1.05), aspect="equal")
    axis.axis("off")
    wall(axis, -1)
    dashpot(axis, -1, 1, 0.5)
    line(axis, (1, -0.5), (1, 0.5))
    line(axis, (1, 0), (1.5, 0))
    axis.add_patch(Rectangle((1.5, -0.14), 0.28, 0.28, facecolor=BLACK))
    arrow(axis, (2.28, 0), (1.8, 0), linewidth=1.0, shrinkB=2)
    axis.text(2.3, 0, "$N_t$", va="center", ha="left")
    if model == "elasto_plastic":
        spring(axis, -1, 0.1, -0.5)
        slider(axis, 0.1, 1, -0.5)
    elif model == "friction":
        spring(axis, -1, 1, 0)
        slider(axis, -1, 1, -0.5)
    else:
        spring(axis, -1, 1, -0.5)
        wall(axis, 1.25)
        wall(axis, 2.03, side=1)
