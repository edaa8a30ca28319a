r"""
A first number
==============

A mass slides under dry friction and white noise. How fast does the variance of the distance grow?
Over a long time t it is :math:`\gamma^2 t`.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

scene = ns.Scene("friction")  # white noise, damping 1, g = y, n = 100
gamma2 = ns.asymptotic_variance(scene)
print(gamma2)

# %%
# Before that, it grows more slowly. The dashed line has the slope :math:`\gamma^2`.

v = ns.variance(scene, np.linspace(0, 10, 101))
panel = ns.plot(v[["v", "v_error"]])["v"]
panel.plot(v["time"], gamma2.value * v["time"], "k--")
plt.show()

# %%
# A notebook shows a scene by its equations.

scene
