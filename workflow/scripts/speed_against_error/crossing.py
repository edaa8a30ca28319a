"""Crossing probabilities by Monte Carlo, deterministically and by formula: error against time."""

from itertools import product

import numpy as np
from scipy.special import binom

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.crossing.first_passage.contours import hyperbola
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs.job import produce
from reproduction.speed_against_error.work_precision import Case, measured, timed, unseeded

SECTOR = 0.3  # half angle of the contour about the negative axis


def crossing(n, threshold, horizon, p, steps, paths, degrees, contours, tolerance, rounds):
    """Measure W(sqrt(p) b, p T) at each p by every method, on one core.

    Parameters
    ----------
    n, threshold, horizon : float
        Penalization, b and T.
    p : list of float
    steps : list of float
        Time steps of Monte Carlo.
    paths : list of int
        At the largest p. At smaller ones there are more, in inverse proportion to sqrt(p).
    degrees, contours : list of int
        Polynomial degree and nodes of the contour, of single deterministic solutions.
    tolerance : float
        Of the deterministic solution with an error bound.
    rounds : int

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene("friction", n=n)
    cases, references = [], {}
    for scale in p:
        panel = f"$p = {scale:g}$"
        references[panel] = on_a_line(scene, threshold, horizon, scale)
        for step, count in product(steps, paths):
            more = round(count * np.sqrt(max(p) / scale))
            run = timed(_counted, scene, threshold, horizon, scale, step, more)
            cases.append(Case(panel, "Monte Carlo, Strang", step, run))
        for degree, contour in zip(degrees, contours, strict=True):
            run = timed(unseeded(_inverted), scene, threshold, horizon, scale, degree, contour)
            cases.append(Case(panel, "deterministic, one solution", degree, run))
        for name, size, options in (
            (
                "deterministic, with error bound",
                tolerance,
                {"method": "deterministic", "tol": tolerance},
            ),
            ("asymptotic formula", 0, {"method": "asymptotic"}),
            ("corrected formula, order 1", 1, {"method": "corrected", "order": 1}),
            ("corrected formula, order 2", 2, {"method": "corrected", "order": 2}),
            ("corrected formula, order 3", 3, {"method": "corrected", "order": 3}),
        ):
            run = timed(unseeded(_by), scene, threshold, horizon, scale, **options)
            cases.append(Case(panel, name, size, run))
    return measured(
        "Speed against error of crossing probabilities",
        f"W of dry friction with white noise, n = {n:g}, b = {threshold:g}, T = {horizon:g}, one "
        "core; reference: another inversion of the Laplace transform, on a finer grid",
        cases,
        rounds,
        references,
    )


def _counted(scene, threshold, horizon, p, step, paths, seed):
    own = labelled(seed, f"{p:g} {step:g} {paths}")
    sampling = Sampling(step, paths, own, threads=1)
    crossed = first_passage_counts(scene, threshold, [horizon], p, sampling)
    return crossed[0] / paths


def _by(scene, threshold, horizon, p, **options):
    return crossing_probability(scene, threshold, [horizon], p, **options)["probability"][0]


def _inverted(scene, threshold, horizon, p, degree, nodes):
    """Solve once, without a second solution that would tell the error."""
    level, time = threshold * np.sqrt(p), p * horizon
    grid = ordinates(scene, degree, time)
    contour = hyperbola(time, 1.01 * time, nodes, SECTOR)
    values = [modes(grid, z).first_passage(-level, level) / z for z in contour.nodes]
    return contour.invert(np.array(values), np.array([time]))[0]


def on_a_line(scene, threshold, horizon, p, decay=18.4, terms=15, averaged=11):
    """Invert the Laplace transform on a vertical line, by Abate and Whitt's Euler summation.

    It shares the modes with the method it judges, but neither the contour nor the grid.

    Parameters
    ----------
    scene : Scene
    threshold, horizon, p : float
    decay : float
        A: replacing the integral by a series has an error of exp(-A).
    terms, averaged : int
        Terms of the alternating series, and the number of further partial sums that are averaged.

    Returns
    -------
    value, error : float
        The error is exp(-A) and the difference of two grids.
    """
    level, time = threshold * np.sqrt(p), p * horizon
    k = np.arange(terms + averaged + 1)
    # the points lie between the usual ones, so that none is on the real axis
    nodes = (decay / 2 + 1j * np.pi * (k + 0.5)) / time
    values = []
    for degree in (10, 13):
        grid = ordinates(scene, degree, time, grading=2.5)
        transform = np.array([modes(grid, z).first_passage(-level, level) / z for z in nodes]).imag
        sums = -np.exp(decay / 2) / time * np.cumsum((-1.0) ** k * transform)
        values.append(binom(averaged, np.arange(averaged + 1)) @ sums[terms:] / 2.0**averaged)
    return float(values[1]), float(np.exp(-decay) + abs(values[1] - values[0]))


if __name__ == "__main__":
    produce(crossing, snakemake)
