r"""
A rare crossing
===============

How probable is it that friction under colored noise lets a body slide far? Counting would need
billions of paths; here a few thousand are led to the threshold and weighted.
"""

import matplotlib.pyplot as plt

import nonsmooth as ns

scene = ns.Scene("friction", noise="langevin")
thresholds = [0.3, 0.6, 0.9]
found = ns.crossing_probability(
    scene, thresholds, horizons=[2.0], p=10, method="importance_sampling", seed=1
).isel(horizon=0)

figure, axes = plt.subplots(figsize=(5, 3.5))
axes.errorbar(
    found.threshold, found.probability, found.probability_error, marker="o", capsize=3, lw=1
)
axes.set(yscale="log", xlabel="threshold b", ylabel="probability W", title="p = 10, T = 2")
figure.tight_layout()
plt.show()
