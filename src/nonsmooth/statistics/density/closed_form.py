"""Invariant densities in closed form: dry friction and obstacles with white noise."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.integrate import quad

from nonsmooth.grids.mesh.box import half_widths
from nonsmooth.line import quadrature
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES
from nonsmooth.statistics import tuning


def closed_form(scene: Scene) -> dict[str, Callable]:
    """Marginal densities of the scenes whose variables are independent and known in closed form.

    Returns
    -------
    dict
        Name -> function of points that returns values and errors. A velocity alone with white
        noise has a density by quadrature; obstacles with white noise have the Gibbs measure
        exp(-2 C_b/sigma^2 (y^2/2 + U_n(x))), at n = inf between the walls. The dict is empty for
        all other scenes.
    """
    if scene.is_line:
        return {"y": lambda y: quadrature.density(scene, y)}
    if scene.noise.kind != "white" or not scene.mechanics.in_potential:
        return {}
    inverse = 2 * scene.damping / scene.noise.sigma**2
    U, rigid = scene.potential_expression, math.isinf(scene.n)
    if not rigid:
        U += scene.mechanics.added_potential.subs(penalization, scene.n)
    energy = vectorised(U, (STATE_VARIABLES[-1],))
    end = half_widths(scene, tuning.INVARIANT_DENSITY.deepest)[STATE_VARIABLES[-1]]
    lowest = float(np.min(energy(np.linspace(-end, end, 2001))))
    wall, _, _ = scene.mechanics.penalty.at(scene.n)
    pieces = np.unique([-end, -wall, 0.0, wall, end])

    def shape(x):
        x = np.asarray(x, dtype=float)
        if not rigid:
            return np.exp(-inverse * (energy(x) - lowest))
        held = np.clip(x, -wall, wall)  # beyond, a potential may fall without bound
        return np.where(x == held, np.exp(-inverse * (energy(held) - lowest)), 0.0)

    # with its full output it does not warn of an error that is returned anyway
    parts = [
        quad(shape, *ends, epsabs=0, epsrel=1e-12, limit=200, full_output=True)[:2]
        for ends in pairwise(pieces)
    ]
    total, error = (sum(part) for part in zip(*parts, strict=True))

    def velocity(y):
        value = math.sqrt(inverse / (2 * math.pi)) * np.exp(-inverse * np.square(y) / 2)
        return value, 4 * np.finfo(float).eps * value * (1 + inverse * np.square(y))

    def displacement(x):
        value = shape(x) / total
        depth = inverse * np.abs(energy(np.asarray(x, dtype=float)))
        return value, value * (error / total + 8 * np.finfo(float).eps * (1 + depth))

    return {"y": velocity, "x": displacement}
