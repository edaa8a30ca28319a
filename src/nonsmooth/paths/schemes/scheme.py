"""What a time-stepping scheme is, and how to add one."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from nonsmooth.scenes.scene import Scene


class Coefficients(Protocol):
    """What kernels know of a scene, a step and a precision: a NamedTuple of numbers.

    Every scheme has a NamedTuple of its own, by whose type the time loop finds its kernels. It
    has the fields below and whatever else the kernels need. Floating-point numbers are in the
    precision of the simulation, as the kernels calculate in it.

    Attributes
    ----------
    step : float
        Time step h.
    normals : {1, 2, 4}
        How many normal numbers a path takes in a step.
    transition : (float, float, float, float)
        Exact linear part of the noise less the identity, row by row.
    factor : (float, float, float)
        Cholesky factor of the noise's covariance, its lower triangle. The noise (r, s) of a step
        becomes (r, s) + transition (r, s) + factor (first normal number, second normal number). By
        this rule the increments of two steps are joined to that of one twice as long. If a step
        adds Gaussian increments and nothing else to its state, `transition` is zero, and `factor`
        is (sigma sqrt(h), 0, 0). Kernels multiply their normal numbers by `factor` and by nothing
        else: joined increments come with the factor 1.
    """

    step: Any
    normals: int
    transition: tuple
    factor: tuple


def _unlimited(scene):
    return math.inf


def _every(scene):
    return True


def _none(scene):
    return False


@dataclass(frozen=True, eq=False)
class Scheme:
    """A time-stepping scheme: its step, as two compiled kernels, and what it promises.

    N steps are

        flow  kick  flow  kick  flow ... kick  flow

    with N kicks. The noise is in the kicks. A splitting X(h/2) N(h) X(h/2) puts X into the flows,
    so that two half-flows in a row become one; other schemes have an empty flow and do everything
    in the kick. The kernels advance many paths at once, one in each column, a lane, of the array
    `data`; its rows are described in `kernels.panel`.

    How to add one: write a module with a NamedTuple, a function `coefficients` and the kernels
    `flow` and `kick`, make an instance of this class, and add it to `registry.SCHEMES`. The page
    `docs/how_to/add_a_scheme.md` has a short one. `tests/nonsmooth/paths/test_schemes.py` measures
    whether every registered scheme keeps its promises.

    Attributes
    ----------
    name : str
        What `simulate(scheme=...)` calls it.
    kind : type
        The NamedTuple of its coefficients, see `Coefficients`.
    coefficients : callable
        (scene, step, precision) -> `kind`. It is called for every step length, so that it should
        keep its results (`functools.lru_cache`).
    flow : kernel
        (s, data, first, last, lanes) -> None, s the coefficients: what happens between two kicks.
        `first` is true before the first kick, and `last` after the last one.
    kick : kernel
        (s, data, normal, lanes) -> None: one step with the normal numbers in the rows `normal`,
        `normal + 1`, ... It adds to the row GAIN what the step contributes to int g; flows may have
        added their part before. It ends with `panel.observe`, which empties the row.
    smooth_order, kink_order : float
        Weak order q where the drift is smooth, and across the kink of a friction law: moments of
        int g are off by c h^q for short steps. Halving a step thus shows the bias, which is the
        change over 1 - 2^-q.
    longest_step : callable
        Scene -> step below which the scheme is stable, inf if it is at every step.
    handles : callable
        Scene -> whether the scheme can simulate it.
    gains_in_kicks : callable
        Scene -> whether flows add nothing to int g, so that it is complete after a kick. Half-flows
        on both sides of an output time are then one flow, which is faster.
    shares_noise : bool
        Whether `transition` and `factor` join the increments of two steps. If not, the bias of the
        step is measured with independent paths, which takes many more of them.
    """

    name: str
    kind: type
    coefficients: Callable[[Scene, float, str], Any]
    flow: Callable
    kick: Callable
    smooth_order: float
    kink_order: float
    longest_step: Callable[[Scene], float] = _unlimited
    handles: Callable[[Scene], bool] = _every
    gains_in_kicks: Callable[[Scene], bool] = _none
    shares_noise: bool = True

    def weak_order(self, scene: Scene) -> float:
        """Weak order for a scene: the kink of a friction law may cost half an order."""
        return self.kink_order if scene.mechanics.is_friction else self.smooth_order
