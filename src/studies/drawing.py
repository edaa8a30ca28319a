"""The system of a scene as a picture: mass, spring, dashpot, its non-smooth element, the ground."""

from io import BytesIO

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from nonsmooth.plotting.style import ORANGE
from nonsmooth.plotting.style import STYLE as PRINTED
from nonsmooth.scenes.scene import Scene
from reproduction.rendering import mechanics
from reproduction.rendering.mechanics import arrow, line

GREY = {"color": "0.45", "linewidth": 0.7}
# larger than in print, and the same names of elements on every run
STYLE = PRINTED | {"font.size": 9, "svg.hashsalt": "nonsmooth"}
LEFT, MASS, WIDTH, FLOOR = 0.0, 3.0, 1.3, 0.0
SIZE = 1.35  # of the elements


def drawn(scene: Scene, limit: str) -> Figure:
    """Draw a scene's system on its shaking ground.

    Parameters
    ----------
    scene : Scene
    limit : str
        The slip force, the yield force or the gap, as it is called in the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axis = plt.subplots(figsize=(4.6, 2.1), constrained_layout=True)
    axis.set(xlim=(-1.3, 6.6), ylim=(-1.15, 2.15), aspect="equal")
    axis.axis("off")
    _ground(axis)
    axis.add_patch(Rectangle((MASS, 0.25), WIDTH, 1.3, facecolor="#dce8f2", edgecolor="black"))
    axis.text(MASS + WIDTH / 2, 0.9, "$m$", ha="center", va="center", fontsize=13)
    has_spring = scene.potential != "0"
    mechanics.dashpot(axis, LEFT, MASS, 0.5, SIZE)
    axis.text((LEFT + MASS) / 2 + 0.5, 0.58, "$c$", fontsize=10)
    match scene.mechanics.name:
        case "elasto_plastic":
            _spring(axis, LEFT, 1.7)
            mechanics.slider(axis, 1.7, MASS, 1.3, SIZE)
            axis.text((1.7 + MASS) / 2, 1.75, limit, fontsize=9, ha="center")
            _rollers(axis)
        case "friction":
            if has_spring:
                _spring(axis, LEFT, MASS)
            _pad(axis, limit)
        case _:
            if has_spring:
                _spring(axis, LEFT, MASS)
            _stops(axis, limit)
            _rollers(axis)
    arrow(axis, (MASS + 0.35, 1.85), (MASS + WIDTH + 0.25, 1.85))
    axis.text(MASS + WIDTH + 0.3, 1.85, "displacement", va="center", fontsize=8)
    return figure


def _ground(axis):
    """Draw the floor and the wall as one body, which moves to and fro."""
    line(axis, (LEFT, 1.9), (LEFT, FLOOR), (6.3, FLOOR))
    for x in np.arange(0.15, 6.3, 0.3):
        axis.plot([x, x - 0.2], [FLOOR, FLOOR - 0.2], **GREY)
    for y in np.arange(0.15, 1.9, 0.3):
        axis.plot([LEFT, LEFT - 0.2], [y, y - 0.2], **GREY)
    arrow(axis, (1.9, -0.62), (3.5, -0.62), "<|-|>")
    axis.text(3.65, -0.62, "ground acceleration $a(t)$", va="center", fontsize=8)
    # a path of noise, the same in every picture
    t = np.linspace(0, 1.9, 120)
    phases = np.array([1.0, 2.7, 4.1, 0.3, 5.2])
    wave = sum(np.sin((5 + 4.3 * k) * t + phase) for k, phase in enumerate(phases))
    axis.plot(-0.2 + t, -0.62 + 0.06 * wave, color=ORANGE, linewidth=0.8)


def _spring(axis, left, right):
    mechanics.spring(axis, left, right, 1.3, SIZE)
    axis.text((left + right) / 2, 1.57, "$k$", ha="center", fontsize=10)


def _pad(axis, limit):
    """Draw the rough surface on which the mass slides."""
    axis.add_patch(
        Rectangle((MASS + 0.1, FLOOR), WIDTH - 0.2, 0.25, facecolor="0.75", hatch="////")
    )
    axis.text(MASS + WIDTH + 0.15, 0.2, f"friction {limit}", fontsize=9, va="center")


def _rollers(axis):
    for x in (MASS + 0.3, MASS + WIDTH - 0.3):
        axis.add_patch(plt.Circle((x, FLOOR + 0.125), 0.125, fill=False, linewidth=1))


def _stops(axis, limit):
    """Draw the stops on both sides, which stand on the floor, and the gap to one of them."""
    gap = 0.42
    for x, way in ((MASS - gap, -1), (MASS + WIDTH + gap, 1)):
        # short enough to leave room for the spring and the dashpot
        line(axis, (x, FLOOR), (x, 0.28), linewidth=2.2)
        line(axis, (x, 0.72), (x, 1.0), linewidth=2.2)
        for y in np.arange(0.05, 0.95, 0.15):
            if not 0.28 < y < 0.72:
                axis.plot([x, x + way * 0.12], [y, y + 0.1], **GREY)
    arrow(axis, (MASS + WIDTH, 1.3), (MASS + WIDTH + gap, 1.3), "<|-|>")
    axis.text(MASS + WIDTH + gap + 0.12, 1.3, f"gap {limit}", fontsize=9, va="center")


def as_svg(figure: Figure) -> str:
    """Return a figure as SVG, the same text on every run, and close it."""
    content = BytesIO()
    figure.savefig(content, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    text = content.getvalue().decode()
    return text[text.index("<svg") :]
