"""Whether every default call is answered: each public question of each scene of the sweep.

`python -m benchmarks.defaults` asks them for n = 2, 100 and inf, on one core and each in a process
of its own that has 60 seconds of processor time, and prints a table: value, error, method, seconds.
`--kept FILE` keeps each answer as it comes and goes on with what the file does not have; `--n` and
`--only` choose some of the calls.
"""

import argparse
import json
import math
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import yaml

import nonsmooth as ns
from benchmarks.limited import sent
from nonsmooth.errors import AccuracyWarning

LIMIT = 60  # seconds of processor time
HORIZONS, TIMES = [1.0, 2.0], [1.0, 10.0]
LEVELS = {"friction": ("y", 0.5), "elasto_plastic": ("x", 0.5), "obstacle": ("x", 0.8)}
# names of what datasets hold with an error
ANSWERS = "probability", "v", "variance", "hazard_rate", "threshold", "time", "derivative"
# gamma^2 is known in closed form or on grids where a scene has a solver; each takes (scene, b)
CALLS: dict[str, Callable] = {
    "asymptotic_variance": lambda scene, b: ns.asymptotic_variance(scene, threads=1),
    "mean": lambda scene, b: ns.mean(scene, threads=1),
    "variance": lambda scene, b: ns.variance(scene, TIMES, threads=1),
    "invariant_density": lambda scene, b: ns.invariant_density(scene),
    "spectral_gap": lambda scene, b: ns.spectral_gap(scene),
    "extrapolation_length": lambda scene, b: ns.extrapolation_length(scene, threads=1),
    "crossing": lambda scene, b: ns.crossing_probability(scene, b, HORIZONS, 10, threads=1),
    "crossing, asymptotic": lambda scene, b: ns.crossing_probability(
        scene, b, HORIZONS, 10, "asymptotic", threads=1
    ),
    "crossing, corrected": lambda scene, b: ns.crossing_probability(
        scene, b, HORIZONS, 10, "corrected", threads=1
    ),
    "simulate": lambda scene, b: ns.simulate(scene, 10.0, threads=1),
    "state crossing": lambda scene, b: ns.state_crossing_probability(
        scene, *LEVELS[scene.model], HORIZONS, threads=1
    ),
    "hazard rate": lambda scene, b: ns.hazard_rate(scene, b, HORIZONS, 10, threads=1),
    "mean time": lambda scene, b: ns.mean_time_to_failure(scene, b, 10, threads=1),
    "threshold": lambda scene, b: ns.crossing_threshold(scene, 0.1, HORIZONS, 10, threads=1),
    "failure time": lambda scene, b: ns.failure_time(scene, b, 0.5, 10, threads=1),
    "sensitivity": lambda scene, b: ns.crossing_sensitivity(
        scene, b, HORIZONS, "damping", 10, threads=1
    ),
    "gamma2's sensitivity": lambda scene, b: ns.asymptotic_variance_sensitivity(scene, "damping"),
}


def summary(found):
    """Return the value, the error and the method of an answer; of arrays the last or worst."""
    if isinstance(found, ns.Estimate):
        return found.value, found.error, found.method
    method = found.attrs.get("method", "grids" if "density_y" in found else "monte_carlo")
    for name in ANSWERS:
        if f"{name}_error" in found:
            value, error = (found[own].values.flat[-1] for own in (name, f"{name}_error"))
            return float(value), float(error), method
    errors = {
        name: float(found[f"{name}_error"] / found[name].max())
        for name in found.data_vars
        if not name.endswith("_error")
    }
    worst = max(errors, key=errors.__getitem__)  # relative to the largest value
    return float(found[worst].max()), errors[worst] * float(found[worst].max()), method


def asked(name, scene, threshold):
    """Ask one question; return the row of the table."""
    began = time.process_time()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", AccuracyWarning)
        try:
            value, error, method = summary(CALLS[name](scene, threshold))
            row = {"outcome": "warned" if caught else "answered"}
            row |= {"value": value, "error": error, "method": method}
        except ns.NonsmoothError as refusal:
            row = {"outcome": "refused", "method": str(refusal)}
    return row | {"seconds": round(time.process_time() - began, 1)}


def within_limit(name, scene, threshold):
    """Ask in a process of its own; it is ended at the limit."""
    answers = sent(lambda send: send(asked(name, scene, threshold)), LIMIT)
    return next(answers, {"outcome": "no answer", "seconds": float(LIMIT)})


def table(scenes, penalizations, names, kept):
    """Ask what is not kept yet; return all rows.

    Parameters
    ----------
    scenes : dict
        The section `sweep.scenes` of the configuration.
    penalizations, names : list
        Values of n and names of calls.
    kept : Path or None
        A file of JSON lines, which grows.

    Returns
    -------
    pandas.DataFrame
    """
    rows = []
    if kept and kept.exists():
        rows = [json.loads(line) for line in kept.read_text("utf-8").splitlines()]
    done = {(row["scene"], row["n"], row["call"]) for row in rows}
    for n in penalizations:
        for scene, entry in scenes.items():
            for name in names:
                if (scene, n, name) in done:
                    continue
                case = ns.Scene(**entry["scene"] | {"n": n})
                row = {"scene": scene, "n": n, "call": name}
                rows.append(row | within_limit(name, case, entry["threshold"]))
                print(rows[-1], flush=True)
                if kept:
                    with kept.open("a", encoding="utf-8") as file:
                        print(json.dumps(rows[-1]), file=file)
    return pd.DataFrame(rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kept", type=Path)
    parser.add_argument("--n", type=float, nargs="+", default=[100.0, 2.0, math.inf])
    parser.add_argument("--only", nargs="+", choices=CALLS, default=list(CALLS))
    options = parser.parse_args()
    configuration = yaml.safe_load(Path("config.yaml").read_text("utf-8"))
    found = table(configuration["sweep"]["scenes"], options.n, options.only, options.kept)
    print(found.to_string(index=False))
    print(found.groupby(["call", "outcome"]).size().unstack(fill_value=0).to_string())
