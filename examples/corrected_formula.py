r"""
The asymptotic formula, corrected
=================================

The limit :math:`W_*(b/\gamma, T)` is off by :math:`O(p^{-1/2})`, because the integral of g does not
reverse at every instant, as a Brownian motion does. Moving the threshold outwards by
:math:`\kappa/\sqrt p` makes this :math:`O(1/p)`, and two more orders are known. The errors
against the exact probability:
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

scene = ns.Scene("friction", n=100)
print("gamma^2 =", ns.asymptotic_variance(scene))
print("kappa   =", ns.extrapolation_length(scene))

scales = np.array([10, 100, 1000])
options = {"asymptotic": {"method": "asymptotic"}} | {
    f"corrected, order {order}": {"method": "corrected", "order": order} for order in (1, 2, 3)
}
off = {name: [] for name in options}
for p in scales:
    exact = ns.crossing_probability(scene, 0.6, [2], p=p, method="deterministic", tol=1e-8)
    for name, method in options.items():
        formula = ns.crossing_probability(scene, 0.6, [2], p=p, **method)
        off[name].append(abs(float((formula["probability"] - exact["probability"])[0])))

figure, axis = plt.subplots(figsize=(6, 3.8), layout="constrained")
for (name, errors), mark in zip(off.items(), "osD^", strict=True):
    axis.loglog(scales, errors, marker=mark, markersize=4, linewidth=1, label=name)
axis.set(xlabel="p", ylabel="error of W at T = 2")
axis.legend(fontsize=8)
plt.show()
