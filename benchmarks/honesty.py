"""Whether the stated errors of gamma^2 are larger than the true ones, on random scenes.

`python -m benchmarks.honesty` prints one line per class of scenes; arguments choose classes by
their first words, `--first` the first seed and `--scenes` how many, so that other scenes can be
tried. A value is wrong if it is further from the reference than both errors together.
"""

import argparse
import sys
import time
from dataclasses import replace

import numpy as np
import pandas as pd
import sympy
from mpmath import mp

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.scenes.symbols import x
from tests.exact_gamma2 import (
    Reference,
    langevin_gamma2,
    linear_reference,
    random_linear,
    random_velocity,
)

POTENTIALS = ("{a}*x**2/2", "{a}*x**2/2 + {b}*cos(3*x)", "x**2/2 + {a}*exp(-2*x**2)", "{a}*x**4/4")
FORCINGS = ("{a}*eta**2/2", "eta**4/4 + {a}*eta**2/2", "eta**4/4 - {a}*eta**2/2")


def formula(rng, choices):
    """Draw a formula and its coefficients."""
    text = choices[rng.integers(len(choices))]
    return text.format(a=round(rng.uniform(0.5, 2), 3), b=round(rng.uniform(-0.5, 0.5), 3))


def stiffness(rng):
    """Draw n between 1 and 1e4, one in eight of them infinite."""
    return np.inf if rng.random() < 1 / 8 else 10 ** rng.uniform(0, 4)


def one_variable(rng):
    """Dry friction with white noise, against mpmath to 20 digits."""
    scene, g, kinks = random_velocity(rng)
    with mp.workdps(60):
        return scene, 1.0, (float(Reference(scene, g, kinks).variance()), 0.0)


def linear(noise, tol):
    """Linear scenes, against their moments."""

    def draw(rng):
        square = bool(rng.random() < 0.5)
        scene = ns.Scene(**random_linear(rng, noise), observable="x**2" if square else "x")
        return scene, tol, (linear_reference(scene, square), 0.0)

    return draw


def yield_balance(rng):
    """Elasto-plastic oscillators with g the force that resists the noise, against sigma^2."""
    noise, damping = ns.White(rng.uniform(0.5, 2)), rng.uniform(0.3, 3)
    scene = ns.Scene("elasto_plastic", noise, stiffness(rng), damping, formula(rng, POTENTIALS))
    g = f"{sympy.diff(scene.potential_expression, x)} + {damping!r}*y"
    return replace(scene, observable=g), 1e-5, (noise.sigma**2, 0.0)


def friction_balance(rng):
    """Friction with g the force that resists the forcing, against gamma^2 of the forcing itself."""
    noise, damping = ns.Langevin(formula(rng, FORCINGS), rng.uniform(0.7, 1.5)), rng.uniform(0.3, 3)
    n = 10 ** rng.uniform(0, 4)
    g = f"{damping!r}*y + max(min({n!r}*y, 1), -1)"
    return ns.Scene("friction", noise, n, damping, observable=g), 1e-5, langevin_gamma2(noise)


def nonlinear(rng):
    """Scenes with two variables, against runs of a hundredth of the tolerance."""
    model = ("elasto_plastic", "obstacle", "friction", "friction")[rng.integers(4)]
    noise, damping, n = ns.White(rng.uniform(0.5, 2)), rng.uniform(0.3, 3), stiffness(rng)
    observables = {
        "elasto_plastic": ("y", "y", "y**2", "x*y**2 + y"),
        "obstacle": ("x", "x**2", "y**2", "abs(x)", "sin(x) + x**2"),
        "friction": ("x", "y**2", "x**2"),
    }[model]
    if model == "friction" and rng.random() < 0.5:
        noise = ns.Langevin(formula(rng, FORCINGS), rng.uniform(0.7, 2))
        observables = ("y", "y", "y**2", "abs(y)", "eta*y")
    g = observables[rng.integers(len(observables))]
    U = "0" if noise.kind == "langevin" else formula(rng, POTENTIALS)
    return ns.Scene(model, noise, n, damping, U, g), 1e-4, 100.0


