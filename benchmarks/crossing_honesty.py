"""Whether the stated errors of deterministic crossing probabilities are larger than the true ones.

`python -m benchmarks.crossing_honesty` draws random scenes with the state y and white noise and
random intervals, and compares three times of a curve with the Laplace transform summed by the
trapezoidal rule on a vertical line, on a grid of higher degree. It prints one line per class of
observables; arguments choose classes by their first words, `--first` the first seed and `--scenes`
how many. With `--tol` the whole curve for this tolerance is compared with that for the usual one,
too. What it finds for each scene goes to the standard error.
"""

import argparse
import sys
import time
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd

import nonsmooth as ns
from nonsmooth.crossing.first_passage.line import Intervals
from nonsmooth.errors import ToleranceError
from nonsmooth.line import eigenfunctions

ODD = ("y", "y + {a}*sin(2*y)", "y*(1 + {a}*y**2/(1 + y**2))", "y + {a}*y**3/(1 + y**2)")
OTHER = ("y + {a}*abs(y)", "y + {a}*sin(y)**2", "y + {a}*cos(2*y)", "y + {a}*y**2/(1 + y**2)")
BOUNDED = (
    "tanh({a}*y)",
    "min(max(9*{a}*y, -1), 1)",
    "sin(y) + {a}*y",
    "tanh(y) + {a}*cos(y)",
    "y**2 - {a}",
)
CLASSES = {"odd": (ODD, 40), "other": (OTHER, 24), "bounded": (BOUNDED, 30)}
HORIZONS = np.geomspace(0.01, 100, 25)
PROBED = (1e-4, 0.05, 0.7)  # probabilities near which a curve is checked
# The reference: polynomial degree; period of the trapezoidal rule in units of the time; its decay
# over a period, exp(-DECAY); relative size of the terms that are left out; largest number of terms.
DEGREE, PERIOD, DECAY, LEAST, MOST = 11, 3.0, 24.0, 1e-13, 1500
# Error of the reference: exp(-DECAY) from the other periods, and rounding and the terms that are
# left out, which are magnified by exp(DECAY / PERIOD) = exp(8).
UNCERTAIN = 2e-10
# Where a value seems wrong, a reference of another degree and period is asked, too: elements around
# a start off 0 may be too coarse, and stiff scenes are rounded more.
AGAIN = 16, 2.5


