r"""
A study in SI units
===================

A machine of 1200 kg slides on a flat bearing, through which at most 700 N pass. How reliable is it
that it stays on its plate, after so many seconds of shaking? The reliability index is
:math:`\beta = -\Phi^{-1}(W)`, with :math:`W` the probability that the displacement, the integral of
the velocity, has crossed the rim. ``snakemake study_sliding_isolator`` asks this and more, of two
bearings and in a report.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns
from nonsmooth.dimensions import Structure

isolator = Structure(
    "friction", mass=1200, damping=3000, limit=700,
    spectral_density=0.008, ground_frequency=2.4 * 2 * np.pi, ground_damping=0.6,
)  # fmt: skip
scene, length, time = isolator.scene(n=100), isolator.scales.length, isolator.scales.time
print(f"{1000 * length:.3f} mm and {1000 * time:.1f} ms are the units of the scene")

rims, seconds = np.array([0.1, 0.15]), np.array([5, 10, 15, 20, 30])
steady = ns.crossing_probability(scene, rims / length, seconds / time, seed=1)
# the formula's t is in the scene's unit of time, too
short = ns.crossing_probability(
    scene, rims / length, seconds / time, envelope=f"min(1, exp(2 - {time / 4}*t))", seed=1
)

for label, style, found in (("lasting", "-", steady), ("dying out after 8 s", "--", short)):
    for k, rim in enumerate(rims):
        curve = ns.reliability_index(found).isel(threshold=k)
        plt.fill_between(seconds, curve["lower"], curve["upper"].clip(max=4), alpha=0.2)
        plt.plot(seconds, curve["reliability_index"], f"o{style}", label=f"{rim:.2f} m, {label}")
plt.xlabel("time in s")
plt.ylabel(r"reliability index $\beta$")
plt.legend()
plt.show()
