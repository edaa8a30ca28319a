"""Whether the errors hold that grids of two variables state, of kappa, densities and others.

`python -m benchmarks.honesty_on_grids` prints one line per quantity; arguments choose quantities by
their first words, `--first` the first seed and `--scenes` how many. Each random scene is solved to
a tolerance and to a far smaller one. A value is wrong if the two are further apart than what they
state together. What misses a tolerance is judged by the error that it states.
"""

import argparse
import sys
import time
import warnings

import numpy as np
import pandas as pd

import nonsmooth as ns
from benchmarks.honesty import FORCINGS, POTENTIALS, formula
from nonsmooth.boundary_layer.sampled import sampled_kappa
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids import tensor_grid

OBSERVABLES = {
    "elasto_plastic": ("y", "x*y**2 + y"),
    "obstacle": ("x", "x + sin(x)"),
    "friction": ("x", "x"),
}


def scene(rng):
    """Draw a scene with two variables and odd g: soft and stiff, hardly and strongly damped."""
    model = ("elasto_plastic", "obstacle", "friction")[rng.integers(3)]
    noise, damping = ns.White(rng.uniform(0.3, 2)), 10 ** rng.uniform(-1.3, 0.7)
    U, choices = formula(rng, POTENTIALS), OBSERVABLES[model]
    if model == "friction" and rng.random() < 0.7:
        noise, U = ns.Langevin(formula(rng, FORCINGS), rng.uniform(0.5, 2)), "0"
        choices = ("y", "y + sin(y)")
    n, g = 10 ** rng.uniform(0.3, 4), choices[rng.integers(2)]
    return ns.Scene(model, noise, n, damping, U, g)


def number(ask):
    """Return a function that asks for a number and returns it as an array, with its error."""

    def answer(scene, tol):
        found, met = reached(lambda: ask(scene, tol))
        return None if found is None else (np.array([found.value]), np.array([found.error])), met

    return answer


def density(scene, tol):
    """Return all densities, and their errors, each relative to its largest value."""
    ends = tensor_grid.fitted(scene, 10.0, 1).ends
    points = {symbol.name: np.linspace(-end, end, 101) for symbol, end in ends.items()}
    found, met = reached(lambda: ns.invariant_density(scene, tol, points, "deterministic"))
    if found is None:
        return None, met
    values, errors = [], []
    for name in (name for name in found if not name.endswith("_error")):
        size = float(found[name].max())
        values.append(found[name].values.ravel() / size)
        errors.append(np.full(found[name].size, float(found[f"{name}_error"]) / size))
    return (np.concatenate(values), np.concatenate(errors)), met


def growth(scene, tol):
    """Return v(tau)/tau at early, middle and late times, and their errors."""
    times = np.array([0.3, 3.0, 10.0])
    found, met = reached(lambda: ns.variance(scene, times, tol, "deterministic"))
    if found is None:
        return None, met
    return (found["v"].values / times, found["v_error"].values / times), met


def reached(call):
    """Call, and take what is reached where the tolerance is missed; None if nothing is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return call(), True
        except ToleranceError as refused:
            return refused.result, False
        except SceneError as refused:  # of oscillations that hardly diffuse
            print(refused, file=sys.stderr)
            return None, False


def length(scene, tol):
    """Sample kappa if no tolerance is given, as with more variables; else solve for it."""
    return sampled_kappa(scene, threads=1) if tol is None else ns.extrapolation_length(scene, tol)


def slope(parameter):
    """Return a function that asks for the derivative of gamma^2 by a parameter."""
    return number(lambda scene, tol: ns.asymptotic_variance_sensitivity(scene, parameter, tol))


# for each quantity: how it is found, its tolerance, that of the reference, how many scenes
QUANTITIES = {
    "kappa": (number(ns.extrapolation_length), 3e-3, 3e-4, 40),
    "sampled kappa": (number(length), None, 3e-3, 20),
    "density": (density, 1e-2, 1e-3, 40),
    "spectral gap": (number(ns.spectral_gap), 1e-3, 1e-6, 60),
    "variance": (growth, 1e-3, 2e-5, 40),
    "derivative by damping": (slope("damping"), 1e-3, 2e-5, 60),
    "derivative by n": (slope("n"), 1e-3, 2e-5, 60),
}


def compare(ask, tol, fine, seed):
    """One random scene: true and stated error, that of the reference, seconds, whether met."""
    drawn = scene(np.random.default_rng(seed))
    began = time.process_time()
    found, met = ask(drawn, tol)
    seconds = time.process_time() - began
    reference, _ = ask(drawn, fine)
    if found is None or reference is None:
        print(f"{seed}: {drawn}: nothing is known", file=sys.stderr, flush=True)
        return None
    true = np.abs(found[0] - reference[0])
    worst = np.argmax(true / (found[1] + reference[1]))
    row = true[worst], found[1][worst], reference[1][worst]
    verdict = "wrong" if row[0] > row[1] + row[2] else "right" if met else "refused, right"
    print(
        f"{seed}: {drawn}: {verdict}: error {row[0]:.1e}, stated {row[1]:.1e}, of the reference "
        f"{row[2]:.1e}, {seconds:.1f} s",
        file=sys.stderr,
        flush=True,
    )
    return *row, seconds, met


def main(arguments):
    """Measure the quantities and print the table."""
    parser = argparse.ArgumentParser(description="stated against true errors on grids")
    parser.add_argument("quantities", nargs="*", help="their first words; all unless given")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, help="how many of each quantity")
    chosen, rows = parser.parse_args(arguments), {}
    for name, (ask, tol, fine, usual) in QUANTITIES.items():
        if chosen.quantities and not name.startswith(tuple(chosen.quantities)):
            continue
        seeds = range(chosen.first, chosen.first + (chosen.scenes or usual))
        results = [result for seed in seeds if (result := compare(ask, tol, fine, seed))]
        true, stated, uncertain, seconds, met = np.array(results).T
        ratio = true / (stated + uncertain)
        rows[name] = {
            "scenes": len(seeds),
            "nothing known": len(seeds) - len(true),
            "tolerance missed": int(np.sum(met == 0)),
            "wrong": int(np.sum(ratio > 1)),
            "true/stated: median": np.median(ratio),
            "largest": ratio.max(),
            "seconds: median": np.median(seconds),
            "longest": seconds.max(),
        }
    print(pd.DataFrame(rows).T.to_string(float_format="{:.2g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
