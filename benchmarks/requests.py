"""What a tolerance costs: random requests, and the best way to answer them in hindsight.

`python -m benchmarks.requests` makes 210 requests, prints a table by quantity and writes every
request with all its alternatives to results/requests.csv; arguments choose quantities by their
first words, and a number divides the counts.

Times are seconds of one core (process time). Before each run the caches of scenes are emptied and
kernels are compiled; of runs below 0.2 s the faster of two counts. A Monte Carlo run counts as
right if it is so with four seeds, because with far too few paths one run is often right by chance.
"""

import csv
import functools
import math
import signal
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

import nonsmooth as ns
from nonsmooth.boundary_layer import milne
from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.errors import NonsmoothError, ToleranceError
from nonsmooth.grids import tensor_grid
from nonsmooth.kinetic import tail_equation
from nonsmooth.line import eigenfunctions, quadrature
from nonsmooth.paths.ensembles import coupled, gram, integrals_at
from nonsmooth.paths.moments import moments
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.statistics import gamma2_on_grids, moments_on_grids
from nonsmooth.statistics.sampled_gamma2 import slopes
from nonsmooth.statistics.spectral_gap import gap_on as gap_on_grid

SEED, OUTPUT = 1, Path("results/requests")
COLUMNS = [
    "request",
    "quantity",
    "variables",
    "scene",
    "given",
    "tol",
    "kind",
    "name",
    "seconds",
    "error/tol",
]
SHORT, REPEATS = 0.2, 2  # seconds of runs that are repeated, and how often they are run
OVERHEAD = 0.05  # seconds that are added to both times of a ratio: shorter times do not matter
LIMIT = 3.0  # ratios above it are counted
REFERENCE = 600.0  # seconds after which references, and answers without one, are given up
LOOSER = (100.0, 10.0)  # times the tolerance: what the same function is asked for, too
LOOSEST = 0.3  # largest relative tolerance that is asked for
STEPS = (1.0, 0.5, 0.25, 0.125)  # of plain Monte Carlo, times the coarse one
GROWTH_TIMES = (10.0, 60.0, 110.0)
SAMPLED, SEEDS = "monte_carlo", (0, 1, 2, 3)
# relative variance of the estimates, times the number of paths
SPREAD = {"gamma^2": 2.4, "variance": 2.0}
POTENTIALS = ("x**2/2", "x**2", "x**2/2 + 0.3*cos(2*x)", "x**4/4 + x**2/2")
FINER = 10.0  # tolerance of the request over that of its reference on grids
RESOLVED = 2.0  # the same of references by Monte Carlo


@dataclass(frozen=True)
class Request:
    """A quantity of a scene to a tolerance, and what else the function is given."""

    quantity: str
    scene: ns.Scene
    tol: float
    given: dict = field(default_factory=dict)

    def ask(self, tol=None, seed=0, **options):
        """Ask the library for values and the method, to another tolerance if one is given."""
        return ASKED[self.quantity](self, tol or self.tol, seed, **options)

    @functools.cached_property
    def reference(self):
        """Find the reference values, and the part of the tolerance up to which they are known."""
        return QUANTITIES[self.quantity].reference(self)

    def afresh(self):
        """Make the same request with a new scene object, for which only a reference is known."""
        other = replace(self, scene=replace(self.scene))
        if "reference" in self.__dict__:
            other.__dict__["reference"] = self.reference
        return other


@dataclass(frozen=True)
class Quantity:
    """How requests are drawn and judged, and the other ways to answer them.

    Attributes
    ----------
    count : int
    draw : callable
        Takes a random generator, returns a Request.
    reference : callable
        Takes a Request, returns the values and the part of the tolerance up to which they are
        known.
    distance : callable
        Takes a Request, values and reference, returns the error that `tol` bounds.
    stated : dict
        Maps names to functions of a Request that yield runs, from the cheapest to the dearest, of
        methods that state their error. A run takes a seed and returns the values and the method.
    bare : dict
        The same for methods that do not know their error. They return None for the values where
        the sample is too small for the tolerance.
    """

    count: int
    draw: Callable
    reference: Callable
    distance: Callable
    stated: dict
    bare: dict


