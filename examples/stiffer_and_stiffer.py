r"""
From the penalty to the non-smooth limit
========================================

Dry friction acts by its sign. The model replaces it by a force that is linear for
:math:`|y| \le 1/n`. How large has n to be? At n = inf the non-smooth system itself is solved.
"""

import matplotlib.pyplot as plt

import nonsmooth as ns

scene = ns.Scene("friction")
found = {n: ns.asymptotic_variance(scene.with_n(n)) for n in (1, 2, 5, 10, 20, 50, 100, 200)}
limit = ns.asymptotic_variance(scene.with_n(float("inf")))
panel = ns.plot(found)["value"]
panel.axhline(limit.value, color="black", linestyle="--", linewidth=0.8)
panel.set(xscale="log", xlabel="n", ylabel=r"$\gamma^2$")
plt.show()

# %%
# The distance to the limit falls like :math:`n^{-2}`.

for n in (10, 100):
    off = found[n].value - limit.value
    print(f"n = {n}: {found[n]}, off by {off:.2e} = {off * n**2:.3f}/n^2")
