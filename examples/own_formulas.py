"""
A potential, a noise and an observable of one's own
===================================================

All three are formulas. Here a mass between two walls has two wells, the noise is that of a
nonlinear filter, and what is asked for is the time that the mass spends on the right, less a half.
"""

import matplotlib.pyplot as plt

import nonsmooth as ns

noise = ns.Langevin("eta**4/4 + eta**2/2", sigma=1.5)
scene = ns.Scene(
    "obstacle", noise, potential="x**4 - x**2", damping=0.5, observable="sign(x)/2", n=50
)
print(scene.state)  # the variables that determine the law of g

run = ns.simulate(scene, 100, step=0.02, paths=3, seed=4, keep="paths")
ns.plot(run[["eta", "x", "delta"]].isel(path=[0]))
plt.show()

# %%
# What is written wrong is told in one line.

try:
    ns.Scene("obstacle", noise, potential="x^4 - x^2")
except ns.NonsmoothError as mistake:
    print(mistake)

run = ns.simulate(scene, 100, step=0.02, paths=2000, seed=4)
print("variance of the excess after 100:", float(run["variance"][-1]))
