"""One style for all figures; the same bytes on every run."""

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt

from reproduction.files import whole
from reproduction.jobs import Task, inputs, job

TEXT_WIDTH = 6.3  # inches
# Wong's colour-blind-safe palette, ordered so that neighbours also differ in grey
BLACK, BLUE, ORANGE, SKY, GREEN = "#000000", "#0072B2", "#D55E00", "#56B4E9", "#009E73"
# looks of the curves of a sweep over p
LOOKS = [(GREEN, (0, (1, 2))), (SKY, (0, (3, 1, 1, 1, 1, 1))), (BLUE, "-."), (BLACK, "--")]

STYLE = {
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.constrained_layout.use": True,
    "font.family": "STIXGeneral",
    "font.size": 8,
    "grid.color": "0.9",
    "grid.linewidth": 0.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "mathtext.fontset": "stix",
    "pdf.fonttype": 42,
    "savefig.dpi": 200,
}


def draw(plot: Callable, task: Task) -> None:
    """Run a task whose outputs are one figure as PDF and PNG.

    Parameters
    ----------
    plot : callable
        Takes the task's input artifacts and parameters by name, returns a matplotlib Figure.
    task : Task
    """
    with job(task.log[0]), mpl.rc_context(STYLE):
        figure = plot(**inputs(task), **dict(task.params.items()))
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # the layout is found once, for all files
        for path in map(Path, task.output):
            metadata = {"CreationDate": None} if path.suffix == ".pdf" else {"Software": None}
            with whole(path) as partial:
                figure.savefig(partial, metadata=metadata)
        plt.close(figure)
