"""The mean time of the first passage, from its Laplace transform near 0.

With F(z) = E exp(-z tau), the function (1 - F(z)) / z is analytic around 0 up to the leading pole
of F on the negative axis, and its value at 0 is E tau. That is the mean over a circle around 0, on
which nothing cancels; the trapezoidal rule on it converges geometrically.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from nonsmooth.crossing.first_passage import plane
from nonsmooth.crossing.first_passage import tuning as passage_tuning
from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.first_passage.line import Intervals
from nonsmooth.crossing.first_passage.plane import PlaneProblem
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line.potential import depth
from nonsmooth.refine import until_agreement
from nonsmooth.reliability import tuning
from nonsmooth.scenes.scene import Scene


def applies(scene: Scene) -> bool:
    """Whether the transform of the scene's passage times can be computed."""
    if scene.is_line:
        return float(depth(scene)(scene.start.get("y", 0.0))) <= passage_tuning.FAR_START.depth
    return plane.applies(scene)


def default_tolerance(scene: Scene) -> float:
    """Return the relative tolerance of `transformed_mean` unless given."""
    settings = tuning.TRANSFORMED_MEAN
    return settings.line_tolerance if scene.is_line else settings.plane_tolerance


def transformed_mean(scene: Scene, lower: float, upper: float, tol: float) -> tuple[float, float]:
    """E tau, tau the first time at which int g leaves (lower, upper).

    Parameters
    ----------
    scene : Scene
        To which this module `applies`.
    lower, upper : float
        lower < 0 < upper.
    tol : float
        Relative error wanted.

    Returns
    -------
    value, error : float

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met, with the best as its result.
    """
    if not applies(scene):
        raise SceneError(
            "the mean time is solved for the state (y) and white noise near its start, or for two "
            "state variables with finite n, odd g and drift, and white or Langevin noise; use "
            "method='monte_carlo'"
        )
    try:
        solve = _on_line if scene.is_line else _in_plane
        value, error = solve(scene, lower, upper, tol)
    except (np.linalg.LinAlgError, RuntimeError) as refused:
        raise ToleranceError(
            f"the transform is not finite ({refused}); use method='monte_carlo'"
        ) from None
    if not error <= tol * value:
        raise ToleranceError(
            f"the mean time {value:.7g} has an error of {error:.1e}, above tol = {tol:g} relative; "
            "loosen tol, or use method='monte_carlo'",
            (value, error),
        )
    return value, error


def _on_line(scene, lower, upper, tol):
    (problem,) = Intervals(scene, [(lower, upper)]).problems
    mean = _rough(lambda z: problem.coarse_transform(z, 1.0), 1 / scene.damping)
    times = np.array([min(mean, 1 / scene.damping), mean]) * tuning.TRANSFORMED_MEAN.times

    own = _amplified(problem, mean)

    def solve(level):
        return _at_zero(problem.transform(level.resolution, times, 1.0), mean, own)

    def error(solutions):
        changes = [abs(a - b) for (a, _), (b, _) in pairwise(solutions)]
        kept = tuning.TRANSFORMED_MEAN.kept
        change = passage_tuning.REFINEMENT.safety * max(
            size * kept ** (len(changes) - 1 - k) for k, size in enumerate(changes)
        )
        return change + solutions[-1][1] + own

    found = until_agreement(
        problem.settings.levels, solve, error, lambda found, error: error <= tol * found[0]
    )
    return float(found.value[0]), float(found.error)


def _in_plane(scene, lower, upper, tol):
    def coarse(z):
        return PlaneProblem(scene, lower, upper, np.array([1 / z])).coarse_transform(z, 1.0)

    mean = _rough(coarse, 1 / scene.damping)
    times = mean * np.array(tuning.TRANSFORMED_MEAN.times)
    problem = PlaneProblem(scene, lower, upper, times)
    seen = _amplified(problem, mean)

    def solve(resolution, count):
        found = _at_zero(problem.transform(resolution, times, 0.0), mean, seen)
        return np.array(found)[:, None] / mean

    def stated(found):
        return found.change[0, 0] + abs(found.value[1, 0]) + seen / mean

    found = refine_each_part(
        problem.resolutions[:3],
        solve,
        lambda found: stated(found) <= tol * found.value[0, 0],
        tol,
    )
    return float(mean * found.value[0, 0]), float(mean * stated(found))


def _rough(transform_for, time):
    """Estimate the mean to some ten per cent: that of the lesser of tau and a long random time."""
    settings = tuning.TRANSFORMED_MEAN

    def lesser(z):
        return (1 - transform_for(z)(z)).real / z

    z = 1 / time
    for _ in range(settings.searches):
        mean = lesser(z)
        if mean * z >= settings.small:
            z *= settings.small / 2 / (mean * z)
        elif lesser(z * settings.later) < (1 + 2 * settings.small) * mean:
            return mean
        else:  # few paths take much longer than the others
            z *= settings.later
    raise ToleranceError(
        f"no mean time is found, it is above {settings.small / z:.1e}; choose nearer thresholds"
    )


def _amplified(problem, mean):
    """Return what the error of F that no level shows becomes on the smallest circle."""
    return problem.settings.unseen_error * mean / min(tuning.TRANSFORMED_MEAN.radii)


def _at_zero(transform: Callable, mean: float, unseen: float) -> tuple[float, float]:
    """Average (1 - F(z)) / z over the largest circle that agrees with the smallest one.

    A pole inside of a circle changes the average. That the smallest has none is seen at its
    leftmost point: F(-r) = E exp(r tau) is at least 1 + r E tau where it converges.
    """
    settings = tuning.TRANSFORMED_MEAN
    half = np.exp(1j * np.pi * (np.arange(settings.nodes) + 0.5) / settings.nodes)

    def average(radius):  # the values at the conjugate nodes are conjugate
        values = np.array([((1 - transform(z)) / z).real for z in radius / mean * half])
        # a third of the nodes is a rule, too, with a larger error
        return values.mean(), abs(values.mean() - values[1::3].mean())

    *larger, smallest = settings.radii
    known, spread = average(smallest)
    agreement, radius = settings.agreement * unseen, smallest / mean
    if not transform(-radius).real >= 1 + radius * (known - agreement):
        raise ToleranceError(
            "some passages take very much longer than the mean time, which the transform does not "
            "tell; choose thresholds that are less unequal, or use method='monte_carlo'"
        )
    for radius in larger:
        value, own = average(radius)
        if own + abs(value - known) <= agreement:
            return value, own + abs(value - known)
    return known, spread + agreement
