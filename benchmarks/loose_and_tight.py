"""Whether answers at loose and at tight tolerances agree, for every question of random scenes.

`python -m benchmarks.loose_and_tight [first] [count]` draws scenes with one to four state
variables, asks each question for the tolerances of `TOLERANCES`, and compares the answers with each
other: two may differ by what both state, and by four standard errors where paths were drawn. It
also compares the seconds of neighbouring tolerances. Each question has a process of its own on one
core, which is ended after 100 seconds of processor time. A line per scene and question tells the
ratio of the difference to the errors stated, the seconds, and the last refusal; the last lines sum
up.
"""

import itertools
import sys
import time
import warnings
from collections.abc import Callable

import numpy as np
import pandas as pd

import nonsmooth as ns
from benchmarks.limited import sent
from nonsmooth.errors import NonsmoothError

LIMIT = 100  # seconds of processor time for a question
# by the number of variables, two in the limit count as three; relative to the size of what is
# asked for, where it has a unit
TOLERANCES = {
    1: (1e-1, 1e-2, 1e-3, 1e-5),
    2: (1e-1, 1e-2, 1e-3, 1e-4),
    3: (1e-1, 3e-2, 1e-2, 3e-3),
    4: (1e-1, 3e-2, 1e-2),
}
SLOWER, OVERHEAD = 1.2, 1.0  # a looser tolerance may take so many times as long, and seconds more
ERRORS_OF = "probability", "v", "hazard_rate", "threshold", "time", "derivative"
SAMPLED, STANDARD_ERRORS = ("monte_carlo", "Monte Carlo", "importance_sampling"), 4.0
POINTS = {name: np.linspace(-1.5, 1.5, 21) for name in ("x", "y", "eta", "zeta")}
FRICTION = ("y", "y", "y + 0.4*y**3/(1+y**2)", "tanh(2*y)", "y + 0.3*cos(2*y)", "y + 0.3*abs(y)")
POTENTIALS = ("0", "x**2/2", "x**2/2", "2*x**2", "x**4/4 + x**2/2", "x**2/2 + 0.3*cos(2*x)")


def draw(rng: np.random.Generator) -> ns.Scene:
    """Draw a scene."""
    model = ("friction", "elasto_plastic", "obstacle")[rng.integers(3)]
    sigma, kind = 10 ** rng.uniform(-0.3, 0.4), rng.random()
    noise = ns.White(sigma)
    if kind > 0.55:
        noise = ns.OrnsteinUhlenbeck(10 ** rng.uniform(-0.3, 0.5), sigma)
    if kind > 0.85:
        noise = ns.KanaiTajimi(10 ** rng.uniform(-0.3, 0.3), 10 ** rng.uniform(-0.2, 0.3), sigma)
    observables, potential = FRICTION, "0"
    if model == "obstacle":
        potential, observables = POTENTIALS[1 + rng.integers(5)], ("x", "x", "contact_force")
    elif model == "elasto_plastic":
        potential = POTENTIALS[1 + rng.integers(3)]
        observables = "y", "plastic_strain_rate"
    elif kind > 0.55:
        observables = "y", "friction_force"
    n = float(10 ** rng.uniform(0.0, 3.0)) if rng.random() < 0.85 else np.inf
    return ns.Scene(
        model,
        noise,
        n=n,
        damping=float(10 ** rng.uniform(-0.7, 0.6)),
        potential=potential,
        observable=observables[rng.integers(len(observables))],
        start={"y": round(rng.uniform(-1, 1), 3)} if rng.random() < 0.3 else {},
    )


def questions(scene: ns.Scene, rng: np.random.Generator) -> dict[str, Callable]:
    """From names to functions of a tolerance."""
    try:
        gamma2 = ns.asymptotic_variance(scene, tol=3e-2, threads=1).value
    except NonsmoothError:
        gamma2 = 1.0
    gamma2 = gamma2 or 1.0
    p, T, one = 10 ** rng.uniform(-0.5, 2.5), [0.3, 1.0, 3.0], {"threads": 1}
    b = np.sqrt(gamma2) * 10 ** rng.uniform(-0.4, 0.3)
    levels = (-b, b), (-np.inf, b), (-0.6 * b, b)
    interval = levels[rng.integers(3)]
    of_state = "x" if "x" in scene.state else "y"
    parameter = ("damping", "sigma")[rng.integers(2)]
    return {
        "gamma2": lambda tol: ns.asymptotic_variance(scene, tol, **one),
        "mean": lambda tol: ns.mean(scene, tol, **one),
        "variance": lambda tol: ns.variance(scene, [0.5, 5.0], tol * gamma2, **one),
        "spectral gap": lambda tol: ns.spectral_gap(scene, tol),
        "density": lambda tol: ns.invariant_density(
            scene, tol, {name: POINTS[name] for name in scene.state}
        ),
        "kappa": lambda tol: ns.extrapolation_length(scene, tol, **one),
        "crossing": lambda tol: ns.crossing_probability(scene, interval, T, p, tol=tol, **one),
        "deterministic": lambda tol: ns.crossing_probability(
            scene, interval, T, p, "deterministic", tol=tol
        ),
        "corrected": lambda tol: ns.crossing_probability(
            scene, interval, T, p, "corrected", tol=tol, **one
        ),
        "state": lambda tol: ns.state_crossing_probability(scene, of_state, 1.0, T, tol=tol, **one),
        "hazard rate": lambda tol: ns.hazard_rate(scene, interval, T, p, tol=tol, **one),
        "mean time": lambda tol: ns.mean_time_to_failure(scene, interval, p, tol=tol, **one),
        "failure time": lambda tol: ns.failure_time(scene, interval, 0.3, p, tol=tol, **one),
        "threshold": lambda tol: ns.crossing_threshold(scene, 0.2, T, p, tol=tol, **one),
        "sensitivity": lambda tol: ns.crossing_sensitivity(
            scene, interval, T, parameter, p, tol=tol, **one
        ),
        "gamma2's sensitivity": lambda tol: ns.asymptotic_variance_sensitivity(
            scene, parameter, tol
        ),
    }