# Requests


def log_uniform(rng, low, high):
    """Draw from low to high."""
    return float(f"{math.exp(rng.uniform(math.log(low), math.log(high))):.4g}")


def pick(rng, values):
    """Draw one of some values."""
    return values[rng.integers(len(values))]


OBSERVABLES = {
    "friction": ("y", "y", "friction_force", "sin(y)", "y**3 - y"),
    "elasto_plastic": ("y", "plastic_strain_rate", "y", "x + y"),
    "obstacle": ("x", "x", "contact_force", "sin(x)"),
}
COLOURS = {
    "white": (ns.White(1.0), ns.White(1.4)),
    "langevin": (ns.OrnsteinUhlenbeck(1.0), ns.OrnsteinUhlenbeck(0.7, 1.2)),
    "hamiltonian": (ns.KanaiTajimi(1.0, 1.0), ns.KanaiTajimi(2.0, 0.8)),
}


def random_scene(rng, finite=False, variables=(1, 2, 3, 4), odd=False):
    """One of the nine kinds, whose state has one of the given numbers of variables."""
    while True:
        model, noise = pick(rng, tuple(OBSERVABLES)), pick(rng, tuple(COLOURS))
        rigid = not finite and rng.random() < 1 / 8
        n = math.inf if rigid else log_uniform(rng, 1, 1000)
        U, g = "0", pick(rng, OBSERVABLES[model])
        if model != "friction":
            U = pick(rng, POTENTIALS)
        if rigid and g in ("contact_force", "plastic_strain_rate"):
            continue
        scene = ns.Scene(model, pick(rng, COLOURS[noise]), n, log_uniform(rng, 0.5, 2), U, g)
        if scene.dimension in variables and (scene.is_odd() or not odd):
            return scene


def tolerance(rng, scene, ranges):
    """Draw a tolerance from the range of the scene's number of variables."""
    return log_uniform(rng, *ranges[scene.dimension])


def some_growth(rng):
    """Draw a request for gamma^2."""
    scene = random_scene(rng, variables=pick(rng, ((1,), (2,), (2,), (3, 4))))
    ranges = {1: (1e-10, 1e-2), 2: (1e-6, 3e-2), 3: (4e-2, 1.5e-1), 4: (5e-2, 1.5e-1)}
    return Request("gamma^2", scene, tolerance(rng, scene, ranges))


def some_variance(rng):
    """Draw a request for v(0, tau), whose tolerance is relative to the size of int g."""
    scene = random_scene(rng, variables=pick(rng, ((1,), (2,), (3, 4))))
    first = log_uniform(rng, 0.5, 5)
    times = np.round(np.geomspace(first, first * log_uniform(rng, 1.5, 20), 4), 3)
    ranges = {1: (1e-9, 1e-2), 2: (1e-5, 1e-2), 3: (1e-2, 5e-2), 4: (1e-2, 5e-2)}
    size = gamma_scale(scene)
    tol = tolerance(rng, scene, ranges) * size
    if math.isinf(scene.n) and scene.dimension == 2:
        tol = max(tol, 3e-2 * size)
    return Request("variance", scene, tol, {"times": times})


def some_crossing(rng):
    """Draw a request for W at up to four horizons."""
    scene = random_scene(rng, variables=pick(rng, ((1,), (1,), (2, 3, 4))))
    size = math.sqrt(gamma_scale(scene))
    lower, upper = (round(size * log_uniform(rng, 0.7, 3), 4) for _ in range(2))
    threshold = upper if rng.random() < 0.5 else pick(rng, ((-lower, upper), (-math.inf, upper)))
    first = log_uniform(rng, 0.5, 4)
    horizons = np.round(first * np.geomspace(1, log_uniform(rng, 1.2, 10), rng.integers(1, 5)), 3)
    p = pick(rng, (1.0, 1.0, 10.0, 100.0))
    loosest = {1: (1e-7, 3e-2)}.get(scene.dimension, (3e-3, 3e-2))
    tol = log_uniform(rng, *loosest)
    given = {"threshold": threshold, "horizons": horizons, "p": p}
    return Request("crossing", scene, tol, given)