def three_variables(rng):
    """Scenes with three variables, against runs of a tenth of the tolerance."""
    model = ("elasto_plastic", "obstacle", "friction")[rng.integers(3)]
    n, damping = 10 ** rng.uniform(0, 3), rng.uniform(0.5, 2)
    if model == "friction":
        a, b = rng.uniform(0.5, 2, 2).round(3)
        H = (f"{a}*eta**2/2 + zeta**2/2", f"eta**4/4 + {a}*eta**2/2 + zeta**2/2")[rng.integers(2)]
        F = (f"{b}", f"{b} + eta**2/(1 + eta**2)")[rng.integers(2)]
        noise, U = ns.Hamiltonian(H, F, rng.uniform(1, 2)), "0"
    else:
        noise = ns.Langevin(formula(rng, FORCINGS[:2]), rng.uniform(0.7, 1.5))
        U = formula(rng, POTENTIALS[:2])
    g = {"elasto_plastic": ("y",), "obstacle": ("x", "x**2"), "friction": ("y", "y**2")}[model]
    return ns.Scene(model, noise, n, damping, U, g[rng.integers(len(g))]), 3e-2, 10.0


CLASSES = {
    "one variable": (one_variable, 60),
    "linear, two variables": (linear("white", 1e-5), 56),
    "linear, three variables": (linear("langevin", 1e-3), 12),
    "linear, four variables": (linear("hamiltonian", 1e-2), 4),
    "balance, elasto-plastic": (yield_balance, 44),
    "balance, friction": (friction_balance, 32),
    "nonlinear, two variables": (nonlinear, 60),
    "nonlinear, three variables": (three_variables, 12),
}


def compare(draw, seed):
    """One random scene: the true error, the stated errors, the seconds; None where refused."""
    scene, tol, reference = draw(np.random.default_rng(seed))
    began = time.perf_counter()
    try:
        found = ns.asymptotic_variance(scene, tol, "deterministic")
        seconds = time.perf_counter() - began
        if isinstance(reference, float):
            tight = ns.asymptotic_variance(scene, tol / reference, "deterministic")
            reference = tight.value, tight.error
    except ToleranceError as error:
        print(f"{seed}: {scene}: {error}", file=sys.stderr)
        return None
    exact, uncertain = reference
    true = abs(found.value - exact)
    if true > found.error + uncertain:
        print(f"{seed}: {scene}: {found}, exact {exact:.12g}", file=sys.stderr)
    return true, found.error, uncertain, seconds


def main(arguments):
    """Measure the classes and print the table."""
    parser = argparse.ArgumentParser(description="stated against true errors of gamma^2")
    parser.add_argument("classes", nargs="*", help="their first words; all unless given")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, help="how many of each class")
    chosen = parser.parse_args(arguments)
    rows = {}
    for name, (draw, usual) in CLASSES.items():
        if chosen.classes and not name.startswith(tuple(chosen.classes)):
            continue
        count = chosen.scenes or usual
        seeds = range(chosen.first, chosen.first + count)
        results = [compare(draw, seed) for seed in seeds]
        true, stated, uncertain, seconds = np.array([r for r in results if r is not None]).T
        ratio = true / stated
        rows[name] = {
            "scenes": len(true),
            "refused": count - len(true),
            "wrong": int(np.sum(true > stated + uncertain)),
            "true/stated: median": np.median(ratio),
            "largest": ratio.max(),
            "seconds: median": np.median(seconds),
            "longest": seconds.max(),
        }
        print(pd.DataFrame([rows[name]], index=[name]).to_string(), flush=True, file=sys.stderr)
    print(pd.DataFrame(rows).T.to_string(float_format="{:.2g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
