r"""
How likely it has slid too far
==============================

A mass under dry friction and white noise slides. With which probability has it been at the
distance :math:`b\sqrt p` from its start before the time :math:`pT`? The answer is found without
Monte Carlo, then by Monte Carlo with its error, and compared with the limit :math:`p \to \infty`.
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

scene = ns.Scene("friction", n=100)
horizons = np.linspace(0.5, 10, 39)
solved = ns.crossing_probability(scene, threshold=0.6, horizons=horizons, p=10)
sampled = ns.crossing_probability(scene, 0.6, horizons, p=10, paths=20_000, step=0.02, seed=1)
limit = ns.crossing_probability(scene, 0.6, horizons, p=10, method="asymptotic")

ns.plot({"deterministic": solved, "Monte Carlo": sampled, "the limit, and its error": limit})
plt.show()

# %%
# Every value comes with its error. That of the deterministic method is estimated by comparing two
# resolutions.

for k in (6, 22, 38):
    print(
        f"T = {horizons[k]:4.1f}: {float(solved['probability'][k]):.8f} "
        f"+- {float(solved['probability_error'][k]):.0e}, Monte Carlo "
        f"{float(sampled['probability'][k]):.3f} +- {float(sampled['probability_error'][k]):.3f}"
    )