def some_density(rng):
    """Draw a request for the marginal densities within [-1.5, 1.5]."""
    scene = random_scene(rng, True, pick(rng, ((1,), (2,))))
    points = {name: np.linspace(-1.5, 1.5, 31) for name in scene.state}
    ranges = {1: (1e-8, 1e-2), 2: (1e-4, 3e-2)}
    return Request("density", scene, tolerance(rng, scene, ranges), {"points": points})


def some_gap(rng):
    """Draw a request for the spectral gap."""
    scene = random_scene(rng, True, pick(rng, ((1,), (2,))))
    return Request("spectral gap", scene, tolerance(rng, scene, {1: (1e-9, 1e-2), 2: (1e-6, 1e-2)}))


def some_length(rng):
    """Draw a request for kappa."""
    scene = random_scene(rng, True, pick(rng, ((1,), (2,))), odd=True)
    size = math.sqrt(gamma_scale(scene))
    ranges = {1: (1e-8, 1e-2), 2: (1e-2, 1e-1)}
    return Request("extrapolation length", scene, size * tolerance(rng, scene, ranges))


def gamma_scale(scene):
    """Estimate the variance of int g over ten units of time, divided by them."""
    run = ns.simulate(scene, 10.0, step=0.05, paths=1000, times=[10.0], seed=9)
    return float(f"{max(float(run['variance'][0]) / 10, 1e-6):.2g}")


# Answers of the library


def asked_growth(request, tol, seed, **options):
    """Ask for gamma^2."""
    found = ns.asymptotic_variance(request.scene, tol, seed=seed, threads=1, **options)
    return found.value, SAMPLED if found.method == "Monte Carlo" else found.method


def asked_variance(request, tol, seed, **options):
    """Ask for v over the times."""
    times = request.given["times"]
    found = ns.variance(request.scene, times, tol, seed=seed, threads=1, **options)
    return found["v"].values, found.attrs["method"]


def asked_crossing(request, tol, seed, **options):
    """Ask for W over the horizons."""
    found = ns.crossing_probability(
        request.scene, **request.given, tol=tol, seed=seed, threads=1, **options
    )
    return found["probability"].values, found.attrs["method"]


def asked_density(request, tol, _seed):
    """Ask for the densities of each variable and of two together, one after the other."""
    found = ns.invariant_density(request.scene, tol, request.given["points"])
    names = sorted(name for name in found.data_vars if not name.endswith("_error"))
    # averages over cells, by Monte Carlo, are not judged
    known = [np.nan if "cell_methods" in found[name].attrs else 1.0 for name in names]
    largest = [float(found[name].max()) * k for name, k in zip(names, known, strict=True)]
    # each density relative to its largest value
    values = [found[name].values.ravel() / top for name, top in zip(names, largest, strict=True)]
    return np.concatenate([*values, np.log(largest)]), "grids"


def asked_gap(request, tol, _seed):
    """Ask for the gap."""
    return ns.spectral_gap(request.scene, tol).value, "spectral elements"


def asked_length(request, tol, seed):
    """Ask for kappa."""
    found = ns.extrapolation_length(request.scene, tol, seed=seed, threads=1)
    return found.value, found.method


ASKED = {
    "gamma^2": asked_growth,
    "variance": asked_variance,
    "crossing": asked_crossing,
    "density": asked_density,
    "spectral gap": asked_gap,
    "extrapolation length": asked_length,
}


# Alternatives


def by(method):
    """Name the method."""

    def runs(request):
        yield lambda seed: request.ask(seed=seed, method=method)

    return runs


def least_sampled(request):
    """Return the tolerance below which sampling takes minutes and could not be stopped in time."""
    if request.quantity == "crossing":
        return 3e-4
    return 1e-3 * (gamma_scale(request.scene) if request.quantity == "variance" else 1.0)


