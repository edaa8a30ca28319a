r"""
One threshold, from a fast start
================================

A mass slides off with the velocity 3. With which probability has it been one unit ahead of its
start by the time T? Only the upper threshold counts. The curves are solved for, the dots counted on
paths, with 95 % confidence limits.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

horizons = np.linspace(0.5, 6, 12)
ahead = (-np.inf, 1.0)
start = {f"from y = {y:g}": ns.Scene("friction", start={"y": y}) for y in (0.0, 1.5, 3.0)}
found = {
    name: ns.crossing_probability(scene, ahead, horizons, tol=1e-4) for name, scene in start.items()
}
panel = ns.plot(found)["probability"]
panel.set(ylim=(0, 1), ylabel="probability of having been ahead by 1")

counted = ns.crossing_probability(
    start["from y = 3"], ahead, horizons[2::3], step=0.01, paths=4000, seed=1
)
band = counted["probability"] - counted["lower"], counted["upper"] - counted["probability"]
panel.errorbar(counted["horizon"], counted["probability"], band, fmt="k.")
plt.show()
