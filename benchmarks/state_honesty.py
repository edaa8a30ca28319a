"""Whether the stated errors of crossings of the state hold, with two variables.

`python -m benchmarks.state_honesty [first] [count] [tol] [paths]` draws random scenes with two
state variables, one of these and an interval for it. It asks for four horizons, for one of them,
for a fifth of the tolerance and for Monte Carlo. The answer to the whole request may differ from
the others that are solved for by the errors of both, and from Monte Carlo by its own error, the
bias of the step, and 4 standard errors. A line per scene tells ratios and seconds on one core; the
last lines sum up.
"""

import sys
import time

import numpy as np

import nonsmooth as ns
from benchmarks.plane_crossing_honesty import FINER, STANDARD_ERRORS, ratio
from nonsmooth.errors import ToleranceError

SOLVED = "whole", "part", "finer"
RATIOS = "part", "finer", "paths"


def draw(rng):
    """Draw a scene, a variable of its state, an interval and horizons."""
    damping, sigma = 10 ** rng.uniform(np.log10(0.05), np.log10(5)), 10 ** rng.uniform(-0.3, 0.4)
    common = {"damping": damping, "n": float(10 ** rng.uniform(0, 3))}
    k = round(rng.uniform(0.2, 3), 3)
    scene = [
        lambda: ns.Scene("friction", ns.OrnsteinUhlenbeck(sigma, sigma), **common),
        lambda: ns.Scene("friction", ns.Langevin(f"{k}*eta**2/2 + eta**4/4", sigma), **common),
        lambda: ns.Scene("friction", ns.White(sigma), potential=f"{k}*x**2/2", **common),
        lambda: ns.Scene("elasto_plastic", ns.White(sigma), potential=f"{k}*x**2/2", **common),
        lambda: ns.Scene("obstacle", ns.White(sigma), potential=f"{k}*x**2/2", **common),
        lambda: ns.Scene("obstacle", ns.White(sigma), potential="x**4/4 + 0.2*x", **common),
    ][rng.integers(6)]()
    b = 10 ** rng.uniform(-0.7, 0.4)
    interval = [(-b, b), (-b, b * rng.uniform(0.5, 2)), (-np.inf, b)][rng.integers(3)]
    horizons = np.array([0.3, 1.0, 3.0, 10.0]) * 10 ** rng.uniform(-0.5, 0.5)
    return scene, str(rng.choice(list(scene.state))), interval, horizons


def asked(scene, variable, interval, horizons, tol):
    """Return the answer, whether `tol` was met, and seconds."""
    began, met = time.process_time(), True
    try:
        found = ns.state_crossing_probability(
            scene, variable, [interval], horizons, method="deterministic", tol=tol
        )
    except ToleranceError as error:
        found, met = error.result, False
    return found, met, time.process_time() - began


def ratio_to_paths(found, question, paths, seed):
    """Largest difference to Monte Carlo over what both allow."""
    sample = ns.state_crossing_probability(
        *question, method="monte_carlo", paths=paths, seed=seed, threads=1
    )
    spread = np.maximum(sample.standard_error.values, 1 / paths)
    allowed = found.probability_error.values[0] + np.abs(sample.step_bias.values)
    allowed += STANDARD_ERRORS * (spread + sample.step_bias_error.values)
    return float(np.max(np.abs(sample.probability.values - found.probability.values[0]) / allowed))


def row(seed, tol, paths):
    """Compare the answers to one question."""
    rng = np.random.default_rng(seed)
    question = scene, variable, interval, horizons = draw(rng)
    k = int(rng.integers(len(horizons)))
    answers = {
        "whole": asked(*question, tol),
        "part": asked(scene, variable, interval, horizons[k : k + 1], tol),
        "finer": asked(*question, tol / FINER),
    }
    (whole, met, _), (part, *_), (finer, *_) = answers.values()
    ratios = ratio(whole, part, slice(k, k + 1)), ratio(whole, finer)
    found = dict(zip(RATIOS, (*ratios, ratio_to_paths(whole, question, paths, seed)), strict=True))
    found |= {f"{name} seconds": answers[name][2] for name in SOLVED} | {"met": met}
    print(
        f"{seed}: {scene.model}, {scene.noise.kind}, C_b = {scene.damping:.3g}, n = {scene.n:.3g}, "
        f"{variable} in ({interval[0]:.3g}, {interval[1]:.3g}): {'met' if met else 'refused'}, "
        + ", ".join(f"{name} {value:.2g}" for name, value in found.items() if name != "met"),
        flush=True,
    )
    return found


def main(first=0, count=40, tol=1e-3, paths=20_000):
    """Measure the scenes and print the sums."""
    rows = [row(seed, tol, paths) for seed in range(first, first + count)]
    print(f"scenes {count}, met {sum(one['met'] for one in rows)} at {tol:g}")
    for name in RATIOS:
        seen = np.array([one[name] for one in rows])
        print(f"{name}: {int(np.sum(seen > 1))} wrong, largest ratio {seen.max():.2g}")
    for name in SOLVED:
        seen = [one[f"{name} seconds"] for one in rows]
        print(f"{name}: seconds, median {np.median(seen):.1f}, longest {max(seen):.1f}")


if __name__ == "__main__":
    main(*(float(a) if "." in a or "e" in a else int(a) for a in sys.argv[1:]))