def values(found) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return what was found, by names, each with the error that may be seen."""
    method = getattr(found, "method", None) or found.attrs.get("method", "")
    allowed = STANDARD_ERRORS if set(method.split(", ")) & set(SAMPLED) else 1.0
    if isinstance(found, ns.Estimate):
        return {"value": (np.array(found.value), allowed * np.array(found.error))}
    named = [name for name in found.data_vars if f"{name}_error" in found]
    # densities by Monte Carlo are averages over cells, which others are not
    density = [name for name in named if name.startswith("density")]
    solved = [name for name in density if "cell_methods" not in found[name].attrs]
    named = solved if density else [name for name in named if name in ERRORS_OF]
    return {name: (found[name].values, allowed * found[f"{name}_error"].values) for name in named}


def ask(question: Callable, tol: float, send: Callable) -> None:
    """Send the answer, or what a refusal knows and says, and the seconds."""
    began, refused = time.process_time(), ""
    try:
        found = question(tol)
    except NonsmoothError as error:
        found, refused = getattr(error, "result", None), str(error)
    known = values(found) if hasattr(found, "value") or hasattr(found, "data_vars") else {}
    send((tol, known, refused, time.process_time() - began))


def ratio(first: dict, second: dict) -> float:
    """Largest difference over what both state; nothing if they have nothing in common."""
    largest = np.nan
    for name in first.keys() & second.keys():
        (value, error), (other, stated) = first[name], second[name]
        if value.shape == other.shape:
            with np.errstate(invalid="ignore"):
                ratios = np.abs(value - other) / (error + stated + 1e-300)
            largest = np.fmax(largest, np.nanmax(ratios, initial=0.0))
    return float(largest)


def answers(question: Callable, tolerances: tuple[float, ...]) -> list[tuple]:
    """Ask for each tolerance, the loosest first, in a process that may be ended."""

    def work(send):
        for tol in tolerances:
            ask(question, tol, send)

    return list(sent(work, LIMIT))


def row(name: str, question: Callable, tolerances: tuple[float, ...]) -> dict:
    """Ask one question and compare the answers."""
    found = answers(question, tolerances)
    ratios = [ratio(a[1], b[1]) for k, a in enumerate(found) for b in found[k + 1 :]]
    seconds = [own[-1] for own in found]
    pairs = itertools.pairwise(seconds)
    slower = [k for k, (a, b) in enumerate(pairs) if a > SLOWER * b + OVERHEAD]
    return {
        "question": name,
        "answered": sum(not own[2] for own in found),
        "refused": sum(bool(own[2]) for own in found),
        "unanswered": len(tolerances) - len(found),
        "largest ratio": np.fmax.reduce([*ratios, np.nan]),
        "wrong": int(np.sum(np.array(ratios) > 1)),
        "slower": len(slower),
        "seconds": " ".join(f"{own:.1f}" for own in seconds),
        "says": next((own[2] for own in reversed(found) if own[2]), ""),
    }


def main(first: int = 0, count: int = 20) -> None:
    """Print a line per scene and question, and a table."""
    warnings.simplefilter("ignore")
    rows = []
    for seed in range(first, first + count):
        rng = np.random.default_rng(seed)
        scene = draw(rng)
        print(f"{seed}: {scene}", flush=True)
        for name, question in questions(scene, rng).items():
            kind = 3 if scene.dimension == 2 and np.isinf(scene.n) else scene.dimension
            rows.append(row(name, question, TOLERANCES[kind]))
            print("   ", ", ".join(f"{k} {v}" for k, v in rows[-1].items()), flush=True)
    table = pd.DataFrame(rows).drop(columns=["seconds", "says"]).groupby("question", sort=False)
    largest = table["largest ratio"].max()
    print(table.sum().assign(**{"largest ratio": largest}).to_string(float_format="{:.2f}".format))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
