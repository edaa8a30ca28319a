"""Compile what simulations run, so that the first one starts at once.

Run as `python -m nonsmooth` where the library is installed; `make env` does.
"""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from nonsmooth.paths.ensembles import compile_loops

if __name__ == "__main__":
    # processes, because numba compiles in one thread at a time
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        list(pool.map(compile_loops, ("float32", "float64")))