def by_sampling(request):
    """Ask for Monte Carlo, if this does not take too long."""
    if request.tol >= least_sampled(request):
        yield lambda seed: request.ask(seed=seed, method=SAMPLED)


def looser(**options):
    """Ask for larger tolerances."""

    def runs(request):
        for factor in LOOSER:
            tol = factor * request.tol
            if tol <= LOOSEST * (1 if request.quantity != "variance" else math.inf):
                yield functools.partial(request.ask, tol, **options)

    return runs


def one_degree(solve):
    """Solve with a single polynomial degree, where the state is y and the noise white."""

    def runs(request):
        if request.scene.is_line:
            for degree in (4, 6, 8, 12, 16, 20):
                yield lambda seed, degree=degree: (solve(request, degree), "one degree")

    return runs


def one_grid(solve, levels=(0, 1, 2, 3, 4, 5), most=4):
    """Solve on a single tensor grid, of the same level in all of up to `most` variables."""

    def on(request, level):
        depth = tensor_grid.depth_for(request.tol)
        grid = tensor_grid.fitted(request.scene, depth, min(level, 1))
        return solve(request, replace(grid, levels=dict.fromkeys(grid.levels, level)))

    def runs(request):
        if 1 < request.scene.dimension <= most and "y" in request.scene.state:
            for level in levels if math.isfinite(request.scene.n) else ():
                yield lambda seed, level=level: (on(request, level), "one grid")

    return runs


def plain_growth(request):
    """Sample without pilots: the paths that three standard errors need, and some steps."""
    scene, tol = request.scene, request.tol

    def run(share, seed):
        paths = plain_paths(math.sqrt(SPREAD["gamma^2"]), tol)
        step = coarse_step(scene) * share
        sampling = Sampling(step, paths, (seed, "plain"), threads=1)
        found = slopes(integrals_at(scene, GROWTH_TIMES, sampling), GROWTH_TIMES)
        small = MONTE_CARLO.sigmas * found.gamma2_error <= tol * found.gamma2
        return found.gamma2 if small else None, SAMPLED

    if tol >= least_sampled(request):
        for share in STEPS:
            yield functools.partial(run, share)


def plain_variance(request):
    """Sample the variance at times in the same way."""
    scene, tol, times = request.scene, request.tol, request.given["times"]
    size = gamma_scale(scene)

    def run(share, seed):
        paths = plain_paths(size * math.sqrt(SPREAD["variance"]), tol)
        step = min(coarse_step(scene), times[-1] / 32) * share
        found = moments(gram(scene, times, Sampling(step, paths, (seed, "plain"), threads=1)))
        small = np.all(MONTE_CARLO.sigmas * found["variance_error"] <= tol * times)
        return found["variance"] if small else None, SAMPLED

    if tol >= least_sampled(request):
        for share in STEPS:
            yield functools.partial(run, share)


def plain_crossing(request):
    """Sample crossing probabilities in the same way; the true W tells the number of paths."""
    scene, tol = request.scene, request.tol

    def run(share, seed):
        W = request.reference[0]
        paths = plain_paths(math.sqrt(np.max(W * (1 - W))), tol)
        step, own = coarse_step(scene) * share, (seed, "plain")
        sampling = Sampling(step, paths, own, threads=1)
        counts = first_passage_counts(scene, **request.given, sampling=sampling)
        return np.cumsum(counts) / paths, SAMPLED

    if tol >= least_sampled(request):
        for share in STEPS:
            yield functools.partial(run, share)


def plain_paths(deviation, tol):
    """Paths whose three standard errors are the tolerance."""
    return max(100, math.ceil((MONTE_CARLO.sigmas * deviation / tol) ** 2))


def asymptotic(request):
    """Take the limit of large p, which does not state its error."""

    def run(seed):
        found = ns.crossing_probability(request.scene, **request.given, method="asymptotic")
        return found["probability"].values, "asymptotic"

    if request.scene.dimension < 3:
        yield run


