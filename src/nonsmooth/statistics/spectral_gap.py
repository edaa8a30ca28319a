"""The spectral gap of the generator, the rate at which correlations decay.

Theorem 5 of the paper says that there is such a rate.
"""

import math
import time
from collections.abc import Callable, Iterable
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.sparse.linalg as spla

from nonsmooth.checks import require_tolerance
from nonsmooth.errors import ToleranceError, answered
from nonsmooth.estimate import Estimate
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.alternating_solver import AlternatingSolver
from nonsmooth.grids.mesh.box_effect import BoxEffect
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid
from nonsmooth.line import eigenfunctions
from nonsmooth.linear_algebra.davidson import slow_rates
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene, require_random, require_velocity
from nonsmooth.statistics import tuning
from nonsmooth.statistics.combined_grids import combined


def spectral_gap(scene: Scene, tol: float | None = None) -> Estimate:
    """Smallest real part of the non-zero eigenvalues of -A_n.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Requested relative error; unless given, it is 1e-6 for one and two state variables, 1e-3 and
        2e-2 for three and four, and what misses that is returned with a warning.

    Returns
    -------
    Estimate
        The error is the difference between two grids, at least a part of the difference before,
        plus the effect of the finite box, plus rounding. From four grids on, the difference is
        multiplied by the square root of the factor by which differences shrink (the larger of the
        last two such factors, at most 1), because errors shrink like differences. With more than
        two variables, or n = inf and two, it is that of `combined_grids.combined`, three times that
        if the tolerance is missed.

    Raises
    ------
    SceneError
        If an argument is out of range, or g is a function of the noise alone.
    ToleranceError
        If `tol` cannot be met; the best value is its `result`.
    """
    began = time.perf_counter()
    require_random(scene)
    require_velocity(scene, "choose one with the velocity, whose gap is at most that of the noise")
    accuracy = require_tolerance(tuning.SPECTRAL_GAP.tol[scene.dimension] if tol is None else tol)
    uniform = scene.is_line or (scene.dimension == 2 and not math.isinf(scene.n))
    gap = _refined if uniform else _combined

    def present(found):
        return Estimate(*found, "spectral elements", time.perf_counter() - began)

    return answered(lambda: gap(scene, accuracy), present, tol_given=tol is not None)


class _Slowest(NamedTuple):
    """The slowest rate on a grid, its error by the iteration and rounding, and its parity."""

    rate: float
    error: float
    parity: int


def _combined(scene, tol):
    """Find the gap and its error, refining each variable as much as it needs."""
    parity = ODD

    def on_grid(scene, grid, accuracy):
        """Compute the gap on a grid, first with the parity that it had on the grid before."""
        nonlocal parity
        try:
            slowest = gap_on(scene, grid, accuracy, parity)
        except (np.linalg.LinAlgError, spla.ArpackError) as unsolved:
            raise ToleranceError(f"the spectral gap was not found on a grid ({unsolved})") from None
        parity = slowest.parity
        return slowest.rate

    found = combined(
        scene,
        tol,
        lambda scene, grid: partial(on_grid, scene, grid),
        lambda value, tol: tol * value,
        first=tuning.SPECTRAL_GAP.first,
    )
    if not found.error <= tol * found.value:
        # grids that miss a layer change less than they are wrong by
        raise _missed(found.value, tuning.SPECTRAL_GAP.unresolved_safety * found.error, tol)
    return float(found.value), float(found.error)


def _missed(value, error, tol):
    return ToleranceError(
        f"the spectral gap {value:.10g} has an error of {error:.1e}, above tol = {tol:g} relative; "
        "loosen tol",
        (value, error),
    )


def _refined(scene, tol):
    """Find the gap and its error, refining all variables until this is met."""
    levels, solve, box = (
        _with_one_variable(scene) if scene.is_line else _with_two_variables(scene, tol)
    )

    # two grids of two variables agree by chance too often
    least = 2 if scene.is_line else tuning.SPECTRAL_GAP.least_grids

    def error(found):
        value, own = found[-1][0], _of_level(found) if len(found) >= least else math.inf
        return own, box(found, own, tol * value) if own <= tol * value else 0.0

    refined = until_agreement(
        levels, solve, error, met=lambda found, error: sum(error) <= tol * found[0]
    )
    (value, _), (own, beyond) = refined.value, refined.error
    if not refined.met:
        # fine grids may lose what coarser ones have found
        found = min(
            (refined.solutions[:count] for count in range(2, len(refined.solutions) + 1)),
            key=_of_unsettled,
        )
        value, reached = found[-1][0], _of_unsettled(found) + beyond
        raise _missed(value, reached, tol)
    return value, own + beyond


def _of_level(found):
    """Return the error of the last of several rates, without that of the box.

    Each rate comes with its rounding error. Errors may change their sign, so that two levels agree
    by chance; a change therefore counts as at least a part of the one before.
    """
    changes = []
    for (coarse, _), (fine, rounding) in pairwise(found):
        least = changes[-1] / tuning.SPECTRAL_GAP.gain if changes else 0.0
        changes.append(max(abs(fine - coarse), rounding, least))
    fall = max((b / a for a, b in pairwise(changes[-3:])), default=1.0)
    if len(changes) < 3:  # one fall may be chance
        fall = 1.0
    return changes[-1] * math.sqrt(min(fall, 1.0)) + found[-1][1]


def _of_unsettled(found):
    """Return the error of the last of several rates that need not have begun to converge."""
    rates = [rate for rate, _ in found]
    return max(abs(fine - coarse) for coarse, fine in pairwise(rates[-3:])) + found[-1][1]


