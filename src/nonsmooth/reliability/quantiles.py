"""The threshold, and the time, at which the crossing probability takes a given value."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    LARGEST,
    SMALLEST,
    require_choice,
    require_increasing,
    require_list,
    require_positive,
    require_seed,
    require_threads,
)
from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.crossing.first_passage.distribution import default_tolerance
from nonsmooth.crossing.probability import crossing_probability, require_options
from nonsmooth.errors import SceneError, ToleranceError, answered, quoted
from nonsmooth.linear_algebra.effort import limited
from nonsmooth.paths.resolution import paths_for
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.reliability import tuning
from nonsmooth.reliability.reach import typical_reach, typical_time
from nonsmooth.reliability.roots import (
    FALLING,
    RISING,
    Root,
    Values,
    around,
    equivalent,
    root_on_grid,
    searched,
    solved_roots,
)
from nonsmooth.results import between_limits
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.thresholds import bounds

SAMPLED = "monte_carlo"
SIDES = {"both": (-1.0, 1.0), "upper": (-np.inf, 1.0), "lower": (-1.0, np.inf)}


def crossing_threshold(
    scene: Scene,
    probability: ArrayLike,
    horizons: ArrayLike,
    p: float = 1.0,
    sides: str = "both",
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
    order: int | None = None,
) -> xr.Dataset:
    """Find the threshold that is crossed with a given probability by p T.

    It is the quantile of the order 1 - P of the largest |int_0^t g| / sqrt(p) up to p T: the level
    for which to design, if crossing it may have the probability P.

    Parameters
    ----------
    scene : Scene
    probability : float or array_like, shape (q,)
        P, between 0 and 1.
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale, as for `crossing_probability`.
    sides : {"both", "upper", "lower"}
        The threshold b > 0 stands for the levels -b and b, for b alone, or for -b alone.
    method, step, paths, seed, threads, order
        As for `crossing_probability`.
    tol : float, optional
        Absolute error wanted of W, as for `crossing_probability`. Unless given, it is at most a
        tenth of P and of 1 - P, for each P by itself; and where the deterministic method of two
        variables would take longer than a minute or so, paths are counted.

    Returns
    -------
    xarray.Dataset
        Over `probability` and `horizon`, with the method among its attributes: `threshold`, b,
        "1"; its error `threshold_error`; `lower` and `upper`, between which it is. They invert the
        limits of W: at `lower` W is at least P, and at `upper` at most P. By Monte Carlo alone they
        are 95 % confidence limits, as for W, and the error is that of W over its slope. Else they
        are told by the limits of W near by and its slope, or computed where errors hide the slope;
        the error is the distance to the farther limit. A limit is 0 or inf where the error of W
        leaves it open.

    Raises
    ------
    SceneError, ToleranceError
        As `crossing_probability`.
    """
    require_random(scene)
    targets, horizons = _probabilities(probability), require_increasing("horizons", horizons)
    p, shape = require_positive("p", p), np.array(SIDES[require_choice("sides", sides, SIDES)])
    seed, threads = require_seed(seed), require_threads(threads)
    given = {"method": method, "step": step, "paths": paths, "order": order}
    ask = _Question(scene, given | {"p": p, "seed": seed, "threads": threads}, tol)

    def brownian(b):
        return float(brownian_crossing(b * shape[1], 1.0, b * shape[0]))

    def guess(P, T):
        equal = np.exp(equivalent(brownian, P, FALLING))
        level, slope = typical_reach(scene, p * T, equal, seed, threads)
        if level == 0:
            raise SceneError(
                f"probability is {P:g}, but up to T = {T:g} it is about as likely or likelier that "
                f"int g stays 0, where g = {quoted(scene.observable)}; choose a smaller one"
            )
        return level / np.sqrt(p), slope

    pairs = [(P, T) for P in targets for T in horizons]

    def values(x, tol, column, paths=None):
        run = ask(np.outer(x, shape), horizons[column], tol, paths)
        return [run.isel(horizon=k) for k in range(run.sizes["horizon"])]

    def curves(x, tol, paths):
        found = values(x, tol, slice(None), paths)
        return [found[k] for _ in targets for k in range(len(horizons))]

    def together(wanted, tol):
        found = {}
        for column in sorted({k % len(horizons) for k in wanted}):
            own = {k: x for k, x in wanted.items() if k % len(horizons) == column}
            x = np.unique(np.concatenate(list(own.values())))
            (run,) = values(x, tol, [column])
            found |= {k: _values_at(run, x, some) for k, some in own.items()}
        return found

    def present(roots):
        dims = ("probability", "horizon")
        over = {
            "probability": ("probability", targets, "probability of a crossing"),
            "horizon": ("horizon", horizons, "horizon T"),
        }
        parts = [part.reshape(len(targets), len(horizons)) for part in np.array(roots).T]
        told = {"sides": sides} | ask.attributes
        return between_limits(over, dims, "threshold", "threshold", parts, **told)

    def solve():
        guesses = [guess(*pair) for pair in pairs]
        return ask.roots([P for P, _ in pairs], guesses, curves, together, brownian, FALLING)

    with limited(tol):
        return answered(solve, present, tol_given=tol is not None)


def failure_time(
    scene: Scene,
    threshold: float | tuple[float, float],
    probability: ArrayLike = 0.5,
    p: float = 1.0,
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
    order: int | None = None,
) -> xr.Dataset:
    """Find the time by which a threshold is crossed with a given probability; 1/2: the median.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        As for `crossing_probability`.
    probability : float or array_like, shape (q,)
        P, between 0 and 1; 1/2 unless given: the median time to failure.
    p, method, step, paths, seed, threads, order
        As for `crossing_probability`.
    tol : float, optional
        Absolute error wanted of W, as for `crossing_threshold`.

    Returns
    -------
    xarray.Dataset
        Over `probability`, with the method among its attributes: `time`, T, "1", such that
        W = P at the time p T; its error `time_error`; `lower` and `upper`, between which it is.
        What they mean is told at `crossing_threshold`.

    Raises
    ------
    SceneError, ToleranceError
        As `crossing_probability`.
    """
    require_random(scene)
    targets, pair = _probabilities(probability), np.array([bounds(threshold)])
    shape = pair[0] / np.min(np.abs(pair))
    p, seed, threads = require_positive("p", p), require_seed(seed), require_threads(threads)
    given = {"method": method, "step": step, "paths": paths, "order": order}
    ask = _Question(scene, given | {"p": p, "seed": seed, "threads": threads}, tol)

    def brownian(T):
        return float(brownian_crossing(shape[1], T, shape[0]))

    def guess(P):
        # Brownian motion reaches levels in times that are like their squares
        equal = np.exp(-equivalent(brownian, P, RISING) / 2)

        def reach(time):
            return typical_reach(scene, time, equal, seed, threads)[0]

        level = np.sqrt(p) * np.min(np.abs(pair))
        time, power = typical_time(reach, level, tuning.SCALE.longest / scene.damping)
        guessed = time / p
        if not SMALLEST < guessed < LARGEST:
            raise SceneError(
                f"threshold is {quoted(threshold)}, which is crossed at about T = {guessed:.0e}; "
                f"choose one that is crossed between {SMALLEST:g} and {LARGEST:g}"
            )
        return guessed, 2 * power * typical_reach(scene, time, equal, seed, threads)[1]

    def curves(x, tol, paths=None):
        return [ask(pair, x, tol, paths).isel(threshold=0)] * len(targets)

    def together(wanted, tol):
        x = np.unique(np.concatenate(list(wanted.values())))
        run = curves(x, tol)[0]
        return {k: _values_at(run, x, own) for k, own in wanted.items()}

    def present(roots):
        over = {"probability": ("probability", targets, "probability of a crossing")}
        return between_limits(
            over, ("probability",), "time", "time", np.array(roots).T, **ask.attributes
        )

    def solve():
        guesses = [guess(P) for P in targets]
        beside = tuning.SEARCH.beside
        return ask.roots(list(targets), guesses, curves, together, brownian, RISING, beside)

    with limited(tol):
        return answered(solve, present, tol_given=tol is not None)


def _probabilities(values):
    found = require_list("probability", values)
    if not np.all((found > 0) & (found <= 1 - tuning.SEARCH.surest)):
        raise SceneError(
            f"probability is {quoted(values)}; give numbers between 0 and 1, at most "
            f"1 - {tuning.SEARCH.surest:g}"
        )
    return found


class _Question:
    """What is asked of `crossing_probability`, again and again."""

    def __init__(self, scene: Scene, given: dict, tol: float | None):
        self._scene = scene
        self._given: dict[str, Any] = {k: v for k, v in given.items() if v is not None}
        options = {name: given[name] for name in ("step", "paths", "order")}
        self._tol = require_options(given["method"], options | {"tol": tol}).get("tol")
        self._refusal: str | None = None
        self._answers: dict[tuple, xr.Dataset] = {}
        self.attributes: dict = {}
        self._last = ""  # method of the last answer

    def __call__(
        self,
        levels: np.ndarray,
        horizons: np.ndarray,
        tol: float | None,
        paths: int | None = None,
    ) -> xr.Dataset:
        """Return W, computed once; the refusal of a tolerance is noted.

        A number of paths that is given to all questions comes before `paths`.
        """
        key = levels.tobytes(), horizons.tobytes(), tol, paths, self._given.get("method")
        if key not in self._answers:
            wanted = {"tol": tol, "paths": paths}
            asked = {k: v for k, v in wanted.items() if v is not None} | self._given
            self._answers[key] = self._asked(levels, horizons, asked)
        return self._answers[key]

    def _asked(self, levels, horizons, asked):
        try:
            found = crossing_probability(self._scene, levels, horizons, **asked)
        except ToleranceError as refused:
            self._refusal = str(refused)
            if not isinstance(refused.result, xr.Dataset):
                raise
            found = refused.result
        self._last, taken = found.attrs["method"], self.attributes.get("method", "").split(", ")
        methods = dict.fromkeys([*filter(None, taken), self._last])
        self.attributes = found.attrs | {"method": ", ".join(methods)}
        return found

    def tolerance(self, target: float) -> float | None:
        """Tolerance of W near a target, unless it is given; None for methods that take none."""
        if self._given.get("method") in ("asymptotic", "corrected"):
            return self._tol
        if self._tol is not None:
            return self._tol
        share = tuning.SEARCH.share * min(target, 1 - target)
        usual = default_tolerance(self._scene)
        sampled = usual is None or self._is_sampled()
        return min(share, MONTE_CARLO.tolerance if sampled or usual is None else usual)

    def _is_sampled(self):
        given = self._given
        if "method" in given:
            return given["method"] == SAMPLED
        return "order" not in given and bool({"step", "paths"} & given.keys())

    def roots(
        self,
        targets: list[float],
        guesses: list[tuple[float, float]],
        curves: Callable[..., list[xr.Dataset]],
        together: Callable[[dict[int, np.ndarray], float | None], dict[int, Values]],
        reference: Callable[[float], float],
        sense: int,
        beside: float = 0.0,
    ) -> list[Root]:
        """Find where W takes the values `targets`.

        By Monte Carlo those of one tolerance on the same paths, from `curves`, which returns W for
        each target; otherwise those of one tolerance together, from `together`, which takes x for
        the numbers of some targets. The reference is W of Brownian motion. Up to the distance
        `beside` in log x of each x, W costs nothing more.
        """
        # otherwise the method follows from the scene
        named = bool({"method", "order"} & self._given.keys())
        sampled = self._is_sampled() or (not named and default_tolerance(self._scene) is None)
        found, counted = None, np.inf
        tolerances = [self.tolerance(target) for target in targets]
        missed = dict.fromkeys(range(len(targets)), True)
        nearest: dict[int, tuple[float, float]] = {}

        def solved(wanted):
            known = {}
            missed.update(dict.fromkeys(wanted, True))
            # the tightest last: its method decides whether paths are counted
            for tol in sorted({tolerances[k] for k in wanted}, key=lambda tol: -(tol or 0.0)):
                known |= together({k: x for k, x in wanted.items() if tolerances[k] == tol}, tol)
            # a root rests on the nearest value of all, not on others that miss the tolerance
            for k, values in known.items():
                best = int(np.argmin(np.abs(values.probability - targets[k])))
                wanted_at = equivalent(reference, targets[k], sense)
                way = abs(equivalent(reference, values.probability[best], sense) - wanted_at)
                nearest[k] = min((way, float(values.error[best])), nearest.get(k, (np.inf, np.inf)))
                missed[k] = tolerances[k] is None or nearest[k][1] > tolerances[k]
            return known

        try:
            if not sampled and not named:
                solved({k: around(guess[0], beside) for k, guess in enumerate(guesses)})
                # those of the longest horizon, which come last, have the others for nothing
                sampled = self._last == SAMPLED
            if not sampled:
                searches = [
                    searched(reference, target, guess, sense, tol or 0.0, beside)
                    for target, guess, tol in zip(targets, guesses, tolerances, strict=True)
                ]
                found = solved_roots(searches, solved)
        except ToleranceError:  # the solver found nothing, or not within its effort
            if named or self._tol is not None:
                raise
            self._refusal, self.attributes = None, {}
            counted = tuning.COUNTED
        if found is None:
            missed = dict.fromkeys(missed, True)
            self._given["method"] = SAMPLED
            found = self._counted(curves, targets, guesses, sense, counted)
        if self._refusal is not None and any(missed.values()):
            raise ToleranceError(self._refusal, found)
        return found

    def _counted(self, curves, targets, guesses, sense, most):
        """Invert sampled probabilities, with the same paths for targets of the same tolerance."""
        wanted = [min(most, self.tolerance(target)) for target in targets]
        if "paths" in self._given:
            wanted = [min(wanted)] * len(targets)
        found: dict[int, Root] = {}
        for tol in sorted(set(wanted), reverse=True):
            places = [k for k, own in enumerate(wanted) if own == tol]

            def some(x, tol, paths, places=places):
                every = curves(x, tol, paths)
                return [every[k] for k in places]

            part = [targets[k] for k in places], [guesses[k] for k in places]
            if "paths" not in self._given:
                _require_possible(part[0], tol)
            found |= zip(places, _on_grids(some, *part, sense, tol), strict=True)
        return [found[k] for k in range(len(targets))]


def _paths(targets, tol):
    """Count the paths that tell W to the tolerance where it is one of the targets."""
    wanted = (paths_for(np.sqrt(P * (1 - P)), tol) for P in targets)
    return max(tuning.GRID.least_paths, *wanted)


def _require_possible(targets, tol):
    """Refuse what would take too many paths."""
    needed = _paths(targets, tol)
    if needed > tuning.GRID.most_paths:
        raise ToleranceError(
            f"W = {min(targets, key=lambda P: min(P, 1 - P)):g} to {tol:.1g} would take Monte "
            f"Carlo {needed:.0e} paths; choose a likelier crossing or a larger tol, or "
            "method='corrected'"
        )


def _values_at(run, x, wanted):
    """Take values at some of the increasing x of a run."""
    return Values(*(part[np.searchsorted(x, wanted)] for part in _values(run)))


def _values(run):
    names = ("probability", "probability_error", "lower", "upper")
    return Values(*(run[name].values for name in names))


def _on_grids(curves, targets, guesses, sense, tol):
    """Invert sampled probabilities on a rough grid around guesses, then on a fine one.

    There are as many paths as the tolerance takes at the targets. Elsewhere on a grid, where W is
    near 1/2, it would take far more.
    """
    grid = tuning.GRID

    def sampled(tol):
        return partial(curves, tol=tol, paths=_paths(targets, tol))

    spread = grid.rough_factor
    spans = [(x / spread, x * spread) for x, _ in guesses]
    rough = _inverted(sampled(grid.rough_tolerance * tol), targets, spans, grid.rough_values, sense)
    spans = []
    for root in rough:
        more = (root.upper / root.lower) ** grid.margin
        spans.append((root.lower / more, root.upper * more))
    return _inverted(sampled(tol), targets, spans, grid.values, sense)


def _inverted(curves, targets, spans, count, sense):
    """Invert on grids over spans, which are widened until they contain the limits."""
    spans = list(spans)
    for _ in range(tuning.GRID.attempts):
        x = np.unique(np.concatenate([np.geomspace(*span, count) for span in spans]))
        found = [
            root_on_grid(x, _values(run), target, sense)
            for run, target in zip(curves(x), targets, strict=True)
        ]
        if all(root.lower > 0 and root.upper < np.inf for root in found):
            return found
        for k, root in enumerate(found):
            low, high = spans[k]
            ratio = high / low
            spans[k] = (
                low if root.lower > 0 else max(low / ratio, SMALLEST),
                high if root.upper < np.inf else min(high * ratio, LARGEST),
            )
    raise ToleranceError(
        "Monte Carlo does not bracket the probability asked for; choose a smaller tol, or one that "
        "is nearer to 1/2"
    )
