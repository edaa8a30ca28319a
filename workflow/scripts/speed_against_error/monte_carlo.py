"""E Delta(T)^2 / T of dry friction by Monte Carlo: total error against time."""

import sys
from contextlib import ExitStack
from itertools import product
from pathlib import Path

from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import moments
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.variance import variance
from reproduction.jobs.job import produce
from reproduction.speed_against_error.work_precision import Case, measured, peer, timed

PEERS = Path("benchmarks/peers/simulations.py")
# name -> scheme, control variate
FINITE = {
    "Euler-Maruyama": ("euler_maruyama", False),
    "drift-implicit Euler": ("drift_implicit", False),
    "Lie": ("lie", False),
    "Strang": ("strang", False),
    "Strang, control variate": ("strang", True),
}
LIMIT = {
    "drift-implicit Euler": ("drift_implicit", False),
    "Lie": ("lie", False),
    "Strang": ("strang", False),
    "Strang, control variate": ("strang", True),
    "exact dry friction": ("dry_friction", False),
}
LIBRARIES = ("torch", "torchsde", "diffrax")
LOOP = "plain numba loop"


def monte_carlo(horizon, n, steps, paths, peer_steps, peer_paths, rounds, python):
    """Measure every scheme at each step and number of paths, on one core.

    Parameters
    ----------
    horizon : float
        T.
    n : float
        Finite penalization, beside the limit.
    steps, peer_steps : list of float
        Time steps; a scheme leaves out those at which it is unstable.
    paths, peer_paths : list of int
    rounds, python
        As for `pde`.

    Returns
    -------
    xarray.Dataset
        The total error: over rounds with different seeds, bias and chance together.
    """
    cases, references = [], {}
    with ExitStack() as stack:
        loop = stack.enter_context(peer(sys.executable, PEERS))
        library = python and stack.enter_context(peer(python, PEERS))
        for penalization, methods in ((float(n), FINITE), (float("inf"), LIMIT)):
            scene = Scene("friction", n=penalization)
            panel = r"$n = \infty$" if penalization == float("inf") else f"$n = {n:g}$"
            exact = variance(scene, [horizon])
            references[panel] = tuple(float(exact[name][0]) / horizon for name in ("v", "v_error"))
            for (name, (scheme, control)), step, count in product(methods.items(), steps, paths):
                if not step < registry.longest_step(scene, scheme):
                    continue
                run = timed(sampled, scene, horizon, step, count, scheme, control)
                cases.append(Case(panel, name, step, run))
            if penalization == float("inf"):
                continue
            for step, count in product(peer_steps, peer_paths):
                size = {"n": n, "horizon": horizon, "step": step, "paths": count}
                cases.append(Case(panel, LOOP, step, loop(method=LOOP, **size)))
                for name in LIBRARIES if library else ():
                    cases.append(Case(panel, name, step, library(method=name, **size)))
        return measured(
            "Speed against error of Monte Carlo",
            f"E Delta(T)^2 / T of dry friction with white noise, T = {horizon:g}, one core; "
            "reference: spectral elements",
            cases,
            rounds,
            references,
        )


def sampled(scene, horizon, step, paths, scheme, control, seed):
    """Estimate the variance of Delta(T), whose mean is 0, over T."""
    own = labelled(seed, f"{scheme} {step:g} {paths}")
    sums = gram(scene, [horizon], Sampling(step, paths, own, threads=1, scheme=scheme), control)
    return moments(sums)["variance"][0] / horizon


if __name__ == "__main__":
    produce(monte_carlo, snakemake)
