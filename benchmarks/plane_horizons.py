"""What a hundred horizons of a crossing of two variables cost.

`python -m benchmarks.plane_horizons [tol]` asks the deterministic method for T = 0.2 ... 20 at
p = 1, 10, 100 and 1e4, in the scenes of the sweep with two state variables, and prints the seconds
on one core, the largest stated error, and whether the tolerance (1e-4 unless given) was met.
"""

import sys
import time
from pathlib import Path

import numpy as np
import yaml

import nonsmooth as ns
from nonsmooth.errors import ToleranceError

HORIZONS = np.linspace(0.2, 20.0, 100)
SCALES = 1.0, 10.0, 100.0, 1e4


def asked(scene, threshold, p, tol):
    """Seconds, the largest error, and whether it is within `tol`."""
    began = time.process_time()
    try:
        found = ns.crossing_probability(scene, threshold, HORIZONS, p, "deterministic", tol=tol)
        met = True
    except ToleranceError as refused:
        found, met = refused.result, False
    error = float(found["probability_error"].max()) if found is not None else np.nan
    return time.process_time() - began, error, met


def main(tol=1e-4):
    """Print a line per scene and p."""
    scenes = yaml.safe_load(Path("config.yaml").read_text("utf-8"))["sweep"]["scenes"]
    for name, entry in scenes.items():
        scene = ns.Scene(**entry["scene"])
        if scene.dimension != 2:
            continue
        for p in SCALES:
            seconds, error, met = asked(scene, entry["threshold"], p, tol)
            says = "met" if met else "missed"
            print(f"{name:25s} p = {p:<6g} {seconds:6.1f} s, error {error:.1e}, {says}", flush=True)


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
