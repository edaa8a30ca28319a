"""Speed of whole processes that simulate the scenes of the sweep, for the costs on clusters.

`python -m benchmarks.throughput` starts a process of one thread on every core, as on a node that is
fully used, for each scene of `config.yaml` and each round. It prints medians over the rounds: steps
of paths per second and core, and the core hours of 10^9 paths for gamma^2 and for the crossings at
the largest p, where a path ends when it crosses.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import yaml

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.paths import time_grids
from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene

ROUNDS = 5
CONFIG = Path(__file__).parents[1] / "config.yaml"
SWEEP = yaml.safe_load(CONFIG.read_text(encoding="utf-8"))["sweep"]
# paths of gamma^2 and of the crossings: one or two seconds of work
PATHS, CROSSING_PATHS = 100_000, 8_000


def seconds(work):
    """Processor time of a second call; the first one loads the machine code."""
    for _ in range(2):
        began = time.process_time()
        work()
    return time.process_time() - began


def measured(name):
    """Path-steps per second of gamma^2, and seconds per path of both, of one scene."""
    settings, step, p = SWEEP["scenes"][name], SWEEP["step"], SWEEP["p"][-1]
    scene, times = Scene(**settings["scene"]), SWEEP["variance"]["times"]
    horizons = time_grids.equidistant(SWEEP["horizon"], SWEEP["outputs"])
    estimate = seconds(lambda: integrals_at(scene, times, Sampling(step, PATHS, 1, threads=1)))
    crossing = seconds(
        lambda: first_passage_counts(
            scene, settings["threshold"], horizons, p, Sampling(step, CROSSING_PATHS, 1, threads=1)
        )
    )
    return {
        "1e6 path-steps per s": PATHS * times[-1] / step / estimate / 1e6,
        "hours, gamma^2": estimate / PATHS * 1e9 / 3600,
        f"hours, p = {p}": crossing / CROSSING_PATHS * 1e9 / 3600,
    }


def main():
    """Measure all scenes in rounds and print the table."""
    rows = []
    for _ in range(ROUNDS):
        for name in SWEEP["scenes"]:
            command = [sys.executable, "-m", "benchmarks.throughput", name]
            runs = [
                subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
                for _ in range(os.cpu_count())
            ]
            for run in runs:
                rows.append({"scene": name, **json.loads(run.communicate()[0])})
    table = pd.DataFrame(rows).groupby("scene", sort=False).median()
    print(table.round(1).to_string())
    print(table.filter(like="hours").sum().round().to_string())


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(measured(sys.argv[1])))
    else:
        main()
