"""The box outside which the invariant density of a scene is too small to matter."""

import math
from collections.abc import Callable, Mapping

import numpy as np
from sympy import Symbol

from nonsmooth.errors import SceneError
from nonsmooth.grids import tuning
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta


def is_known(scene: Scene) -> bool:
    """Whether the invariant density of the noise is known, without which there is no box."""
    return scene.noise.kind in _OF_NOISE


def suits(scene: Scene) -> bool:
    """Whether grids can solve a scene: with the velocity, and noise whose density is known."""
    return y.name in scene.state and is_known(scene)


def half_widths(scene: Scene, depth: float) -> dict[Symbol, float]:
    """Half widths of a box that holds the invariant density; the box may be much too large.

    Those of colored noise come from its own density. Those of the oscillator come from the energy
    that the noise can feed into a damped linear oscillator.

    Parameters
    ----------
    scene : Scene
    depth : float
        Outside, the density is of the order exp(-depth) of its maximum.

    Returns
    -------
    dict
        Maps the symbols of the state to half widths, "1".

    Raises
    ------
    SceneError
        If the invariant density of the noise is not known, or the displacement is not held.
    """
    noise = scene.noise
    if not is_known(scene):
        raise SceneError(
            f"solvers on grids do not know the invariant density of {noise.title}; "
            "use method='monte_carlo' where there is one, or simulate"
        )
    ends = _OF_NOISE[noise.kind](noise, depth)
    power = noise.sigma**2
    if eta in ends:
        # A forcing acts like white noise of the intensity sigma^2 = 2 var(eta) times its relaxation
        # time, or less. If its density is about normal, var(eta) is ends^2 / (2 depth). The factor
        # 4 leaves room for relaxation times above 1.
        power = 4 * ends[eta] ** 2 / depth
    speed = math.sqrt(power * depth / scene.damping)
    if eta in ends:
        speed = min(speed, 2 * ends[eta] / scene.damping)
    ends[y] = speed
    if "x" in scene.state:
        ends[x] = _of_displacement(scene, speed, ends.get(eta, 0.0))
    return ends


def narrowed(
    scene: Scene, ends: Mapping[Symbol, float], found: Mapping[Symbol, float]
) -> dict[Symbol, float]:
    """Replace half widths of the oscillator's variables by what a solution has shown.

    Between walls, the half width of the displacement follows from that of the velocity. Elsewhere
    it is at least what the velocity allows: a coarse solution does not see a well that holds
    little mass.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of all variables, as from `half_widths`.
    found : dict
        Half widths of y and x as seen in a solution.

    Returns
    -------
    dict
        Half widths of all variables.
    """
    ends = {**ends, y: found[y]}
    if x in ends:
        walls = scene.mechanics.argument == x
        allowed = _of_displacement(scene, found[y], ends.get(eta, 0.0))
        ends[x] = allowed if walls else max(allowed, found[x])
    return ends


def _reach():
    """Return the distances at which densities of noises are looked at."""
    return np.linspace(0, tuning.BOX.farthest_noise, tuning.BOX.noise_points)[1:]


def _of_langevin(noise, depth):
    """Half width of eta."""
    reach, v = _reach(), vectorised(noise.potential_expression, (eta,))
    allowed = depth * noise.sigma**2 / 2
    both = np.minimum(v(reach), v(-reach)) - min(v(reach).min(), v(-reach).min(), v(0.0))
    return {eta: _last_below(reach, both, allowed)}


def _of_hamiltonian(noise, depth):
    """Half widths of eta and zeta."""
    search = tuning.BOX
    energy = vectorised(noise.energy, (eta, zeta))
    angle = np.linspace(0, 2 * np.pi, search.rays, endpoint=False)
    radius = _reach()[:: search.ray_stride, None]
    rays = radius * np.cos(angle), radius * np.sin(angle)
    H = energy(*rays)
    near = np.hypot(*rays) < search.near
    dissipation = vectorised(noise.dissipation, (eta, zeta))(*rays)
    weakest = max(np.min(dissipation[near]), search.least_dissipation)
    inside = H - H.min() <= depth * noise.sigma**2 / (2 * weakest)
    return {
        symbol: search.spare * float(np.max(np.abs(ray)[inside], initial=search.least))
        for symbol, ray in zip((eta, zeta), rays, strict=True)
    }


# by the kind of the noise
_OF_NOISE: dict[str, Callable] = {
    "white": lambda noise, depth: {},
    "langevin": _of_langevin,
    "hamiltonian": _of_hamiltonian,
}


def _last_below(reach, values, allowed):
    """Return the largest of increasing distances at which a value is allowed, or the first."""
    below = np.flatnonzero(values <= allowed)
    return float(reach[below[-1]]) if len(below) else float(reach[0])


def _of_displacement(scene, speed, forcing):
    """Half width of the displacement, given those of the velocity and of the forcing."""
    search = tuning.BOX
    kink, _, outer = scene.mechanics.penalty.at(scene.n)
    if scene.mechanics.in_potential and math.isinf(outer):
        return kink
    # the potential energy there is the kinetic energy of the fastest velocity
    reach = np.geomspace(*search.displacements)
    U = vectorised(scene.potential_expression, (x,))
    height, allowed = np.minimum(U(reach), U(-reach)), speed**2 / 2 + forcing
    free = _last_below(reach, height - height.min(), allowed)
    if scene.mechanics.is_plastic:  # farther out the drift leads inward, for every velocity
        return kink + search.spare * min(speed / outer, free)
    if scene.mechanics.in_potential:
        height = height + outer / 2 * np.maximum(reach - kink, 0.0) ** 2
    if height[-1] - height.min() <= allowed:
        raise SceneError(
            f"the potential does not hold the displacement within {reach[-1]:g}; choose one that "
            "rises faster far out, a larger n or Monte Carlo"
        )
    if scene.mechanics.in_potential:
        return min(free, kink + speed / math.sqrt(outer) + forcing / outer)
    return free
