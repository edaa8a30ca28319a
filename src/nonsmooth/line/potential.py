"""The invariant density of a scene with one state variable, m = exp(-Phi) / Z."""

from collections.abc import Callable
from functools import lru_cache

import sympy

from nonsmooth.errors import SceneError
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


@lru_cache(maxsize=64)
def potential(scene: Scene) -> tuple[sympy.Expr, float]:
    """Return Phi, minus the logarithm of the invariant density up to a constant, and its kink.

    Phi is 2 / sigma^2 times the integral of the restoring force, C_b y^2/2 plus the penalty's
    potential. Its minimum is Phi(0) = 0.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    potential : sympy.Expr
        In y.
    knot : float
        Phi has kinks at -knot and knot and is smooth elsewhere. 0 if it has no kink, and at
        n = inf, where the kink is at 0.

    Raises
    ------
    SceneError
        If the scene's state is not y alone or its noise is not white.
    """
    if not scene.is_line:
        raise SceneError(
            f"no deterministic solver for the state ({', '.join(scene.state)}) with "
            f"{scene.noise.title}; use simulate, which takes every scene"
        )
    y, penalty = symbols.y, scene.mechanics.penalty
    energy, knot = scene.damping * y**2 / 2, 0.0
    if scene.mechanics.is_friction:
        knot, _, _ = penalty.at(scene.n)
        energy += penalty.potential_at(y, scene.n)
    return 2 * energy / scene.noise.sigma**2, knot


def depth(scene: Scene) -> Callable:
    """Return Phi of `potential` as a function of arrays.

    Its values are called depths: how far a point lies in the tails of the invariant density, as
    the logarithm of the largest density over the density there.
    """
    return vectorised(potential(scene)[0], (symbols.y,))
