"""
A model of one's own: a dead zone
=================================

A mass moves freely between two springs and touches one of them only beyond a gap, like a shaft with
play in its bearing. The library does not know this model. A model is one object: a penalty, whose
force is linear between its kinks, and the equation in which it stands. The dashed line is solved.
"""

import matplotlib.pyplot as plt
import numpy as np
import sympy

import nonsmooth as ns
from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.penalties import Penalty
from nonsmooth.scenes.symbols import x, y


def dead_zone(gap=0.5, stiffness=4.0):
    """Return the model: no force up to the gap, then springs; the force reads x and moves y."""
    knot, outer = sympy.Float(gap), sympy.Float(stiffness)
    spring = Penalty("d", r"d\left(%s\right)", knot, inner=sympy.Integer(0), outer=outer)
    name = f"dead_zone(gap={gap}, stiffness={stiffness})"
    return Model(name, "Dead zone", "SVI-2", spring, x, y, force_name="spring_force")


if __name__ == "__main__":
    force = ns.Scene(dead_zone(), observable="spring_force")
    print("gamma^2 of the force, which is 1:", ns.asymptotic_variance(force, tol=1e-5))

    scene = ns.Scene(dead_zone(), observable="x")
    times = np.linspace(0.5, 10, 39)
    run = ns.simulate(scene, 10, step=0.02, paths=4000, seed=1, times=times)
    panel = ns.plot(run[["variance", "variance_error"]])["variance"]
    panel.plot(times, ns.variance(scene, times, tol=1e-4)["v"], "k--")  # by grids
    plt.show()
