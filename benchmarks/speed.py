"""Speed of the simulation, of normal numbers alone, of a plain loop and of peers, in one run.

Peers are other packages that can simulate the same equation.

`python -m benchmarks.speed [python of the peers' environment]` prints one table: nanoseconds per
path, step and core, the median of interleaved rounds with their spread, and ratios to the plain
loop. See README.md.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

import numba
import numpy as np
import pandas as pd

import nonsmooth as ns
from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.kernels.compilation import kernel
from nonsmooth.paths.kernels.panel import new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK, normals
from nonsmooth.paths.sampling import Sampling

ROUNDS = 7
STEP = 0.02
FRICTION = ns.Scene("friction", n=100)
OTHERS = {
    f"{model}, {noise}, n = {n:g}": ns.Scene(
        model,
        noise,
        n=n,
        potential="0" if model == "friction" else "x**2/2",
        observable="x" if model == "obstacle" else "y",
    )
    for model in ("friction", "elasto_plastic", "obstacle")
    for noise in ("white", "langevin", "hamiltonian")
    for n in (100.0, np.inf)
}


@numba.njit
def plain_loop(paths, steps, h, n):
    """Euler-Maruyama, one path after the other, with numba's own np.random."""
    total = 0.0
    for _ in range(paths):
        y = delta = peak = 0.0
        for _ in range(steps):
            delta += h * y
            noise = np.random.standard_normal()  # noqa: NPY002 - what it is measured against
            y += -h * (y + min(1.0, max(-1.0, n * y))) + np.sqrt(h) * noise
            peak = max(peak, abs(delta))
        total += delta**2 + peak
    return total


@kernel
def draw_normals(words, out, count):
    """Draw normal numbers and nothing else."""
    for _ in range(count):
        normals(words, out, BLOCK)


def timed(run, path_steps):
    """Nanoseconds per path-step of one run."""
    began = time.perf_counter()
    run()
    return (time.perf_counter() - began) / path_steps * 1e9


def contestants(threads):
    """Map names to functions that measure nanoseconds per path, step and core."""
    blocks, steps = 32 * threads, 10_000

    def moments(scene, precision="float32", control=False, share=1):
        paths, horizon = blocks * BLOCK // share, STEP * steps
        return lambda: (
            threads
            * timed(
                lambda: gram(
                    scene,
                    [horizon / 2, horizon],
                    Sampling(STEP, paths, 1, threads=threads, precision=precision),
                    control,
                ),
                paths * steps,
            )
        )

    def crossings():
        paths = blocks * BLOCK
        # no path reaches this threshold, so that all steps of all paths are done
        return threads * timed(
            lambda: first_passage_counts(
                FRICTION,
                1e9,
                [STEP * steps / 2, STEP * steps],
                1.0,
                Sampling(STEP, paths, 1, threads=threads),
            ),
            paths * steps,
        )

    def raw():
        panel = new_panel(FRICTION, 1, 0)
        return timed(lambda: draw_normals(panel.words, panel.data, 20_000), 2 * BLOCK * 20_000)

    result = {
        "friction, white: moments": moments(FRICTION),
        "friction, white: crossings": crossings,
    }
    if threads == 1:
        result |= {
            "normal numbers alone": raw,
            "plain numba loop": lambda: timed(
                lambda: plain_loop(100, 20_000, STEP, 100.0), 2_000_000
            ),
            "friction, white: with control variate": moments(FRICTION, control=True),
            "friction, white: double precision": moments(FRICTION, "float64", share=32),
        }
        result |= {name: moments(scene, share=16) for name, scene in OTHERS.items()}
    return result


def peer(python, name):
    """Run a peer in its own environment; return its nanoseconds."""
    script = Path(__file__).with_name("peer_loops.py")
    run = subprocess.run([python, script, name], capture_output=True, text=True, check=True)
    return float(run.stdout)


def main(python=None):
    """Measure everything in rounds and print the table."""
    cores = os.cpu_count()
    runs = {(name, 1): run for name, run in contestants(1).items()}
    runs |= {(name, cores): run for name, run in contestants(cores).items()}
    if python:
        for name in ("torch", "torch, in place", "jax", "diffrax", "diffrax, fastest"):
            runs[f"{name} (peer)", 1] = lambda name=name: peer(python, name)
    for run in runs.values():
        run()  # compiles
    rows = [
        {"what": name, "cores": count, "ns": run()}
        for _ in range(ROUNDS)
        for (name, count), run in runs.items()
    ]
    table = pd.DataFrame(rows).groupby(["what", "cores"], sort=False)["ns"]
    table = table.agg(["median", "min", "max"])
    table["plain loop / this"] = table.loc[("plain numba loop", 1), "median"] / table["median"]
    for name in ("friction, white: moments", "friction, white: crossings"):
        gain = cores * table.loc[(name, 1), "median"] / table.loc[(name, cores), "median"]
        print(f"{name}: {cores} cores do {gain:.2f} times the work of one")
    print(table.round(3).to_string())


if __name__ == "__main__":
    main(*sys.argv[1:])
