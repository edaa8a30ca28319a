"""Whether the stated errors of crossings of two variables hold, and asking for less costs less.

`python -m benchmarks.plane_crossing_honesty [first] [count] [tol] [paths]` draws random scenes with
two state variables, intervals and p. It asks for five horizons, for one of them, for a fifth of the
tolerance, for Monte Carlo, and for the interval together with two others. The answer to the whole
request may differ from the others that are solved for by the errors of both, and from Monte Carlo
by its own error, the bias of the step, and 4 standard errors. Each scene has a process of its own,
which is ended after 300 seconds of processor time. A line per scene tells ratios and seconds on one
core; the last lines sum up.
"""

import sys
import time
import warnings

import numpy as np

import nonsmooth as ns
from benchmarks.limited import sent
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import NonsmoothError

STANDARD_ERRORS = 4.0  # false alarms: 6e-5 per probability
LONGEST = 300.0  # largest t C_b of which paths are drawn
FINER = 5.0  # the tolerance over that of the finer answer
LIMIT = 300  # seconds of processor time for a scene
RATIOS = "part", "finer", "paths", "among"
SOLVED = "part", "finer", "among"
OTHERS = 0.4, 1.8  # times as far as the levels are those of the intervals beside it


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
    """Answer, seconds, and whether `tol` was met; the answer is None if there is none.

    With several intervals the answer is that of the first.
    """
    began, intervals = time.process_time(), np.atleast_2d(interval)
    try:
        found, met = deterministic_crossing(scene, intervals, times, tol), True
    except NonsmoothError as error:
        found, met = getattr(error, "result", None), False
    return found, time.process_time() - began, met


def ratio(found, other, k=slice(None)):
    """Largest difference of two answers over what both state; nothing if one is missing."""
    if found is None or other is None:
        return np.nan
    apart = np.abs(other["probability"][0] - found["probability"][0][k])
    stated = other["probability_error"][0] + found["probability_error"][0][k]
    return float(np.max(apart / stated))


def ratio_to_paths(found, scene, interval, times, paths, seed):
    """Largest difference to Monte Carlo over what both allow, at times of which paths are drawn."""
    short = times * scene.damping < LONGEST
    if found is None or not paths or not short.any():
        return np.nan
    sample = ns.crossing_probability(
        scene, interval, times[short], 1.0, method="monte_carlo", paths=paths, seed=seed
    )
    spread = np.maximum(sample.probability_error.values, 1 / paths)
    bias = np.abs(sample.step_bias.values) + STANDARD_ERRORS * sample.step_bias_error.values
    allowed = found["probability_error"][0][short] + STANDARD_ERRORS * spread + bias
    return float(
        np.max(np.abs(sample.probability.values - found["probability"][0][short]) / allowed)
    )


def compare(seed, tol, paths, send):
    """Send one by one: the text of a scene, answers and ratios, each with the seconds."""
    rng = np.random.default_rng(seed)
    scene, interval, times = draw(rng)
    send(
        scene=f"{scene.model}, g = {scene.observable}, C_b = {scene.damping:.3g}, "
        f"n = {scene.n:.3g}, ({interval[0]:.3g}, {interval[1]:.3g}), t = {times[0]:.3g} ..."
    )
    whole, seconds, met = asked(scene, interval, times, tol)
    send(met=met, seconds=seconds)
    k = int(rng.integers(len(times)))
    part, seconds, _ = asked(scene, interval, times[k : k + 1], tol)
    send(part=ratio(whole, part, slice(k, k + 1)), part_seconds=seconds)
    send(paths=ratio_to_paths(whole, scene, interval, times, paths, seed))
    finer, seconds, met = asked(scene, interval, times, tol / FINER)
    send(finer=ratio(whole, finer), finer_seconds=seconds, finer_met=met)
    several = np.outer((1.0, *OTHERS), interval)
    among, seconds, _ = asked(scene, several, times, tol)
    send(among=ratio(whole, among), among_seconds=seconds)


def row(seed, tol, paths):
    """Compare in a process of its own; what it did not come to is missing."""
    found = {}
    for part in sent(lambda send: compare(seed, tol, paths, lambda **own: send(own)), LIMIT):
        found |= part
    met = {True: "met", False: "refused", None: "unanswered"}[found.get("met")]
    ratios = ", ".join(f"{name} {found.get(name, np.nan):.2g}" for name in RATIOS)
    times = ("seconds", *(f"{name}_seconds" for name in SOLVED))
    seconds = ", ".join(f"{found.get(name, np.nan):.1f}" for name in times)
    print(f"{seed}: {found['scene']}: {met}, {ratios}, seconds {seconds}", flush=True)
    return found


def main(first=0, count=100, tol=1e-3, paths=20_000):
    """Measure the scenes and print the sums."""
    rows = [row(seed, tol, paths) for seed in range(first, first + count)]
    met, finer_met = (sum(bool(r.get(name)) for r in rows) for name in ("met", "finer_met"))
    ended = sum("finer" not in r for r in rows)
    print(f"scenes {count}, met {met} at {tol:g}, {finer_met} at {tol / FINER:g}, {ended} ended")
    for name in RATIOS:
        seen = np.array([r[name] for r in rows if np.isfinite(r.get(name, np.nan))])
        wrong, largest = int(np.sum(seen > 1)), max(seen, default=0.0)
        print(f"{name}: {len(seen)} compared, {wrong} wrong, largest ratio {largest:.2g}")
    for name in ("seconds", *(f"{name}_seconds" for name in SOLVED)):
        seen = [r[name] for r in rows if name in r]
        print(f"{name}: median {np.median(seen):.1f}, longest {max(seen):.1f}, of {len(seen)}")


if __name__ == "__main__":
    main(*(float(a) if "." in a or "e" in a else int(a) for a in sys.argv[1:]))
