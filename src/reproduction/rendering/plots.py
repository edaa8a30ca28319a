"""One style for all figures; the same bytes on every run."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
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


def from_zero(values: ArrayLike) -> np.ndarray:
    """Put a zero before the values of a curve that begins at the origin."""
    return np.concatenate([[0.0], values])
