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

scene = ns.Scene("obstacle", noise="white", n=100, potential="x**2/2 - x**4/8", observable="x")
points = {"x": np.linspace(-1.4, 1.4, 141), "y": np.linspace(-2.5, 2.5, 101)}
density = ns.invariant_density(scene, points=points)
print(density)

figure, (left, right) = plt.subplots(1, 2, figsize=(7.5, 3.2), layout="constrained")
colours = left.contourf(density["x"], density["y"], density["density_y_x"], 12, cmap="viridis")
figure.colorbar(colours, ax=left)
left.set(xlabel="x", ylabel="y", title="joint density")
right.plot(density["x"], density["density_x"], color="black")
for wall in (-1, 1):
    right.axvline(wall, color="0.7", linestyle=":")
right.set(xlabel="x", ylabel="density", title="displacement")
plt.show()