def by_correction(order):
    """Take a corrected formula, where the state is y and the noise white."""

    def runs(request):
        if request.scene.is_line:
            yield lambda seed: request.ask(method="corrected", order=order)

    return runs


def moments_on_degree(request, degree):
    """Expand v in eigenfunctions."""
    return eigenfunctions.moments(request.scene, request.given["times"], degree)[1]


def growth_on_degree(request, degree):
    """Expand gamma^2 in eigenfunctions."""
    return eigenfunctions.asymptotic_variance(request.scene, degree)


def gap_on_degree(request, degree):
    """Compute the gap."""
    return eigenfunctions.spectrum(request.scene, degree).rates[1]


def growth_on(request, grid):
    """Solve for gamma^2."""
    return gamma2_on_grids.gamma2_on(request.scene, grid)(0.02 * request.tol)


def moments_on(request, grid):
    """Solve for v."""
    times = request.given["times"]
    return moments_on_grids.moments_on(request.scene, grid, times, 0.05 * request.tol * times)[0][1]


def gap_on(request, grid):
    """Compute the gap."""
    return gap_on_grid(request.scene, grid, 1e-2 * request.tol)[0]


# References


def more_resolved(request, factors=(FINER, RESOLVED), **options):
    """Ask the same function for a tenth of the tolerance or, if it refuses, for half of it."""
    for factor in factors:
        try:
            return request.ask(request.tol / factor, seed=99, **options)[0], 1 / factor
        except ToleranceError as error:
            refused = error
    raise refused


def sampled(request):
    """Sample with other random numbers, to half of the tolerance."""
    return more_resolved(request, (RESOLVED,), method="monte_carlo")


def true_growth(request):
    """Take another method if there are one, three or four variables."""
    scene = request.scene
    many = scene.dimension
    if many == 1:
        return eigenfunctions.asymptotic_variance(request.scene, 24), 0.0
    if many == 2:
        return more_resolved(request)
    if many == 3:
        try:
            return more_resolved(request, (RESOLVED,), method="deterministic")
        except ToleranceError as error:
            print(request, error, file=sys.stderr)
    if scene.model == "elasto_plastic" and scene.observable == "y":
        # the integrals differ by the bounded displacement, and this one is sampled faster
        scene = replace(scene, observable="plastic_strain_rate")
    return sampled(replace(request, scene=scene))


def true_variance(request):
    """Resolve more finely, by the same method or by Monte Carlo."""
    scene = request.scene
    if scene.dimension == 1:
        return moments_on_degree(request, 28), 0.0
    if scene.dimension == 2 and math.isfinite(scene.n):
        return more_resolved(request)
    return sampled(request)


def true_crossing(request):
    """Take the deterministic method, where there is one."""
    if request.scene.is_line:
        finest = request.tol / min(request.tol / FINER, 1e-6)
        try:
            return more_resolved(request, (finest, FINER, RESOLVED), method="deterministic")
        except ToleranceError as error:
            print(request, error, file=sys.stderr)
    return sampled(request)


def true_density(request):
    """Resolve more."""
    return more_resolved(request, (RESOLVED,))


def true_gap(request):
    """Resolve more."""
    if request.scene.is_line:
        return gap_on_degree(request, 28), 0.0
    return more_resolved(request)


def true_length(request):
    """Resolve more."""
    return more_resolved(request, (RESOLVED,))


def relative(request, values, reference):
    """Measure the error relative to the reference."""
    return abs(values - reference) / abs(reference)


def absolute(request, values, reference):
    """Measure the largest error."""
    return np.max(np.abs(values - reference))


def at_points(request, values, reference):
    """Measure the largest error of densities at points; others are averages, and unknown here."""
    return np.nanmax(np.abs(values - reference))


def over_time(request, values, reference):
    """Measure the largest error of v / tau."""
    return np.max(np.abs(values - reference) / request.given["times"])