def _with_one_variable(scene):
    """Return the levels, the solver of a level, and the error of the box, which is 0 here."""
    scene = scene.with_start({})  # so that the mesh need not reach out to the starting point

    def solve(degree):
        rates = eigenfunctions.spectrum(scene, degree).rates
        if len(rates) < 2:  # the others are so fast that rounding has removed them
            raise ToleranceError(
                f"the rates of the scene with C_b = {scene.damping:g}, n = {scene.n:g} and sigma = "
                f"{scene.noise.sigma:g} are lost in rounding; choose them closer to 1"
            )
        rate = float(rates[1])
        return rate, rate * tuning.SPECTRAL_GAP.rounding

    return tuning.SPECTRAL_GAP.degrees, solve, lambda found, own, allowed: 0.0


def _with_two_variables(scene: Scene, tol: float) -> tuple[Iterable, Callable, Callable]:
    """Return the levels, the solver of a level, and what measures the error of the box."""
    chosen = tuning.SPECTRAL_GAP
    grid = tensor_grid.fitted(scene, tensor_grid.depth_for(tol), chosen.fitted)
    rates: list[float] = []

    def solve(level):
        return gap_on(scene, grid.at_level(level), chosen.iteration * tol)[:2]

    def change_by_box(level):
        try:
            wider = gap_on(scene, grid.at_level(level).enlarged(), chosen.iteration * tol).rate
        except np.linalg.LinAlgError:
            return math.inf
        return 2 * abs(wider - rates[level])

    effect = BoxEffect(change_by_box, float)

    def box(found, own, allowed):
        rates[:] = [rate for rate, _ in found]
        return effect.below(0, len(found) - 1, lambda change: own + change <= allowed)

    return range(chosen.finest + 1), solve, box


def gap_on(scene: Scene, grid: Grid, accuracy: float, first: int = ODD) -> _Slowest:
    """Compute the slowest rate on one grid.

    -A is inverted on functions modulo constants, separately for odd and for even ones.

    Parameters
    ----------
    scene : Scene
        With two to four state variables and a finite n.
    grid : Grid
    accuracy : float
        Relative, of the iteration for eigenvalues.
    first : int
        The parity that is tried first. Iterations are quicker for the other one if that has no
        slower mode.

    Returns
    -------
    rate, error : float
        The error is that of the iteration and of rounding.
    parity : int
        Of the slowest mode.

    Raises
    ------
    LinAlgError
        If the modes are not found, or the slowest one on the grid does not decay, as all modes of a
        scene do.
    """
    _, solver = tensor_grid.solver(scene, grid, scene.has_odd_drift())
    slowest: list[_Slowest] = []
    for parity in (first, -first) if solver.mirrored else (EVEN,):
        if isinstance(solver, AlternatingSolver):
            slower = tuning.SPECTRAL_GAP.apart * min(slowest).rate if slowest else math.inf
            rates = _by_davidson(solver, parity, accuracy, slower)
            backward = accuracy
        else:
            rates, backward = _by_arnoldi(solver, parity, accuracy), tuning.SPECTRAL_GAP.backward
        rate, moved = min((rate.real, _moved(rates, rate, backward)) for rate in rates)
        slowest.append(_Slowest(float(rate), float(moved + accuracy * rate), parity))
    if min(slowest).rate <= 0:
        raise np.linalg.LinAlgError("a mode on the grid does not decay")
    return min(slowest)


def _by_arnoldi(solver, parity, accuracy):
    """Compute slow rates where the Poisson equation is solved directly."""
    size = len(solver.scale)

    def inverse(values):
        solution = solver.solve(values / solver.scale, parity, accuracy)[0]
        return _centred(solver, parity, solver.scale * solution)

    # the iteration finds the slowest rate far more accurately than the other ones
    largest = spla.eigs(
        spla.LinearOperator((size, size), inverse, dtype=float),
        k=tuning.SPECTRAL_GAP.wanted,
        v0=_start(solver),
        tol=min(accuracy, tuning.SPECTRAL_GAP.loosest),
        return_eigenvectors=False,
    )
    return 1 / largest[np.abs(largest) > 1e-12]


def _by_davidson(solver, parity, accuracy, slower):
    """Compute slow rates where the inverse is known only approximately.

    If the slowest is not below `slower`, it need not be accurate.
    """
    chosen, scale = tuning.SPECTRAL_GAP, solver.scale

    def rough_inverse(values):
        try:
            solution, _ = solver.solve(values / scale, parity, chosen.inner)
        except ToleranceError:
            raise np.linalg.LinAlgError("the generator is hardly invertible there") from None
        return _centred(solver, parity, scale * solution)

    return slow_rates(
        lambda values: -_centred(solver, parity, scale * solver.generator(values / scale, parity)),
        rough_inverse,
        _centred(solver, parity, _start(solver)),
        chosen.fewer,
        accuracy,
        known=chosen.known,
        room=chosen.room,
        most=chosen.most,
        slower=slower,
    )


def _start(solver):
    """Return a weighted function that is the same in every run, and has parts of all modes."""
    return solver.scale * np.cos(np.arange(len(solver.scale)))


def _centred(solver, parity, values):
    """Take a weighted function modulo constants, which are even."""
    if parity == ODD:
        return values
    return values - solver.scale * (values.sum() / solver.scale.sum())


def _moved(rates, rate, backward):
    """Bound how far an error of the operator moves an eigenvalue; close ones are moved more."""
    gap = np.sort(np.abs(rates - rate))[1] / abs(rate)
    rounding = tuning.SPECTRAL_GAP.rounding
    return abs(rate) * (rounding + backward / max(gap, math.sqrt(backward)))
