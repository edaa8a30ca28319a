"""Figure 1: the three rheological models, drawn from springs, dashpots and sliders."""

import matplotlib.pyplot as plt

from nonsmooth.scenes.models.elasto_plastic import ELASTO_PLASTIC
from nonsmooth.scenes.models.friction import FRICTION
from nonsmooth.scenes.models.obstacle import OBSTACLE
from reproduction.rendering.mechanics import sketch
from reproduction.rendering.plots import TEXT_WIDTH, draw


def rheology():
    """Draw the elasto-plastic, friction and obstacle models.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(1, 3, figsize=(TEXT_WIDTH, 1.6))
    for axis, label, model in zip(axes, "abc", (ELASTO_PLASTIC, FRICTION, OBSTACLE), strict=True):
        axis.set_title(f"({label}) {model.title.lower()}", fontsize=8)
        sketch(axis, model.name)
    return figure


if __name__ == "__main__":
    draw(rheology, snakemake)
