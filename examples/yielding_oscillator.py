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


def oscillator(damping):
    """Describe a yielding oscillator under white noise."""
    return ns.Scene(
        "elasto_plastic",
        damping=damping,
        potential="x**2/2",
        observable="plastic_strain_rate",
    )


dampings = [0.25, 0.5, 1.0, 2.0]
solved = [ns.asymptotic_variance(oscillator(c), tol=1e-4) for c in dampings]
for damping, estimate in zip(dampings, solved, strict=True):
    print(f"damping {damping:4}: gamma^2 = {estimate.value:.6f} +- {estimate.error:.0e}")

# %%
# The variance of the deformation itself, by Monte Carlo with two standard errors, and the straight
# line of slope :math:`\gamma^2` that it approaches.

times = np.linspace(1, 40, 40)
run = ns.simulate(oscillator(0.5), horizon=40, step=0.05, paths=4000, times=times, seed=1)
gamma2 = solved[1].value
v, error = run["variance"], 2 * run["variance_error"]
offset = float(v[-1]) - gamma2 * times[-1]

figure, axis = plt.subplots(figsize=(6, 3.5), layout="constrained")
axis.fill_between(times, v - error, v + error, color="#56B4E9", label="Monte Carlo, 2 s.e.")
axis.plot(times, gamma2 * times + offset, "k--", label=r"slope $\gamma^2$")
axis.set(xlabel="t", ylabel="variance of the plastic deformation")
axis.legend()
plt.show()
