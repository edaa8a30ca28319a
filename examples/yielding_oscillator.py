r"""
How fast permanent deformation spreads
======================================

The plastic deformation of a yielding oscillator is the integral of the plastic strain rate. Over
long times it spreads like a Brownian motion with the variance :math:`\gamma^2 t`. Here
:math:`\gamma^2` is found from the Poisson equation, for several dampings, and compared with the
slope of the variance over many simulated paths.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

scenes = {
    damping: ns.Scene(
        "elasto_plastic", damping=damping, potential="x**2/2", observable="plastic_strain_rate"
    )
    for damping in (0.25, 0.5, 1.0, 2.0)
}
solved = {damping: ns.asymptotic_variance(scene, tol=1e-4) for damping, scene in scenes.items()}
ns.plot(solved)["value"].set(xlabel="damping", ylabel=r"$\gamma^2$")
plt.show()

# %%
# The variance of the deformation itself, by Monte Carlo with its standard error, and the straight
# line of slope :math:`\gamma^2` that it approaches.

times = np.linspace(1, 40, 40)
run = ns.simulate(scenes[0.5], horizon=40, step=0.05, paths=4000, times=times, seed=1)
panel = ns.plot(run[["variance", "variance_error"]])["variance"]
offset = float(run["variance"][-1]) - solved[0.5].value * times[-1]
panel.plot(times, solved[0.5].value * times + offset, "k--")
plt.show()
