"""
Paths, and what n does
======================

One path of each model with the penalization n = 2, with n = 100, and in the non-smooth limit
n = inf, all driven by the same noise. With a larger n the model yields, slips or rebounds more
sharply. In the limit the displacement of the first and the third model never leaves [-1, 1].
"""

import matplotlib.pyplot as plt
import numpy as np

import nonsmooth as ns

TIMES = np.linspace(0, 20, 1001)[1:]
MODELS = {"elasto_plastic": ("x", 0.1), "friction": ("y", 1.0), "obstacle": ("x", 1.0)}
LOOKS = {2: ("#D55E00", "--"), 100: ("#0072B2", "-"), float("inf"): ("black", "-")}

figure, axes = plt.subplots(3, 1, figsize=(7, 6), sharex=True, layout="constrained")
for axis, (model, (variable, damping)) in zip(axes, MODELS.items(), strict=True):
    for n, (colour, dashes) in LOOKS.items():
        # what is kept is the scene's state: with g = x the displacement is part of it
        scene = ns.Scene(
            model,
            n=n,
            damping=damping,
            potential="0" if model == "friction" else "x**2/2",
            observable=variable,
        )
        paths = ns.simulate(scene, 20, step=0.005, paths=1, seed=3, times=TIMES, keep="paths")
        look = {"color": colour, "linestyle": dashes, "linewidth": 0.9, "label": f"n = {n:g}"}
        axis.plot(paths["time"], paths[variable].squeeze(), **look)
    axis.set(ylabel=variable, title=model)
figure.legend(*axes[0].get_legend_handles_labels(), ncols=3, loc="outside lower center")
axes[-1].set(xlabel="time")
plt.show()
