"""
A model of one's own: a dead zone
=================================

A mass moves freely between two springs and touches one of them only when its displacement exceeds
a gap, like a shaft with play in its bearing. The library does not know this model. It is made here
as one object of the class ``Model``; nothing else is needed.
"""

import matplotlib.pyplot as plt
import numpy as np
import sympy

import nonsmooth as ns
from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.penalties import Penalty
from nonsmooth.scenes.symbols import x, y


# %%
# The penalty is an even function of the displacement whose derivative, the force, is piecewise
# linear: its slope is 0 up to the gap and the spring's stiffness beyond. It does not depend on n.
# The force reads x and stands in the equation of y.
def dead_zone(gap=0.5, stiffness=4.0):
    """Return the model of a mass between two springs that it touches beyond a gap.

    Parameters
    ----------
    gap, stiffness : float
        Distance of the springs from the origin and their stiffness, "1".

    Returns
    -------
    Model
    """
    spring = Penalty(
        name="d",
        limit=r"d\left(%s\right)",
        knot=sympy.Float(gap),
        inner=sympy.Integer(0),
        outer=sympy.Float(stiffness),
    )
    return Model(
        name=f"dead_zone(gap={gap}, stiffness={stiffness})",
        title="Dead zone",
        inequality="SVI-2",
        penalty=spring,
        argument=x,
        equation=y,
        force_name="spring_force",
    )


def main():
    """Print gamma^2 of the displacement and of the force, and plot v(0, tau)/tau of the former."""
    displacement = ns.Scene(dead_zone(), observable="x")
    force = ns.Scene(dead_zone(), observable="spring_force")
    print("gamma^2 of the displacement:", ns.asymptotic_variance(displacement, tol=1e-5).value)
    print("gamma^2 of the force, which is 1:", ns.asymptotic_variance(force, tol=1e-5).value)

    times = np.linspace(0.25, 20, 80)
    exact = ns.variance(displacement, times, tol=1e-4)
    sampled = ns.simulate(displacement, 20.0, step=0.02, paths=20_000, seed=1, times=times[3::8])
    _, panel = plt.subplots(figsize=(5, 3.2), layout="constrained")
    panel.plot(times, exact["v"] / times, label="on grids")
    panel.errorbar(
        sampled["time"],
        sampled["variance"] / sampled["time"],
        3 * sampled["variance_error"] / sampled["time"],
        fmt=".",
        label="Monte Carlo, three standard errors",
    )
    panel.set(xlabel=r"$\tau$", ylabel=r"$v(0, \tau)/\tau$")
    panel.legend()
    plt.show()


if __name__ == "__main__":
    main()
