"""
Which method for which tolerance
================================

Give a tolerance, and the method follows: sampling for a few per cent, solving for more digits. An
estimate tells what has found it, and how long that took.
"""

import matplotlib.pyplot as plt

import nonsmooth as ns

stop = ns.Scene("obstacle", potential="x**2/2")  # g = x: two variables matter
found = {f"{tol:g}": ns.asymptotic_variance(stop, tol) for tol in (0.3, 1e-2, 1e-4, 1e-6)}
for tol, estimate in found.items():
    print(f"tol = {tol}: {estimate}")

ns.plot(found)["value"].set_xlabel("relative tolerance")
plt.show()

# %%
# A method may also be chosen. What it cannot meet is refused, and what it has reached is the
# ``result`` of the error.

try:
    ns.asymptotic_variance(stop, tol=1e-5, method="monte_carlo")
except ns.NonsmoothError as refused:
    print(refused)
    print("reached:", refused.result)