# To add a method is to add its line to `stated`, if it knows its error, or to `bare`.
QUANTITIES = {
    "gamma^2": Quantity(
        60,
        some_growth,
        true_growth,
        relative,
        {
            "looser": looser(),
            "monte_carlo": by_sampling,
            "deterministic": by("deterministic"),
        },
        {
            "one degree": one_degree(growth_on_degree),
            "one grid": one_grid(growth_on),
            "plain Monte Carlo": plain_growth,
        },
    ),
    "variance": Quantity(
        50,
        some_variance,
        true_variance,
        over_time,
        {
            "looser": looser(),
            "monte_carlo": by_sampling,
            "deterministic": by("deterministic"),
        },
        {
            "one degree": one_degree(moments_on_degree),
            "one grid": one_grid(moments_on, most=2),
            "plain Monte Carlo": plain_variance,
        },
    ),
    "crossing": Quantity(
        50,
        some_crossing,
        true_crossing,
        absolute,
        {
            "looser": looser(),
            "corrected, order 1": by_correction(1),
            "corrected, order 2": by_correction(2),
            "corrected, order 3": by_correction(3),
            "monte_carlo": by_sampling,
            "deterministic": by("deterministic"),
            "looser deterministic": looser(method="deterministic"),
        },
        {"asymptotic": asymptotic, "plain Monte Carlo": plain_crossing},
    ),
    "density": Quantity(15, some_density, true_density, at_points, {"looser": looser()}, {}),
    "spectral gap": Quantity(
        15,
        some_gap,
        true_gap,
        relative,
        {"looser": looser()},
        {"one degree": one_degree(gap_on_degree), "one grid": one_grid(gap_on)},
    ),
    "extrapolation length": Quantity(
        10, some_length, true_length, absolute, {"looser": looser()}, {}
    ),
}


# Measurement


def empty_caches():
    """Forget what has been computed for scenes; compiled formulas stay."""
    for kept in (
        quadrature.solved,
        milne.layer_constants,
        tail_equation.equation,
        tail_equation.reach,
    ):
        kept.cache_clear()


class Dearer(Exception):
    """Raised where a run has taken longer than it may."""


def stop(*_):
    """Stop a run, between two calls of compiled code."""
    raise Dearer


def timed(run, most=math.inf):
    """Return seconds of one core, and the result: None if it was refused or took over `most`."""
    seconds, result = [], None
    signal.signal(signal.SIGPROF, stop)
    while not seconds or (seconds[0] < SHORT and len(seconds) < REPEATS):
        empty_caches()
        began = time.process_time()
        try:
            try:
                signal.setitimer(signal.ITIMER_PROF, min(most, 1e6))
                result = run()
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)  # here it may still ring
        except (Dearer, NonsmoothError, np.linalg.LinAlgError, ValueError, RuntimeError):
            result = None
        seconds.append(time.process_time() - began)
    return min(seconds), result


def warm(request):
    """Compile what the scene's formulas need."""
    step = coarse_step(request.scene)
    sampling = Sampling(step, 16, 0, threads=1)
    gram(request.scene, [4 * step], sampling)
    coupled(request.scene, [4 * step], sampling)
    first_passage_counts(request.scene, 1.0, [4 * step], 1.0, sampling)


