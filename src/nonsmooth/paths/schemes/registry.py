"""The schemes that a simulation may call by their names, and the steps they make."""

from functools import lru_cache
from typing import Any

from nonsmooth.checks import require_choice
from nonsmooth.errors import SceneError, quoted
from nonsmooth.paths.control_variate import PoissonSlope
from nonsmooth.paths.schemes.drift_implicit import DRIFT_IMPLICIT
from nonsmooth.paths.schemes.dry_friction import DRY_FRICTION
from nonsmooth.paths.schemes.euler_maruyama import EULER_MARUYAMA
from nonsmooth.paths.schemes.lie import LIE
from nonsmooth.paths.schemes.scheme import Scheme
from nonsmooth.paths.schemes.strang import STRANG
from nonsmooth.scenes.scene import Scene

SCHEMES: dict[str, Scheme] = {
    scheme.name: scheme for scheme in (STRANG, DRY_FRICTION, DRIFT_IMPLICIT, LIE, EULER_MARUYAMA)
}


def scheme(scene: Scene, name: str = "strang") -> Scheme:
    """Return the scheme of that name.

    A scene that the default, the Strang splitting, has no exact flows for is simulated by the
    Euler-Maruyama scheme instead.

    Raises
    ------
    SceneError
        If there is no such scheme or it cannot simulate the scene.
    """
    chosen = SCHEMES[require_choice("scheme", name, SCHEMES)]
    if chosen is STRANG and not STRANG.handles(scene):
        chosen = EULER_MARUYAMA
    if not chosen.handles(scene):
        cure = "choose 'strang'" if STRANG.handles(scene) else "choose a finite n and 'strang'"
        raise SceneError(f"the scheme {name!r} cannot simulate this scene; {cure}")
    return chosen


def of_coefficients(kind: type) -> Scheme:
    """Return the scheme whose coefficients are of a type; the time loop finds its kernels so."""
    return next(scheme for scheme in SCHEMES.values() if scheme.kind is kind)


def coefficients(
    scene: Scene,
    name: str,
    step: float,
    precision: str = "float32",
    control: PoissonSlope | None = None,
) -> Any:
    """Return the coefficients of a step, with a control variate if one is given.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the scheme.
    step : float
    precision : {"float32", "float64"}
    control : PoissonSlope, optional
        Ignored by schemes that have no control variate.

    Returns
    -------
    NamedTuple
        See `scheme.Coefficients`.

    Raises
    ------
    SceneError
        If the scheme cannot simulate the scene, or not with such a step.
    """
    chosen = scheme(scene, name)
    if not step < (longest := longest_step(scene, name)):
        raise SceneError(
            f"the scheme {chosen.name!r} is unstable with step = {step:g}; "
            f"choose one below {longest:.2g}"
        )
    s = chosen.coefficients(scene, step, precision)
    if control is None or "control" not in s._fields:
        return s
    number = type(s.step)
    below, above = control.polynomials(float(s.factor[0]))
    return s._replace(
        controlled=True,
        reach=number(control.reach),
        control=(tuple(map(number, below)), tuple(map(number, above))),
    )


def longest_step(scene: Scene, name: str = "strang") -> float:
    """Return the step below which a scheme is stable.

    Raises
    ------
    SceneError
        If the scheme cannot simulate the scene, or there is no such step, because a force is
        infinite somewhere.
    """
    longest = _longest_step(scheme(scene, name), scene)
    if longest == 0:
        raise SceneError(
            f"no time step resolves the potential {quoted(scene.potential)} or that of the noise, "
            "which bends infinitely somewhere; choose one without poles"
        )
    return longest


@lru_cache(maxsize=256)
def _longest_step(chosen, scene):
    return chosen.longest_step(scene)


def on_given_increments(s: Any) -> Any:
    """Return the coefficients of a scheme that is given the noise itself, not normal numbers."""
    one, zero = type(s.step)(1), type(s.step)(0)
    return s._replace(factor=(one, zero, one))
