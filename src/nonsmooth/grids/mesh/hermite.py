"""Polynomials of a variable that is normal by itself, on Gauss nodes of its normal law.

The variable of a linear noise in whose equation dW stands forgets by its own diffusion. Solutions
are smooth in it, and the generator takes polynomials to polynomials. A few nodes then do what
takes many elements, and no box ends anywhere.
"""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from numpy.polynomial.hermite_e import hermevander
from scipy.special import factorial, roots_hermitenorm
from sympy import Symbol

from nonsmooth.grids.elements import Axis
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta


def deviation(scene: Scene, symbol: Symbol) -> float | None:
    """Return the standard deviation of a variable that dW drives, if solutions are smooth in it.

    Parameters
    ----------
    scene : Scene
    symbol : sympy.Symbol

    Returns
    -------
    float or None
        None for another variable, or if its own restoring force is not linear, or if it is the
        forcing of dry friction. Friction holds the oscillator until the forcing exceeds it, which
        makes a kink.
    """
    noise = scene.noise
    if symbol != noise.driven or symbol not in noise.drift:
        return None
    if symbol == eta and scene.mechanics.is_friction:
        return None
    restoring = -noise.drift[symbol].diff(symbol)
    if restoring.free_symbols or not restoring > 0:
        return None
    return float(noise.sigma / np.sqrt(2 * float(restoring)))


def hermite(count: int, deviation: float, end: float) -> Axis:
    """Make an axis of all polynomials below a degree.

    Parameters
    ----------
    count : int
        Number of nodes, and of polynomials.
    deviation : float
        Standard deviation of the normal law.
    end : float
        Half width within which functions are interpolated; at least up to the last node.

    Returns
    -------
    Axis
        One element without faces. Its weights are those of the mean in the normal law.
    """
    nodes, weights, slope = _gauss(count)
    nodes, slope = deviation * nodes, slope / deviation
    end = max(end, nodes[-1])
    none = sp.csr_array((0, count))
    return Axis(
        np.array([-end, end]),
        (nodes / end,),
        nodes,
        weights,
        sp.csr_array(slope),
        sp.csr_array(slope @ slope),
        sp.csr_array((count, count)),
        np.empty(0),
        none,
        none.T.tocsr(),
        none.T.tocsr(),
        deviation,
    )


@lru_cache(maxsize=64)
def _gauss(count):
    """Gauss nodes and weights of the standard normal law, and the matrix of the derivative."""
    nodes, weights = roots_hermitenorm(count)
    nodes = (nodes - nodes[::-1]) / 2  # symmetric beyond rounding
    weights = weights / weights.sum()
    degrees = np.arange(count)
    values = hermevander(nodes, count - 1) / np.sqrt(factorial(degrees))
    lowered = np.diag(np.sqrt(degrees[1:]), 1)  # normalised, He_k' = sqrt(k) He_(k-1)
    return nodes, weights, values @ lowered @ (weights[:, None] * values).T
