"""How the time grows with samples, horizon, p, n, state variables and cores."""

import os
from functools import partial

import numpy as np

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.line import eigenfunctions, finite_differences
from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from reproduction.jobs.job import produce
from reproduction.speed_against_error.work_precision import Case, measured, timed, unseeded

SIMULATED, SOLVED = "Monte Carlo, Strang", "deterministic"


def cost(paths, horizons, p, n, names, scenes, step, least, tolerance, paper_scheme, rounds):
    """Vary one size at a time and measure the time; the others stay at the first of their values.

    Parameters
    ----------
    paths : list of int
    horizons, p, n : list of float
    names : list of str
        Scenes of the sweep, by growing number of state variables.
    scenes : dict
        Name -> the scene's parameters and its threshold.
    step : float
        Of Monte Carlo.
    least : int
        Paths where their number is not varied.
    tolerance : float
        Relative, of gamma^2 in every number of variables.
    paper_scheme : dict
        `half_width`, `nodes` and `time_step` of the paper's scheme.
    rounds : int

    Returns
    -------
    xarray.Dataset
        `size` is what is varied.
    """
    scene = Scene("friction", n=n[0])
    work = partial(_simulated, step=step)
    first, cases = horizons[0], []

    def add(panel, method, size, function, *arguments, **options):
        cases.append(Case(panel, method, size, timed(function, *arguments, **options)))

    for count in paths:
        add("samples", SIMULATED, count, work, scene, first, paths=count)
        add("samples", "with control variate", count, work, scene, first, paths=count, control=True)
    for horizon in horizons:
        add("horizon", SIMULATED, horizon, work, scene, horizon, paths=least)
        add("horizon", SOLVED, horizon, unseeded(_expanded), scene, horizon)
        add("horizon", "paper's scheme", horizon, unseeded(_marched), scene, horizon, paper_scheme)
    for scale in p:
        add("$p$", SIMULATED, scale, _counted, scene, scale, step, least)
        add("$p$", SOLVED, scale, unseeded(_inverted), scene, scale)
    for k in n:
        stiff, paper = scene.with_n(k), {"step": 1 / k, "scheme": "euler_maruyama"}
        add("$n$", SIMULATED, k, work, stiff, first, paths=least)
        add("$n$", "Euler-Maruyama, step $1/n$", k, work, stiff, first, paths=least, **paper)
        add("$n$", SOLVED, k, unseeded(_expanded), stiff, first)
    for name in names:
        own, panel = Scene(**scenes[name]["scene"]), "state variables"
        solved = f"$\\gamma^2$ to {tolerance:g}"
        add(panel, SIMULATED, own.dimension, work, own, first, paths=least)
        add(panel, solved, own.dimension, unseeded(_gamma2), own, tolerance)
    for threads in range(1, os.cpu_count() + 1):
        add("cores", SIMULATED, threads, work, scene, first, paths=paths[-1], threads=threads)
    return measured(
        "Time against size",
        f"on one core but in the last panel; Monte Carlo with the step {step:g}",
        cases,
        rounds,
    )


def _simulated(scene, horizon, seed, step, paths, scheme="strang", control=False, threads=1):
    sampling = Sampling(step, paths, seed, threads=threads, scheme=scheme)
    sums = gram(scene, [horizon], sampling, control)
    return sums[0, 2, 2]


def _expanded(scene, horizon):
    return eigenfunctions.moments(scene, np.array([horizon]), 12)[1][0]


def _marched(scene, horizon, size):
    return finite_differences.moments(scene, [horizon], **size)[1][0]


def _counted(scene, p, step, paths, seed):
    # out of reach: every path is followed to the end
    sampling = Sampling(step, paths, seed, threads=1)
    return first_passage_counts(scene, 1e6, [2.0], p, sampling)[0]


def _inverted(scene, p):
    return crossing_probability(scene, 0.6, [2.0], p, method="deterministic")["probability"][0]


def _gamma2(scene, tolerance):
    return asymptotic_variance(scene, tolerance, "deterministic").value


if __name__ == "__main__":
    produce(cost, snakemake)
