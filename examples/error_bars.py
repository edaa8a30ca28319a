"""
Error bars that hold
====================

Twenty Monte Carlo estimates of the same number, each with seeds of its own, and the number itself,
which a formula gives to fourteen digits. A bar is the standard error and the bias of the time step
together, so that two thirds or more should contain the number.
"""

import matplotlib.pyplot as plt

import nonsmooth as ns

scene = ns.Scene("friction")
exact = ns.asymptotic_variance(scene)
sampled = {
    seed: ns.asymptotic_variance(scene, tol=0.1, method="monte_carlo", seed=seed)
    for seed in range(20)
}
panel = ns.plot(sampled)["value"]
panel.axhline(exact.value, color="black", linewidth=0.8)
panel.set_xlabel("seed")
plt.show()

inside = sum(abs(one.value - exact.value) <= one.error for one in sampled.values())
print(f"{inside} of {len(sampled)} bars contain {exact}")
