r"""
Permanent deformation in an earthquake
======================================

The ground filters white noise, as Kanai and Tajimi have it; on it stands a frame that yields. Its
permanent deformation is the integral of the plastic strain rate. Lengths are in units of the yield
displacement, times in units of the frame's period over :math:`2\pi`.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

ground = ns.KanaiTajimi(stiffness=6.25, damping=3.0, sigma=3.0)
frame = ns.Scene(
    "elasto_plastic",
    ground,
    damping=0.1,
    potential="x**2/2",
    observable="plastic_strain_rate",
)
paths = ns.simulate(frame, 60, step=0.02, paths=8, seed=1, keep="paths")
ns.plot(paths[["eta", "x", "delta"]])
plt.show()

# %%
# The probability that the deformation has reached some limits, with 95 % confidence limits.

horizons = np.linspace(5, 60, 23)
ns.plot(ns.crossing_probability(frame, [2, 4, 6], horizons, step=0.05, paths=4000, seed=1))
plt.show()
