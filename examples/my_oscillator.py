"""
With which probability does my oscillator drift too far?
========================================================

A yielding frame under white noise: how likely has its permanent deformation reached a limit before
a time? First for some limits at once, by simulation; then for one of them by a formula.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

frame = ns.Scene(
    "elasto_plastic", damping=0.5, potential="x**2/2", observable="plastic_strain_rate"
)
horizons = np.linspace(2, 60, 30)
limits = [1.0, 1.5, 2.0]
sampled = ns.crossing_probability(frame, limits, horizons, step=0.05, paths=4000, seed=1)
ns.plot(sampled)
plt.show()

# %%
# The bands are 95 % confidence limits. A formula takes no paths. It is for large thresholds and
# times; the band of its error is wide where they are small.

corrected = ns.crossing_probability(frame, 2.0, horizons, method="corrected")
ns.plot({"sampled": sampled.sel(threshold=2.0), "corrected formula": corrected})
plt.show()
