"""Crossing probabilities from frequent to rare: relative error against time."""

from contextlib import ExitStack
from functools import cache, partial
from pathlib import Path

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs.job import produce
from reproduction.rendering.tables import scientific
from reproduction.speed_against_error.work_precision import Case, measured, peer, timed, unseeded

PEERS = Path("benchmarks/peers/subset_simulation.py")


def rare(n, horizon, p, step, scenes, counted, led, levels, rounds, python):
    """Measure W(sqrt(p) b, p T) of dry friction by every method, on one core.

    Parameters
    ----------
    n, horizon, p, step : float
        Penalization, T, scale, and time step of all simulations.
    scenes : dict
        Noise -> `thresholds`, a list of b, one panel each, and `tolerances`, a list of errors asked
        of the deterministic solution in units of W. The smallest gives the reference, whose error
        is the one that it states.
    counted, led, levels : list of int
        Paths of Monte Carlo, of importance sampling, and of each level of subset simulation. Monte
        Carlo leaves out those of which fewer than ten would cross.
    rounds : int
    python : str or None
        Interpreter with the peers; without it they are left out.

    Returns
    -------
    xarray.Dataset
    """
    cases, references = [], {}
    problems = [(noise, b) for noise, given in scenes.items() for b in given["thresholds"]]
    with ExitStack() as stack:
        library = python and stack.enter_context(peer(python, PEERS))
        for noise, threshold in problems:
            scene, tolerances = Scene("friction", noise, n=n), scenes[noise]["tolerances"]
            asked = partial(crossing_probability, scene, threshold, [horizon], p, threads=1)
            rough = float(asked(method="importance_sampling")["probability"][0])
            best = asked(method="deterministic", tol=min(tolerances) * rough)
            W, doubt = (float(best[name][0]) for name in ("probability", "probability_error"))
            panel = f"{noise} noise, $W =$ {scientific(W)}"
            references[panel] = 1.0, doubt / W
            runs = []
            for count in counted:
                if count * W >= 10:
                    run = timed(_counted, scene, threshold, horizon, p, step, count)
                    runs.append(("Monte Carlo", count, run))
            for count in led:
                runs.append(("importance sampling", count, timed(_led, asked, step, count)))
            for tol in tolerances:
                run = _once(timed(unseeded(_solved), asked, tol * rough))
                runs.append(("deterministic", tol, run))
            common = {"noise": noise, "n": n, "threshold": threshold, "horizon": horizon, "p": p}
            for paths in levels if library else ():
                run = library(method="subset simulation", step=step, paths=paths, **common)
                runs.append(("subset simulation, OpenTURNS", paths, run))
            cases += [Case(panel, name, size, _relative(run, W)) for name, size, run in runs]
        return measured(
            "Speed against relative error of crossing probabilities, from frequent to rare",
            f"W of dry friction, n = {n:g}, p = {p:g}, T = {horizon:g}, in units of W; all "
            f"simulations with the step {step:g}, one core; reference: the deterministic solution",
            cases,
            rounds,
            references,
        )


def _once(run):
    """Solve once for all rounds: without chance it is always the same, and may take long."""
    kept = cache(run)
    return lambda seed: kept(0)


def _counted(scene, threshold, horizon, p, step, paths, seed):
    own = labelled(seed, f"{threshold:g} {paths}")
    sampling = Sampling(step, paths, own, threads=1)
    return first_passage_counts(scene, threshold, [horizon], p, sampling)[0] / paths


def _led(asked, step, paths, seed):
    # the tolerance is out of the way: it is the number of paths that is given
    sizes = {"step": step, "paths": paths, "tol": 1.0}
    own = labelled(seed, str(paths))
    return asked(method="importance_sampling", seed=own, **sizes)["probability"][0]


def _solved(asked, tol):
    return asked(method="deterministic", tol=tol)["probability"][0]


def _relative(run, W):
    def relative(seed):
        value, seconds = run(seed)
        return value / W, seconds

    return relative


if __name__ == "__main__":
    produce(rare, snakemake)
