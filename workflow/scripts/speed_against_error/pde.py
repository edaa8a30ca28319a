"""v(0, T)/T of dry friction by the paper's scheme and by others: error against time."""

import sys
from contextlib import ExitStack
from itertools import product
from pathlib import Path

import numpy as np
from numpy.polynomial import legendre

from nonsmooth.line import eigenfunctions, finite_differences
from nonsmooth.scenes.scene import Scene
from reproduction.jobs.job import produce
from reproduction.speed_against_error.work_precision import Case, measured, peer, timed, unseeded

PEERS = "benchmarks/peers"


def pde(horizon, n, paper_scheme, fitted_grid, spectral_elements, libraries, rounds, python):
    """Measure every method at each n.

    Parameters
    ----------
    horizon : float
        T, long enough for exp(-2 T) to vanish.
    n : list of float
    paper_scheme : dict
        `half_width`, and lists `nodes` and `time_steps`, of which each pair is run.
    fitted_grid : dict
        Lists `cells` (on each side of 0) and `steps`, run in pairs by Crank-Nicolson; the same
        cells by scipy's BDF to the tolerance `rtol`.
    spectral_elements : dict
        List `degrees`.
    libraries : dict
        Lists `elements` and `steps`, run in pairs by scikit-fem, and `cells` of py-pde.
    rounds : int
    python : str or None
        Interpreter with the libraries; without it they are left out.

    Returns
    -------
    xarray.Dataset
    """
    cases, references = [], {}
    with ExitStack() as stack:
        differences = stack.enter_context(peer(sys.executable, Path(PEERS, "differences.py")))
        library = python and stack.enter_context(peer(python, Path(PEERS, "finite_elements.py")))
        for penalization in n:
            scene = Scene("friction", n=penalization)
            panel = f"$n = {penalization:g}$"
            references[panel] = long_run(penalization, horizon), 1e-13
            common = {"n": penalization, "horizon": horizon}
            for nodes, step in product(paper_scheme["nodes"], paper_scheme["time_steps"]):
                size = {
                    "half_width": paper_scheme["half_width"],
                    "nodes": nodes,
                    "time_step": step,
                }
                run = timed(unseeded(_marched), scene, horizon, size)
                cases.append(Case(panel, "paper's scheme", nodes, run))
            pairs = zip(fitted_grid["cells"], fitted_grid["steps"], strict=True)
            for cells, steps in pairs:
                for name, method, size in (
                    ("fitted grid, Crank-Nicolson", "crank_nicolson", {"steps": steps}),
                    ("fitted grid, scipy BDF", "method_of_lines", {"rtol": fitted_grid["rtol"]}),
                ):
                    run = differences(method=method, cells=cells, **common, **size)
                    cases.append(Case(panel, name, cells, run))
            for degree in spectral_elements["degrees"]:
                run = timed(unseeded(_expanded), scene, horizon, degree)
                cases.append(Case(panel, "spectral elements", degree, run))
            if library:
                for elements, steps in zip(libraries["elements"], libraries["steps"], strict=True):
                    run = library(method="scikit-fem", elements=elements, steps=steps, **common)
                    cases.append(Case(panel, "scikit-fem, P2", elements, run))
                for cells in libraries["cells"]:
                    run = library(method="py-pde", cells=cells, **common)
                    cases.append(Case(panel, "py-pde", cells, run))
        return measured(
            "Speed against error of solvers for the variance",
            f"v(0, T)/T of dry friction with white noise, T = {horizon:g}; reference: quadrature",
            cases,
            rounds,
            references,
        )


def _marched(scene, horizon, size):
    return finite_differences.moments(scene, [horizon], **size)[1][0] / horizon


def _expanded(scene, horizon, degree):
    return eigenfunctions.moments(scene, np.array([horizon]), degree)[1][0] / horizon


def long_run(n, horizon, points=20, elements=40):
    """v(0, T)/T of dry friction (C_b = 1, g = y), T large, by nested quadratures alone.

    With -A u = g and -A h = 2 g u - gamma^2, u(0) = 0, up to an exponentially small rest

        v(0, T) = gamma^2 T + h(0) - <h> - 2 <u^2>,

    where u' = 2/m int_y^inf s m and h' = 2/m int_y^inf (2 s u - gamma^2) m.

    Parameters
    ----------
    n, horizon : float
    points, elements : int
        Gauss points of an element; elements beyond the knot.

    Returns
    -------
    float
        To some 1e-13; 16 points and 60 elements change it by 1e-16.
    """
    knot = 1 / n
    nodes, weights = legendre.leggauss(points)
    edges = np.concatenate(
        [[0.0], np.geomspace(knot / 8, knot, 8), knot + np.geomspace(1e-3, 8.5, elements)]
    )
    half = np.diff(edges)[:, None] / 2
    y = edges[:-1, None] + half * (nodes + 1)
    modes = legendre.legvander(nodes, points - 1).T * weights * (np.arange(points)[:, None] + 0.5)
    primitive = legendre.legval(nodes, legendre.legint(np.eye(points), lbnd=-1)).T @ modes

    def below(f):
        whole = (f * half) @ weights
        return (f * half) @ primitive.T + (np.cumsum(whole) - whole)[:, None]

    def above(f):
        whole = (f * half) @ weights
        rest = np.cumsum(whole[::-1])[::-1] - whole
        return (f * half) @ (weights - primitive).T + rest[:, None]

    def mean(f):
        return 2 * np.sum(f * m * half * weights)

    friction = np.where(y < knot, n * y**2 / 2, y - knot / 2)
    m = np.exp(-(y**2) - 2 * friction)
    m /= 2 * np.sum(m * half * weights)
    slope = 2 * above(y * m) / m
    u = below(slope)
    gamma2 = mean(slope**2)
    bend = 2 * above((2 * y * u - gamma2) * m) / m
    excess = 2 * np.sum(bend * above(m) * half * weights)  # <h> - h(0)
    return gamma2 - (excess + 2 * mean(u**2)) / horizon


if __name__ == "__main__":
    produce(pde, snakemake)
