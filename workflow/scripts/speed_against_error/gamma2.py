"""gamma^2 of every scene, deterministically and by Monte Carlo: error against time."""

from nonsmooth.line import eigenfunctions
from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.sampled_gamma2 import slopes
from reproduction.jobs.job import produce
from reproduction.speed_against_error.work_precision import Case, measured, timed, unseeded


def gamma2(solved, names, scenes, degrees, tolerances, times, step, paths, rounds):
    """Measure each scene, on one core; errors are relative.

    Parameters
    ----------
    solved : list of xarray.Dataset
        gamma^2 of table 5, one per name: the reference, by closed form for one variable and a finer
        grid for more. Monte Carlo tests it.
    names : list of str
    scenes : dict
        Name -> the scene's parameters and its threshold.
    degrees : list of int
        Of spectral elements for one variable.
    tolerances : list of list of float
        For two, three and four variables.
    times : list of float, three
        Between which Monte Carlo takes the slope.
    step : float
    paths : list of int
    rounds : int

    Returns
    -------
    xarray.Dataset
    """
    cases, references = [], {}
    for name, exact in zip(names, solved, strict=True):
        scene = Scene(**scenes[name]["scene"])
        value = float(exact["gamma2"])
        variables = scene.dimension
        panel = f"{scene.model.replace('_', '-')}, {scene.noise.kind} ({variables}-D)"
        references[panel] = 1.0, float(exact["gamma2_error"]) / value
        if variables == 1:
            for degree in degrees:
                run = timed(unseeded(_expanded), scene, degree, value)
                cases.append(Case(panel, "deterministic", degree, run))
        else:
            for tol in tolerances[variables - 2]:
                run = timed(unseeded(_solved), scene, tol, value)
                cases.append(Case(panel, "deterministic", tol, run))
        for count in paths:
            run = timed(_sampled, scene, times, step, count, value)
            cases.append(Case(panel, "Monte Carlo, Strang", count, run))
    return measured(
        "Speed against error of gamma^2",
        f"relative error of gamma^2, one core; Monte Carlo with the step {step:g}",
        cases,
        rounds,
        references,
    )


def _expanded(scene, degree, unit):
    return eigenfunctions.asymptotic_variance(scene, degree) / unit


def _solved(scene, tol, unit):
    return asymptotic_variance(scene, tol, "deterministic").value / unit


def _sampled(scene, times, step, paths, unit, seed):
    own = labelled(seed, f"growth {paths}")
    sample = integrals_at(scene, times, Sampling(step, paths, own, threads=1))
    return slopes(sample, times).gamma2 / unit


if __name__ == "__main__":
    produce(gamma2, snakemake)
