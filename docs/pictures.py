"""Pictures of the manual that are drawn, not computed.

`python docs/pictures.py` draws the picture of the models anew for the README.
"""

import re
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np

from nonsmooth.plotting.style import BLACK, BLUE, ORANGE
from reproduction.rendering.mechanics import sketch

STYLE = {
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9,
    "mathtext.fontset": "stix",
    "font.family": "STIXGeneral",
    "savefig.dpi": 160,
    "savefig.facecolor": "white",
    "svg.hashsalt": "nonsmooth",
}


def _sketch(axis, model):
    """Draw a model and name its elements."""
    sketch(axis, model)
    axis.text(0, 0.75, "$C_b\\,y$", ha="center")
    if model == "elasto_plastic":
        texts = {(-0.45, -0.95): "$U'(x)$", (0.6, -0.95): "yields at 1"}
    elif model == "friction":
        texts = {(-0.58, -0.4): "$U'(x)$", (0, -0.95): "slips at 1"}
    else:
        texts = {(0, -0.95): "$U'(x)$", (1.25, -1.25): "$-1$", (2.03, -1.25): "$1$"}
    for place, text in texts.items():
        axis.text(*place, text, ha="center")


def _law(axis, model):
    z = np.linspace(-1.6, 1.6, 801)
    for n, colour, dashes in ((2, ORANGE, "--"), (6, BLUE, "-.")):
        force = np.clip(n * z, -1, 1) if model == "friction" else n * (z - np.clip(z, -1, 1))
        axis.plot(z, force, color=colour, linestyle=dashes, label=f"$n = {n}$")
    if model == "friction":
        limit = [(-1.6, -1), (0, -1), (0, 1), (1.6, 1)]
        axis.set(xlabel="velocity $y$", ylabel="force")
    else:
        limit = [(-1, -3), (-1, 0), (1, 0), (1, 3)]
        plastic = model == "elasto_plastic"
        axis.set(
            xlabel="elastic deformation $x$" if plastic else "displacement $x$",
            ylabel="plastic strain rate" if plastic else "contact force",
        )
    axis.plot(*np.array(limit).T, color=BLACK, linewidth=1.1, label="$n = \\infty$")
    axis.set(xlim=(-1.6, 1.6), ylim=(-1.5, 1.5) if model == "friction" else (-2.4, 2.4))
    axis.axhline(0, color="0.85", linewidth=0.6, zorder=0)
    axis.set_xticks([-1, 0, 1])
    axis.set_yticks([-1, 0, 1] if model == "friction" else [-2, 0, 2])


def models():
    """Sketch each model, and below it the law of the penalty force."""
    figure, axes = plt.subplots(
        2, 3, figsize=(8.2, 3.9), height_ratios=[1, 1.05], layout="constrained"
    )
    names = {
        "elasto_plastic": "a spring that yields",
        "friction": "dry friction",
        "obstacle": "two obstacles",
    }
    for (model, title), (above, below) in zip(names.items(), axes.T, strict=True):
        above.set_title(f"{model}: {title}", fontsize=9.5)
        _sketch(above, model)
        _law(below, model)
    axes[1, 1].legend(frameon=False, fontsize=8, loc="lower right")
    return figure


def rule_graph(text):
    """Draw the rules, each to the right of all that it waits for, what belongs together in a row.

    The paper waits for all figures, tables and values, and is left out with them.
    """
    names = dict(re.findall(r"(id\d+)\[(.*?)\]", text))
    left_out = {"all", "paper", "values"}
    edges = {(names[a], names[b]) for a, b in re.findall(r"(id\d+) --> (id\d+)", text)}
    edges = {edge for edge in edges if not left_out & set(edge)}
    groups = [{name} for name in sorted(set(names.values()) - left_out)]
    for a, b in sorted(edges):
        joined = [group for group in groups if a in group or b in group]
        groups = [group for group in groups if group not in joined] + [set().union(*joined)]
    alone = sorted(name for group in groups if len(group) == 1 for name in group)
    groups = sorted((sorted(group) for group in groups if len(group) > 1), key=len, reverse=True)

    def column(name):
        return 1 + max((column(a) for a, b in edges if b == name), default=-1)

    place, top = {}, 0.0
    for group in groups:
        columns = [[n for n in group if column(n) == k] for k in range(max(map(column, group)) + 1)]
        rows = max(map(len, columns))
        for k, members in enumerate(columns):

            def wanted(name):
                heights = [place[a][1] for a, b in edges if b == name]
                return np.mean(heights) if heights else 0.0

            for row, name in enumerate(sorted(members, key=lambda n: (wanted(n), n))):
                place[name] = k, top + (row + 0.5) * rows / len(members)
        top += rows + 0.6
    for k, name in enumerate(alone):
        place[name] = k % 4, top + 0.5 + k // 4
    top += 1 + (len(alone) - 1) // 4
    figure, axis = plt.subplots(figsize=(8.4, 0.19 * top + 0.2))
    for a, b in sorted(edges):
        (x, y), (to_x, to_y) = place[a], place[b]
        way = np.linspace(0, 1, 40)
        bend = (1 - np.cos(np.pi * way)) / 2
        axis.plot(x + (to_x - x) * way, y + (to_y - y) * bend, color="0.6", linewidth=0.7, zorder=1)
    look = {"boxstyle": "round,pad=0.2", "facecolor": "white", "edgecolor": "0.5", "linewidth": 0.5}
    for name, (x, y) in place.items():
        axis.text(x, y, name, ha="center", va="center", fontsize=7.5, bbox=look)
    axis.set(xlim=(-0.5, 3.5), ylim=(top + 0.2, -0.2))
    axis.axis("off")
    figure.subplots_adjust(0, 0, 1, 1)
    return figure


def save(figure, path):
    """Write a figure without the time of day."""
    path.parent.mkdir(exist_ok=True)
    key = "Date" if path.suffix == ".svg" else "Software"
    figure.savefig(path, metadata={key: None})
    plt.close(figure)


def draw_all(folder):
    """Draw the pictures that pages show; the rule graph from what `make docs` has asked for."""
    with mpl.rc_context(STYLE):
        save(models(), folder / "models.svg")
        reported = folder / "rule_graph.txt"
        if reported.exists():
            save(rule_graph(reported.read_text(encoding="utf-8")), folder / "rule_graph.svg")


if __name__ == "__main__":
    with mpl.rc_context(STYLE):
        save(models(), Path(__file__).with_name("models.png"))