def draw(rng, formulas):
    """Draw a scene, an interval and p."""
    g = formulas[rng.integers(len(formulas))].format(a=round(rng.uniform(0.1, 0.6), 3))
    n = np.inf if rng.random() < 1 / 8 else 10 ** rng.uniform(0, 5)
    start = {"y": rng.uniform(-1, 1)} if rng.random() < 0.3 else {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scene = ns.Scene("friction", n=n, damping=10 ** rng.uniform(-1, 1), observable=g)
        centre = "" if scene.is_odd() else f" - {eigenfunctions.mean(scene):.16g}"
        scene = ns.Scene("friction", n=n, damping=scene.damping, observable=g + centre, start=start)
    b = 10 ** rng.uniform(-1, 0.7)
    threshold = [(-b, b), (-b, b * rng.uniform(0.5, 2)), (-np.inf, b)][rng.integers(3)]
    return scene, threshold, 10 ** rng.uniform(-1, 3)


def on_vertical_line(scene, levels, time, degree=DEGREE, period=PERIOD):
    """Probability at a time by the trapezoidal rule; nan if it takes too many nodes."""
    # The tiny constant makes g not odd, so that the symmetry is not used. Else decay lengths would
    # be square roots of eigenvalues, which have fewer digits.
    whole = replace(scene, observable=f"{scene.observable} + 1e-30")
    (problem,) = Intervals(whole, [levels]).problems
    transform = problem.transform(degree, np.array([time]), 12.0)
    step = 2 * np.pi / (period * time)
    z = DECAY / (period * time) + 1j * step * (np.arange(MOST) + 0.5)
    values = []
    for node in z:
        values.append(transform(node) / node)
        if abs(values[-1]) < LEAST * abs(values[0]):
            break
    else:
        return np.nan
    return step / np.pi * (np.exp(time * z[: len(values)]) @ np.array(values)).real


def compare(formulas, seed, tol=None):
    """One scene: true and stated errors at the probed times, seconds; None where refused."""
    scene, threshold, p = draw(np.random.default_rng(seed), formulas)
    asked = scene, threshold, HORIZONS, p, "deterministic"
    began = time.process_time()
    try:
        found = ns.crossing_probability(*asked, tol=tol)
    except ToleranceError as error:
        print(f"{seed}: {scene}, {threshold}, p = {p:.3g}: {error}", file=sys.stderr, flush=True)
        return None
    seconds = time.process_time() - began
    levels = np.sqrt(p) * np.array(threshold)
    rows = [] if tol is None else against_usual(asked, found, seed)
    for k in sorted({int(np.argmin(np.abs(found.probability.values - W))) for W in PROBED}):
        exact = on_vertical_line(scene, levels, p * HORIZONS[k])
        true = abs(float(found.probability[k]) - exact)
        stated, uncertain = float(found.probability_error[k]), UNCERTAIN
        if true > stated + uncertain:
            uncertain += abs(exact - on_vertical_line(scene, levels, p * HORIZONS[k], *AGAIN))
        rows.append((true, stated + uncertain))
        if true > rows[-1][1]:
            print(
                f"{seed}: {scene}, {threshold}, p = {p:.6g}, T = {HORIZONS[k]:g}: "
                f"{float(found.probability[k]):.12g} +- {stated:.1e}, exact {exact:.12g}",
                file=sys.stderr,
                flush=True,
            )
    ratios = sorted(true / allowed for true, allowed in rows)[-3:]
    print(
        f"{seed}: {seconds:.1f} s, largest true over stated errors "
        + ", ".join(f"{ratio:.2g}" for ratio in ratios),
        file=sys.stderr,
        flush=True,
    )
    return seconds, rows


def against_usual(asked, found, seed):
    """Differences of a curve from that for the usual tolerance, and what both state."""
    try:
        usual = ns.crossing_probability(*asked)
    except ToleranceError as refused:
        print(f"{seed}: the usual tolerance is refused: {refused}", file=sys.stderr, flush=True)
        return []
    true = np.abs(found.probability.values - usual.probability.values)
    stated = found.probability_error.values + usual.probability_error.values
    for k in np.flatnonzero(true > stated):
        print(
            f"{seed}: {asked[:2]}, p = {asked[3]:.6g}, T = {HORIZONS[k]:g}: off by {true[k]:.2g} "
            f"where both state {stated[k]:.2g}",
            file=sys.stderr,
            flush=True,
        )
    return list(zip(true, stated, strict=True))


def main(arguments):
    """Measure the classes and print the table."""
    parser = argparse.ArgumentParser(description="stated against true errors of crossings")
    parser.add_argument("classes", nargs="*", help="their first words; all unless given")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, help="how many of each class")
    parser.add_argument("--tol", type=float, help="tolerance; the usual one unless given")
    chosen, table = parser.parse_args(arguments), {}
    for name, (formulas, usual) in CLASSES.items():
        if chosen.classes and not name.startswith(tuple(chosen.classes)):
            continue
        count = chosen.scenes or usual
        seeds = range(chosen.first, chosen.first + count)
        results = [compare(formulas, seed, chosen.tol) for seed in seeds]
        done = [r for r in results if r is not None]
        errors = np.array([row for _, rows in done for row in rows])
        true, allowed = errors[np.isfinite(errors[:, 0])].T
        seconds = np.array([r[0] for r in done])
        table[name] = {
            "scenes": count,
            "refused": count - len(done),
            "probabilities checked": len(true),
            "wrong": int(np.sum(true > allowed)),
            "true/stated: median": np.median(true / allowed),
            "largest": np.max(true / allowed),
            "seconds: median": np.median(seconds),
            "longest": seconds.max(),
        }
        print(name, table[name], file=sys.stderr, flush=True)
    print(pd.DataFrame(table).T.to_string(float_format="{:.2g}".format))


if __name__ == "__main__":
    main(sys.argv[1:])
