"""Rare crossings of the nine scenes: relative error times the root of the number of paths.

python -m benchmarks.rare_crossings [p ...]

For each scene of the sweep, and for each p, thresholds are raised until W is below 1e-9. Counting
has 1/sqrt(W).
"""

import sys

import numpy as np
import yaml

import nonsmooth as ns
from nonsmooth.errors import ToleranceError

PATHS = 10_000


def row(scene: ns.Scene, threshold: float, p: float) -> tuple[float, float]:
    """Return W and its relative standard error times the root of the number of paths."""
    options = {"p": p, "method": "importance_sampling", "paths": PATHS, "step": 0.05, "seed": 1}
    try:
        found = ns.crossing_probability(scene, (-np.inf, threshold), [2.0], tol=1.0, **options)
    except ToleranceError as refused:
        found = refused.result
    W = found.probability.item()
    return W, found.standard_error.item() / max(W, 1e-300) * PATHS**0.5


def main() -> None:
    """Print the table."""
    with open("config.yaml") as file:
        scenes = yaml.safe_load(file)["sweep"]["scenes"]
    for p in map(float, sys.argv[1:] or ["10", "100"]):
        for name, given in scenes.items():
            scene, cells, W, factor = ns.Scene(**given["scene"]), [], 1.0, 0.4
            while W > 1e-9 and factor < 20:
                W, spread = row(scene, factor * given["threshold"], p)
                cells.append(f"{W:.1e}: {spread:.1f}")
                factor += 0.8
            print(f"p = {p:g}  {name:28s}" + "  ".join(cells), flush=True)


if __name__ == "__main__":
    main()
