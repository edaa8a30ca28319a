r"""
The asymptotic formula, corrected
=================================

The probability of a crossing tends to :math:`W_*(b/\gamma, T)` as p grows. The limit is off by
:math:`O(p^{-1/2})`, because a Brownian motion turns back at every instant and the integral of g
does not. If the threshold is moved outwards by :math:`\kappa/\sqrt p`, the error becomes
:math:`O(1/p)`. Two further orders are known. The figure shows the errors of these formulas against
the exact probability.
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
