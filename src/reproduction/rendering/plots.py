"""One style for all figures; the same bytes on every run."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

# the scripts take the style from here
from nonsmooth.plotting.style import BLACK as BLACK
from nonsmooth.plotting.style import BLUE as BLUE
from nonsmooth.plotting.style import GREEN as GREEN
from nonsmooth.plotting.style import LOOKS as LOOKS
from nonsmooth.plotting.style import ORANGE as ORANGE
from nonsmooth.plotting.style import SKY as SKY
from nonsmooth.plotting.style import STYLE as STYLE
from nonsmooth.plotting.style import TEXT_WIDTH as TEXT_WIDTH
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.noises import NOISES
from nonsmooth.scenes.scene import Scene
from reproduction.jobs.files import write_whole
from reproduction.jobs.job import Task, inputs, job


def draw(plot: Callable, task: Task) -> None:
    """Run a task whose outputs are one figure as PDF and PNG.

    Parameters
    ----------
    plot : callable
        Takes the task's input artifacts and parameters by name, returns a matplotlib Figure.
    task : Task
    """
    with job(task), mpl.rc_context(STYLE):
        figure = plot(**inputs(task), **dict(task.params.items()))
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # the layout found above serves all files
        for path in map(Path, task.output):
            metadata = {"CreationDate": None} if path.suffix == ".pdf" else {"Software": None}
            content = BytesIO()
            figure.savefig(content, format=path.suffix[1:], metadata=metadata)
            write_whole(path, content.getvalue())
        plt.close(figure)


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


def from_zero(values: ArrayLike) -> np.ndarray:
    """Put a zero before the values of a curve that begins at the origin."""
    return np.concatenate([[0.0], values])
