"""Compile what simulations run, so that the first one starts at once.

Run as `python -m nonsmooth` where the library is installed; `make env` does.
"""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from nonsmooth.paths.kernels.panel import new_panel
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tilted.loop import compile_march_tilted, compile_march_tilted_pair
from nonsmooth.paths.tilted.polynomials import polynomials
from nonsmooth.paths.tilted.tilt import Aim, Guide
from nonsmooth.paths.time_loop import compile_march, compile_march_pair
from nonsmooth.scenes.scene import Scene

# the longest ones first; each process finds on disk what the other one has compiled of its loop
LOOPS = (
    ("paths", "float32"),
    ("paths", "float64"),
    ("pairs", "float32"),
    ("led paths", "float32"),
    ("led pairs", "float32"),
    ("pairs", "float64"),
)


def compile_loop(which: str, precision: str) -> None:
    """Compile a loop of the default scheme, which is the same for all its scenes.

    Parameters
    ----------
    which : {"paths", "pairs", "led paths", "led pairs"}
        What it advances.
    precision : {"float32", "float64"}
    """
    scene = Scene("friction")
    fine, coarse = (registry.coefficients(scene, "strang", h, precision) for h in (0.1, 0.2))
    coarse = registry.on_given_increments(coarse)
    panel = new_panel(scene, 0, 0, precision)
    basis = polynomials(scene, 1, np.ones((scene.dimension, 1)), 1.0)
    guide = Guide(basis, np.zeros((5, len(basis.exponents))), mean=0.0, gamma=1.0, kept=0.0)
    tilt = guide.towards(Aim(side=1, levels=(-1.0, 1.0), time=1.0), precision)
    if which == "paths":
        compile_march(fine, panel)
    elif which == "pairs":
        compile_march_pair(fine, coarse, panel)
    elif which == "led paths":
        compile_march_tilted(fine, panel, tilt)
    else:
        compile_march_tilted_pair(fine, coarse, panel, tilt)


if __name__ == "__main__":
    # under this name other processes find it
    from nonsmooth.__main__ import compile_loop

    # processes, because numba compiles in one thread at a time
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        list(pool.map(compile_loop, *zip(*LOOPS, strict=True)))
