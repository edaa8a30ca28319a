r"""
Where an oscillator between obstacles is
========================================

The invariant density of displacement and velocity of an oscillator between two walls at
:math:`x = \pm 1` under white noise. The walls are springs of the stiffness n = 100, so that the
mass gets into them by about :math:`n^{-1/2}`.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

scene = ns.Scene("obstacle", noise="white", n=100, potential="x**4/2 - x**2/2", observable="x")
points = {"x": np.linspace(-1.4, 1.4, 141), "y": np.linspace(-2.5, 2.5, 101)}
density = ns.invariant_density(scene, points=points)
print(density)

panels = ns.plot(density)
for wall in (-1, 1):
    panels["density_x"].axvline(wall, color="0.7", linestyle=":")
plt.show()
