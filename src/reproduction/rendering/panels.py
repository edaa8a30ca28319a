"""Panels for all kinds of scenes."""

from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.noises import NOISES
from nonsmooth.scenes.scene import Scene
from reproduction.rendering.plots import TEXT_WIDTH


def scene_panels(
    height: float, xlabel: str, ylabel: str, **options
) -> tuple[Figure, np.ndarray, Callable[[Scene], Axes]]:
    """Make one panel for each kind of scene, models in rows and noises in columns.

    Parameters
    ----------
    height : float
        Of the figure, in text widths.
    xlabel, ylabel : str
        Labels of the outer panels; the second one stands below the name of the model.
    **options
        Of `matplotlib.pyplot.subplots`.

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : numpy.ndarray
        All panels.
    panel : callable
        Finds the panel of a scene.
    """
    rows, columns = list(MODELS), list(NOISES)
    figure, axes = plt.subplots(
        len(rows),
        len(columns),
        figsize=(TEXT_WIDTH, height * TEXT_WIDTH),
        sharey=True,
        squeeze=False,
        **options,
    )
    for row, model in zip(axes, rows, strict=True):
        row[0].set_ylabel(f"{MODELS[model].title.lower()}\n{ylabel}")
    for top, noise in zip(axes[0], columns, strict=True):
        top.set_title(f"{noise} noise", fontsize=8, loc="left")
    for bottom in axes[-1]:
        bottom.set_xlabel(xlabel)
    return figure, axes, lambda s: axes[rows.index(s.mechanics.name), columns.index(s.noise.kind)]
