"""Crossing probabilities by importance sampling: paths are led to the level and weighted.

For each side, and for as many horizons as need one of their own, a guide is fitted that shifts the
noise towards the level (`nonsmooth.paths.tilted`). The weighted fraction of the paths that reach it
estimates the probability without bias, whatever the guide; its quality decides on the variance
alone. Thus rare crossings take hardly more paths than frequent ones.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy

from nonsmooth.crossing import tuning
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.paths.ensembles import require_finite
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK, labelled
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.resolution import coarse_step, refined_step, require_possible
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tilted import poisson
from nonsmooth.paths.tilted.cross_entropy import refitted
from nonsmooth.paths.tilted.loop import (
    REACHED,
    SUMS,
    TOTAL_LOG_WEIGHT,
    compile_march_tilted,
    compile_march_tilted_pair,
    march_tilted,
    march_tilted_pair,
)
from nonsmooth.paths.tilted.tilt import Aim, Guide
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.scene import Scene


def importance_sampled_crossing(
    scene: Scene,
    thresholds: np.ndarray,
    horizons: np.ndarray,
    p: float,
    seed: int | tuple,
    threads: int | None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
) -> tuple[dict, dict]:
    """Lead paths to the thresholds; the step and the number of paths follow from `tol`.

    Parameters
    ----------
    scene, horizons, p, seed, threads, step, paths
        As for `crossing_probability`.
    thresholds : numpy.ndarray, shape (m, 2)
        Lower and upper levels.
    tol : float, optional
        Absolute error; a tenth of the probability unless given.

    Returns
    -------
    values : dict
        What `crossing_probability` describes, arrays of the shape (m, k).
    attributes : dict
        `step`, the shortest used, and `paths`, the largest number for one side of a threshold.

    Raises
    ------
    SceneError
        If int g does not spread like a Brownian motion, or a path diverges.
    ToleranceError
        If `tol` is not met, or so few paths carry the weight that the error is not known.
    """
    if scene.primitive_variable is not None:
        raise SceneError(
            f"int g is a function of {scene.primitive_variable} along paths, here of g = "
            f"{quoted(scene.observable)}, so that no formula guides them; use method='monte_carlo'"
        )
    guide = poisson.fitted(scene, coarse_step(scene) / 2, labelled(seed, "importance"))
    found: list[dict] = [{} for _ in thresholds]
    missed = []
    led: dict[int, Guide] = {}
    # from the nearest threshold on, as guides to it lead some way to the next one
    width = np.where(np.isfinite(thresholds), np.abs(thresholds), 0.0).sum(axis=1)
    for k in np.argsort(width, kind="stable"):
        own = labelled(labelled(seed, "importance"), int(k))
        levels = tuple((np.sqrt(p) * thresholds[k]).tolist())
        request = _Request(scene, levels, p * horizons, own, threads, tol, step, paths, guide, led)
        found[k], fault = request.answer()
        missed += [fault] if fault else []
    values = {name: np.array([own[name] for own in found]) for name in found[0]}
    steps, counts = values.pop("step"), values.pop("paths")
    result = values, {"step": float(steps.min()), "paths": int(counts.max())}
    if missed:
        raise ToleranceError(missed[0], result)
    return result


@dataclass(frozen=True)
class _Course:
    """Paths led to one level by one guide.

    `counted` is as for `march_tilted`; `images` is 2 if each path also stands for its mirror image.
    """

    aim: Aim
    guide: Guide
    counted: int
    images: int
    seed: tuple


@dataclass(frozen=True)
class _Sums:
    """Weighted sums over the paths of some courses, and their estimates, over the horizons.

    Attributes
    ----------
    value, variance : numpy.ndarray, shape (k,)
        Probability and the variance of its estimate.
    effective : numpy.ndarray, shape (k,)
        Effective number of the paths that have crossed.
    weight : numpy.ndarray, shape (k,)
        Mean weight of these.
    """

    value: np.ndarray
    variance: np.ndarray
    effective: np.ndarray
    weight: np.ndarray

    @property
    def error(self):
        """Standard error of the probability."""
        return np.sqrt(self.variance)


@dataclass(frozen=True)
class _Request:
    """What is asked for one threshold; `levels` and `times` are those of int g.

    `guide` is that of the Poisson solution, `led` has the last guide to each side, if any.
    """

    scene: Scene
    levels: tuple[float, float]
    times: np.ndarray
    seed: tuple
    threads: int | None
    tol: float | None
    step: float | None
    paths: int | None
    guide: Guide
    led: dict[int, Guide]

    def answer(self):
        """Return a dict over the horizons, and a message if it is not good enough.

        From the last horizon on, each guide serves the horizons before it, too, as long as their
        relative error does not grow much.
        """
        size = len(self.times)
        names = ("probability", "standard_error", "step_bias", "step_bias_error")
        values = {name: np.zeros(size) for name in (*names, "effective_sample_size")}
        step = coarse_step(self.scene) / 2 if self.step is None else self.step
        last, paths, fault = size - 1, 0, None
        while last >= 0:
            led = {side: self.course(side, last) for side in self.sides(last)}
            if any(led[side] is None for side in self.likely(last, self.guide.ahead)):
                fault = fault or self.out_of_reach(last)
                break
            courses = [course for course in led.values() if course is not None]
            if len(courses) < len(led):  # what comes to the other side by chance counts, too
                courses = [replace(course, counted=0) for course in courses]
            sums, (bias, bias_error), step, used = self.sampled(courses, last, step)
            paths = max(paths, used)
            served = self.served(sums)
            own = slice(served, last + 1)
            parts = sums.value, sums.error, bias, bias_error, sums.effective
            for kept, part in zip(values.values(), parts, strict=True):
                kept[own] = part[own]
            if sums.effective[last] < tuning.WEIGHTS.least:
                fault = fault or self.too_few(sums, last)
                break
            if abs(bias[last]) - 3 * bias_error[last] > MONTE_CARLO.measurable * sums.value[last]:
                fault = fault or (
                    f"halving the step {step:.2g} changes W = {sums.value[last]:.3g} by "
                    f"{abs(bias[last]):.1g}; choose a shorter step"
                )
            last = served - 1
            if last >= 0 and sums.value[served] + 3 * sums.error[served] < self.negligible():
                break
        return self.outcome(values, last, step, paths, fault)

    def outcome(self, values, last, step, paths, fault):
        """Complete the values; up to `last`, nothing is known but that probabilities grow."""
        bias, spread = (
            values["step_bias"],
            np.hypot(values["standard_error"], values["step_bias_error"]),
        )
        error = np.minimum(np.abs(bias) + spread, 1.0)
        centre = values["probability"] - bias
        half = scipy.special.ndtri(0.975) * spread
        lower = np.clip(np.minimum(centre - half, values["probability"]), 0.0, 1.0)
        upper = np.clip(np.maximum(centre + half, values["probability"]), 0.0, 1.0)
        if last >= 0:
            bound = upper[last + 1] if last + 1 < len(upper) else 1.0
            error[: last + 1], upper[: last + 1], lower[: last + 1] = bound, bound, 0.0
        worst = error.max()
        if fault is None and self.tol is not None and worst > self.tol:
            fault = (
                f"W = {values['probability'][np.argmax(error)]:.3g} has an error of {worst:.1e}, "
                f"above tol = {self.tol:g}; choose more paths or a shorter step, or loosen tol"
            )
        values["probability"] = np.minimum(values["probability"], 1.0)
        known = {"probability_error": error, "lower": lower, "upper": upper}
        return values | known | {"step": step, "paths": paths}, fault

    def negligible(self):
        """Return a probability that need not be told from 0."""
        return tuning.WEIGHTS.negligible if self.tol is None else self.tol / 4

    @property
    def order(self):
        """Order of the bias in the step.

        A path that comes back within a step is missed. If g is driven by the noise, it varies like
        the root of h: such paths are a part h of all, and h^(1/4) of these never cross again.
        """
        scheme = registry.scheme(self.scene).weak_order(self.scene)
        rough = self.scene.noise.driven in self.scene.observable_expression.free_symbols
        return min(scheme, tuning.WEIGHTS.rough_order) if rough else scheme

    @property
    def mirrored(self):
        """Whether the mirror image of a path to one level is as probable a path to the other."""
        return self.scene.is_odd() and self.levels[0] == -self.levels[1] and not self.scene.start

    def sides(self, last):
        """Return the sides to which paths are led; one that hardly any path reaches is left out.

        Early on the start has taken int g only a part of the way that it does in the long run.
        """
        return sorted(self.likely(last, 0.0) | self.likely(last, self.guide.ahead))

    def likely(self, last, ahead):
        """Sides that are not far less probable than the other, if int g is so far ahead."""
        if self.mirrored:
            return {1}
        time = self.times[last]
        left = np.array([-1, 1]) * (np.array(self.levels) - self.guide.mean * time - ahead)
        spread = self.guide.gamma * math.sqrt(time)
        log = scipy.special.log_ndtr(-np.maximum(left, 0.0) / spread)
        far = log < log.max() + math.log(tuning.WEIGHTS.other_side)
        return {side for side, left_out in zip((-1, 1), far, strict=True) if not left_out}

    def course(self, side, last):
        """Fit a guide to a level, by way of nearer ones if too few paths reach it at once."""
        aim = Aim(side, self.levels, float(self.times[last]))
        seed = labelled(labelled(self.seed, last), f"side {side}")
        chosen, step = tuning.WEIGHTS, coarse_step(self.scene)
        for parts in chosen.ladder:
            guide, before, effective = self.led.get(side, self.guide), 0.0, 0.0
            for k in range(parts + chosen.repeated):
                own = labelled(labelled(seed, f"fit {parts}"), k)
                sampling = Sampling(step, chosen.fitted, own, threads=self.threads)
                nearer = aim.nearer(min((k + 1) / parts, 1.0))
                before = effective
                guide, effective = refitted(self.scene, guide, self.guide, nearer, sampling)
                if k >= parts - 1 and effective >= chosen.even * chosen.fitted:
                    break
                if k >= parts and effective < chosen.improved * before:
                    break
            if effective >= chosen.led:
                self.led[side] = guide
                counted = side if self.mirrored or len(self.sides(last)) > 1 else 0
                return _Course(aim, guide, counted, 1 + self.mirrored, seed)
        return None

    def sampled(self, courses, last, step):
        """Sample until the tolerance is met; return sums, the bias, the step and the paths."""
        chosen = tuning.WEIGHTS
        sums, done = np.zeros((len(courses), last + 1, SUMS)), 0
        paths = chosen.first if self.paths is None else self.paths
        for _ in range(tuning.COUNTING.attempts):
            while done < paths:
                sums += [self.gathered(one, last, step, done, paths) for one in courses]
                done = paths
                found = _estimated(sums, done)
                wanted = self.enough(found, done, last)
                if self.paths is None and wanted > done:
                    told = f"W = {found.value[last]:.3g} has an error of {found.error[last]:.1g}"
                    require_possible(wanted, self.times[last] / step, told, self.tolerance(found))
                    paths = wanted
            bias, error = self.bias(courses, found, step, done)
            stated = np.max(np.abs(bias) + np.hypot(found.error, error))
            if self.step is not None or stated <= self.tolerance(found):
                break
            worst = np.max(np.abs(bias) + error)
            step = refined_step(step, worst, self.allowed(found), self.order)
            sums, done = np.zeros_like(sums), 0
        return found, (bias, error), step, done

    def tolerance(self, found):
        """Return the absolute error wanted; for unknown probabilities that of a tenth."""
        return tuning.WEIGHTS.relative * found.value[-1] if self.tol is None else self.tol

    def allowed(self, found):
        """Return the bias that the step may have."""
        return (1 - MONTE_CARLO.spread_share) * self.tolerance(found)

    def enough(self, found, done, last):
        """Return how many paths, in whole blocks, should meet the tolerance and tell the error."""
        allowed = MONTE_CARLO.spread_share / MONTE_CARLO.sigmas * self.tolerance(found)
        if not (allowed > 0 and found.effective[last] > 0):
            return done
        factor = max(
            np.max(found.variance) / allowed**2, tuning.WEIGHTS.least / found.effective[last]
        )
        return done if factor <= 1 else BLOCK * math.ceil(1.1 * factor * done / BLOCK)

    def gathered(self, course, last, step, first, paths):
        """Sum up the weights of the paths of a course that cross by each horizon."""
        grid = [
            (steps, registry.coefficients(self.scene, "strang", h), h)
            for steps, h in equal_steps(self.times[: last + 1], step)
        ]
        tilt = course.guide.towards(course.aim)
        sampling = Sampling(step, paths - first, course.seed, first, self.threads)
        compile_march_tilted(grid[0][1], new_panel(self.scene, course.seed, 0), tilt)

        def run(job):
            block, left = job
            panel = new_panel(self.scene, course.seed, block)
            sums, began = np.zeros((len(grid), SUMS)), 0.0
            for (steps, s, h), own in zip(grid, sums, strict=True):
                aim = course.aim.levels, course.counted
                left = march_tilted(s, panel, tilt, left, steps, began, *aim, own)
                began += steps * h
            require_finite(panel.total[TOTAL_DELTA, :left])
            return sums

        total = sum(parallel(run, sampling, sum(steps for steps, *_ in grid)))
        return np.cumsum(total, axis=0) * course.images ** np.arange(SUMS)

    def bias(self, courses, found, step, paths):
        """Measure the bias of the step, with so many paths that it is known to what is allowed."""
        chosen = tuning.WEIGHTS
        fewer = min(paths, max(chosen.first // 2, BLOCK * (paths // MONTE_CARLO.halved // BLOCK)))
        bias, error = self.halved(courses, found, step, fewer)
        more = fewer * (np.max(error) / self.allowed(found)) ** 2 if found.value[-1] > 0 else 0
        if self.paths is None and more > fewer:
            more = BLOCK * math.ceil(min(1.1 * more, chosen.most_halved * paths) / BLOCK)
            bias, error = self.halved(courses, found, step, max(more, fewer))
        return bias, error

    def halved(self, courses, found, step, paths):
        """Measure how halving the step changes the probabilities, with standard errors."""
        grid = equal_steps(self.times[: len(found.value)], step)
        total, squares = np.zeros(len(grid)), np.zeros(len(grid))
        for course in courses:
            for change in self.changes(course, grid, step, paths):
                total += change.sum(axis=1)
                squares += np.sum(change**2, axis=1)
        factor = bias_over_change(self.order)
        # if no path crosses with one of the steps only, the error is that of one such path
        spread = np.sqrt(np.maximum(squares, found.weight**2))
        return factor * total / paths, factor * spread / paths

    def changes(self, course, grid, step, paths):
        """For each block, the weighted change of the crossings by each horizon on each path."""
        pairs = {
            h: (
                registry.coefficients(self.scene, "strang", h / 2),
                registry.on_given_increments(registry.coefficients(self.scene, "strang", h)),
            )
            for h in {h for _, h in grid}
        }
        seed = labelled(course.seed, "halving")
        tilt = course.guide.towards(course.aim)
        panel = new_panel(self.scene, seed, 0)
        compile_march_tilted_pair(*pairs[grid[0][1]], panel, tilt)

        def run(job):
            block, lanes = job
            panels = tuple(new_panel(self.scene, seed, block) for _ in range(2))
            change, began = np.zeros((len(grid), lanes)), 0.0
            for (steps, h), own in zip(grid, change, strict=True):
                march_tilted_pair(*pairs[h], panels, tilt, lanes, steps, began, course.aim.levels)
                began += steps * h
                fine, coarse = (panel.data[REACHED, :lanes] for panel in panels)
                there = [
                    (x == course.counted) if course.counted else (x != 0) for x in (fine, coarse)
                ]
                differs = there[1].astype(float) - there[0]
                weights = np.exp(panels[0].total[TOTAL_LOG_WEIGHT, :lanes])
                own[:] = course.images * differs * weights
            return change

        sampling = Sampling(step, paths, seed, threads=self.threads)
        return parallel(run, sampling, 3 * sum(steps for steps, _ in grid))

    def served(self, sums):
        """Return the first horizon whose relative error is not much above that of the last."""
        with np.errstate(all="ignore"):
            relative = sums.error / sums.value
        good = relative <= tuning.WEIGHTS.worse * relative[-1]
        good &= sums.effective >= tuning.WEIGHTS.least
        good[-1] = True
        return len(good) - int(np.argmin(good[::-1])) if not good.all() else 0

    def too_few(self, sums, last):
        """Return the message that too few paths carry the weight."""
        return (
            f"W = {sums.value[last]:.3g} rests on {sums.effective[last]:.0f} effective paths, "
            "too few to know its error; choose more paths"
        )

    def out_of_reach(self, last):
        """Return the message that no guide was found."""
        return (
            f"by the time {self.times[last]:g} hardly any path reaches the levels "
            f"{quoted(self.levels)}, "
            "although it is led there; choose nearer thresholds or longer horizons"
        )


def _estimated(sums, paths):
    """Estimate from the sums of each course, shape (courses, k, SUMS)."""
    count, weight, square = np.moveaxis(sums, -1, 0)
    value = weight / paths
    variance = np.maximum(square / paths - value**2, 0.0) / paths
    total = square.sum(axis=0)
    effective = np.divide(weight.sum(axis=0) ** 2, total, out=np.zeros_like(total), where=total > 0)
    weights, counts = weight.sum(axis=0), np.maximum(count.sum(axis=0), 1)
    return _Sums(value.sum(axis=0), variance.sum(axis=0), effective, weights / counts)
