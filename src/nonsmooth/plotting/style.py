"""One style for all figures, those of the paper and of the manual, too."""

from typing import Any

TEXT_WIDTH = 6.3  # inches
# Wong's colour-blind-safe palette, ordered so that neighbours also differ in grey
BLACK, BLUE, ORANGE, SKY, GREEN = "#000000", "#0072B2", "#D55E00", "#56B4E9", "#009E73"
# looks of the curves of a sweep over p
LOOKS = [(GREEN, (0, (1, 2))), (SKY, (0, (3, 1, 1, 1, 1, 1))), (BLUE, "-."), (BLACK, "--")]

STYLE: Any = {
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