def measure(request):
    """Answer a request: rows of (kind, name, seconds, error over tol), the library's own first.

    Nothing is judged where there is no reference.
    """
    warm(request)
    quantity = QUANTITIES[request.quantity]
    chosen = ["refused"]

    def judged(run, most=math.inf):
        seconds, found = timed(run, most)
        if found is None or found[0] is None:
            return seconds, math.nan
        chosen[:] = found[1:]
        with np.errstate(all="ignore"):
            error = quantity.distance(request, np.asarray(found[0]), request.reference[0])
        return seconds, float(error / request.tol)

    if timed(lambda: request.reference, REFERENCE)[1] is None:
        print(request, "has no reference", file=sys.stderr)
        seconds, found = timed(lambda: request.afresh().ask(), REFERENCE)
        return [("library", "refused" if found is None else found[1], seconds, math.nan)]
    loose = max(request.tol, min(LOOSER[0] * request.tol, LOOSEST))
    timed(lambda: request.afresh().ask(loose))  # loads what was compiled
    seconds, error = judged(lambda: request.afresh().ask())
    rows = [("library", *chosen, seconds, error)]
    for kind in ("stated", "bare"):
        for name, family in getattr(quantity, kind).items():
            for run in family(request.afresh()):
                most = 1.2 * seconds + OVERHEAD
                took, off = judged(functools.partial(run, seed=SEEDS[0]), most)
                if off <= 1 and took < seconds and chosen == [SAMPLED]:  # by luck?
                    others = [judged(functools.partial(run, seed=k), most) for k in SEEDS[1:]]
                    off = float(np.max([off, *(other for _, other in others)]))
                rows.append((kind, name, took, off))
                if off <= 1 or took > seconds:  # the rest are dearer
                    break
    return rows


def summary(rows):
    """Compare the library's time with the least of those whose error is below the tolerance."""
    _, method, seconds, error = rows[0]
    best = {}
    for kinds in (("stated",), ("stated", "bare")):
        right = [(t, name) for kind, name, t, off in rows[1:] if kind in kinds and off <= 1]
        least, name = min(right, default=(seconds, method))
        least, name = (seconds, method) if seconds <= least else (least, name)
        best[kinds[-1]] = (seconds + OVERHEAD) / (least + OVERHEAD), name
    return {
        "method": method,
        "seconds": seconds,
        "error/tol": error,
        "ratio": best["stated"][0],
        "best": best["stated"][1],
        "ratio, bare too": best["bare"][0],
        "best, bare too": best["bare"][1],
    }


def table(found):
    """Sum up by quantity."""
    lines = {}
    for name, part in [*found.groupby("quantity", sort=False), ("all", found)]:
        lines[name] = {
            "requests": len(part),
            "wrong": int(np.sum(part["error/tol"] > 1)),
            "refused": int(np.sum(part["method"] == "refused")),
            "not judged": int(np.sum(part["error/tol"].isna() & (part["method"] != "refused"))),
            "largest error/tol": part["error/tol"].max(),
            "seconds": part["seconds"].sum(),
        }
        for what in ("ratio", "ratio, bare too"):
            lines[name] |= {
                f"{what}: median": part[what].median(),
                "90 %" + " " * (what != "ratio"): part[what].quantile(0.9),
                "largest" + " " * (what != "ratio"): part[what].max(),
                f"above {LIMIT:g}" + " " * (what != "ratio"): int(np.sum(part[what] > LIMIT)),
            }
    return pd.DataFrame(lines)


def main(arguments):
    """Measure and print the table."""
    warnings.simplefilter("ignore")
    divisor = int(next((a for a in arguments if a.isdigit()), 1))
    names = tuple(a for a in arguments if not a.isdigit())
    requests = (
        quantity.draw(np.random.default_rng((SEED, place, index)))
        for place, (name, quantity) in enumerate(QUANTITIES.items())
        for index in range(quantity.count // divisor)
        if name.startswith(names or "")
    )
    OUTPUT.mkdir(parents=True, exist_ok=True)
    found = []
    with (OUTPUT / f"{'_'.join(names) or 'all'}.csv").open("w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(COLUMNS)
        for number, request in enumerate(requests):
            rows = measure(request)
            own = [number, request.quantity, request.scene.dimension, request.scene]
            own += [{k: v for k, v in request.given.items() if k != "points"}, f"{request.tol:.3g}"]
            lines.writerows([*own, *row[:2], *(f"{x:.4g}" for x in row[2:])] for row in rows)
            file.flush()
            found.append({"quantity": request.quantity} | summary(rows))
            told = found[-1]
            if not (told["error/tol"] <= 1 and told["ratio, bare too"] <= LIMIT):
                print(*own, told, file=sys.stderr, flush=True)
    print(table(pd.DataFrame(found)).to_string(float_format="{:.3g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
