"""Time-stepping schemes, one file each, and the table of what they promise.

A scheme is the coefficients of a step (a NamedTuple that `coefficients(scene, step, precision)`
returns) and two kernels over the lanes of a panel. N steps are

    flow  kick  flow  kick  flow ... kick  flow

with N kicks, so that a splitting can merge what neighbouring steps share; `flow` is told whether
it is the first or the last. Every NamedTuple has `step`; `normals`, how many normal numbers a step
takes; and `transition` and `factor`, the Gaussian step whose increments march_pair joins.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType

from nonsmooth.errors import SceneError
from nonsmooth.paths.schemes import drift_implicit, dry_friction, euler_maruyama, lie, strang


@dataclass(frozen=True)
class Scheme:
    """What a scheme promises.

    Attributes
    ----------
    module : module
    smooth_order, kink_order : float
        Weak order where the drift is smooth and across the kink of the friction law.
    longest_step : callable
        Of a scene: the step up to which the scheme is stable for every n, inf if at every step.
    handles : callable
        Whether the scheme can simulate a scene.
    coupled : bool
        Whether steps of different length can share their noise.
    """

    module: ModuleType
    smooth_order: float
    kink_order: float
    longest_step: Callable = lambda scene: math.inf
    handles: Callable = lambda scene: True
    coupled: bool = True

    def weak_order(self, scene):
        """Weak order for a scene: the kink of dry friction may cost half an order."""
        return self.kink_order if scene.mechanics.is_friction else self.smooth_order


SCHEMES = {
    "strang": Scheme(strang, 2.0, 1.5, longest_step=strang.longest_step, handles=strang.handles),
    "dry_friction": Scheme(dry_friction, 2.0, 2.0, handles=dry_friction.handles, coupled=False),
    "drift_implicit": Scheme(drift_implicit, 1.0, 1.0, handles=drift_implicit.handles),
    # the smooth part is exact but for int g
    "lie": Scheme(lie, 2.0, 1.0, handles=drift_implicit.handles),
    "euler_maruyama": Scheme(
        euler_maruyama,
        1.0,
        1.0,
        longest_step=euler_maruyama.longest_step,
        handles=lambda scene: math.isfinite(scene.n),
    ),
}


def scheme(scene, name="strang"):
    """Return the scheme of that name.

    A scene that the default, the Strang splitting, has no exact flows for is simulated by the
    Euler-Maruyama scheme instead.

    Raises
    ------
    SceneError
        If there is no such scheme or it cannot simulate the scene.
    """
    if name not in SCHEMES:
        raise SceneError(f"unknown scheme {name!r}; choose from {', '.join(SCHEMES)}")
    if not SCHEMES[_able(scene, name)].handles(scene):
        cure = "choose 'strang'" if strang.handles(scene) else "choose a finite n and 'strang'"
        raise SceneError(f"the scheme {name!r} cannot simulate this scene; {cure}")
    name = _able(scene, name)
    return SCHEMES[name]


def _able(scene, name):
    return name if name != "strang" or strang.handles(scene) else "euler_maruyama"


def coefficients(scene, name, step, precision="float32", control=None):
    """Return the coefficients of a step, with a control variate if there is a `PoissonSlope`.

    Raises
    ------
    SceneError
        If the scheme cannot simulate the scene, or not with such a step.
    """
    chosen, name = scheme(scene, name), _able(scene, name)
    if not step < _longest_step(name, scene):
        raise SceneError(
            f"the scheme {name!r} is unstable with step = {step:g}; "
            f"choose one below {_longest_step(name, scene):.2g}"
        )
    s = chosen.module.coefficients(scene, step, precision)
    if control is None or "control" not in s._fields:
        return s
    number = type(s.step)
    polynomial = control.polynomial(float(s.factor[0]))
    return s._replace(
        controlled=True,
        reach=number(control.reach),
        control=tuple(map(number, polynomial)),
    )


@lru_cache(maxsize=256)
def _longest_step(name, scene):
    return SCHEMES[name].longest_step(scene)


def on_given_increments(s):
    """Return the coefficients for increments that are not standard normal but to scale."""
    one, zero = type(s.step)(1), type(s.step)(0)
    return s._replace(factor=(one, zero, one))
