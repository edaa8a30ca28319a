"""Whether the stated errors of crossings of two variables hold, and asking for less costs less.

`python -m benchmarks.plane_crossing_honesty [first] [count] [tol] [paths]` draws random scenes with
two state variables, intervals and p. It asks for five horizons, for one of them, and for Monte
Carlo. The answer to the whole request may differ from that to the part by the errors of both, and
from Monte Carlo by its own error, the bias of the step, and 4 standard errors. A line per scene
tells the largest ratios and the seconds on one core; the last lines sum up.
"""

import sys
import time
import warnings

import numpy as np

import nonsmooth as ns
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import NonsmoothError

STANDARD_ERRORS = 4.0  # false alarms: 6e-5 per probability
LONGEST = 300.0  # largest t C_b of which paths are drawn


def draw(rng):
    """Draw a scene, an interval of int g, and times."""
    damping, sigma = 10 ** rng.uniform(np.log10(0.05), np.log10(5)), 10 ** rng.uniform(-0.3, 0.5)
    kind = rng.integers(4)
    start = {"y": round(rng.uniform(-1, 1), 3)} if rng.random() < 0.4 else {}
    common = {"damping": damping, "n": float(10 ** rng.uniform(0.3, 2.5)), "start": start}
    if kind == 0:
        scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(sigma, sigma), **common)
    elif kind == 1:
        scene = ns.Scene("obstacle", ns.White(sigma), potential="x**2/2", observable="x", **common)
    else:
        g = "plastic_strain_rate" if kind == 2 else "y"
        scene = ns.Scene(
            "elasto_plastic", ns.White(sigma), potential="x**2/2", observable=g, **common
        )
    p = 10 ** rng.uniform(-1, 4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        spread = np.sqrt(p * ns.asymptotic_variance(scene, tol=1e-2).value)
    b = spread * 10 ** rng.uniform(-0.5, 0.4)
    interval = [(-b, b), (-b, b * rng.uniform(0.5, 2)), (-np.inf, b)][rng.integers(3)]
    return scene, interval, p * np.array([0.2, 0.5, 1.0, 2.0, 4.0])


def asked(scene, interval, times, tol):
    """Probabilities, their errors, seconds, and whether `tol` was met."""
    began = time.process_time()
    try:
        found, met = deterministic_crossing(scene, np.array([interval]), times, tol), True
    except NonsmoothError as error:
        found, met = getattr(error, "result", None), False
        print(f"  refused: {error}", file=sys.stderr, flush=True)
    seconds = time.process_time() - began
    if found is None:
        return None, None, seconds, met
    return found["probability"][0], found["probability_error"][0], seconds, met


def compare(seed, tol, paths):
    """Ratios of differences to what is stated, to a part and to Monte Carlo, and seconds."""
    rng = np.random.default_rng(seed)
    scene, interval, times = draw(rng)
    probability, error, seconds, met = asked(scene, interval, times, tol)
    k = int(rng.integers(len(times)))
    part, part_error, part_seconds, _ = asked(scene, interval, times[k : k + 1], tol)
    if probability is None or part is None:
        return np.nan, np.nan, seconds, part_seconds, met
    to_part = abs(part[0] - probability[k]) / (part_error[0] + error[k])
    to_paths, short = np.nan, times * scene.damping < LONGEST
    if paths and short.any():
        few = times[short]
        sample = ns.crossing_probability(
            scene, interval, few, 1.0, method="monte_carlo", paths=paths, seed=seed
        )
        allowed = error[short] + STANDARD_ERRORS * np.maximum(
            sample.probability_error.values, 1 / paths
        )
        allowed += np.abs(sample.step_bias.values) + STANDARD_ERRORS * sample.step_bias_error.values
        to_paths = np.max(np.abs(sample.probability.values - probability[short]) / allowed)
    print(
        f"{seed}: {scene.model}, g = {scene.observable}, C_b = {scene.damping:.3g}, "
        f"n = {scene.n:.3g}, ({interval[0]:.3g}, {interval[1]:.3g}), t = {times[0]:.3g} ...: "
        f"{'met' if met else 'refused'}, part {to_part:.2g}, paths {to_paths:.2g}, "
        f"{seconds:.1f} s, part {part_seconds:.1f} s",
        flush=True,
    )
    return to_part, to_paths, seconds, part_seconds, met


def main(first=0, count=100, tol=1e-3, paths=100_000):
    """Measure the scenes and print the sums."""
    rows = np.array([compare(seed, tol, paths) for seed in range(first, first + count)], float)
    to_part, to_paths, seconds, part, met = rows.T
    print(f"scenes {count}, met {int(met.sum())}, at tol = {tol:g}")
    for name, ratio in (("part", to_part), ("paths", to_paths)):
        seen = ratio[np.isfinite(ratio)]
        print(
            f"{name}: {len(seen)} compared, {int(np.sum(seen > 1))} wrong, largest ratio ", end=""
        )
        print(f"{max(seen, default=0.0):.2g}")
    print(f"seconds: median {np.median(seconds):.1f}, longest {seconds.max():.1f}; ", end="")
    print(f"a part took at most {np.max(part / seconds):.2f} of the whole")


if __name__ == "__main__":
    main(*(float(a) if "." in a or "e" in a else int(a) for a in sys.argv[1:]))
