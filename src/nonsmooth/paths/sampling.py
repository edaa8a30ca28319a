"""The settings of one Monte Carlo run, in one record."""

import os
from dataclasses import dataclass, replace

from nonsmooth.paths.kernels.random_numbers import labelled

PRECISIONS = ("float32", "float64")


@dataclass(frozen=True)
class Sampling:
    """Which paths are simulated, and how.

    Attributes
    ----------
    step : float
        Longest time step, "1"; it is shortened to meet the output times.
    paths : int
        Number of paths.
    seed : int or tuple
        The same seed gives the same bits whatever the number of threads.
    first_path : int
        Number of the first path, a multiple of the block size. By this an ensemble can be
        simulated in parts.
    threads : int, optional
        All cores unless given.
    scheme : str
        A name in `schemes.registry.SCHEMES`.
    precision : {"float32", "float64"}
        Arithmetic of the steps; what is added up over many of them is in double precision.
    """

    step: float
    paths: int
    seed: int | tuple
    first_path: int = 0
    threads: int | None = None
    scheme: str = "strang"
    precision: str = "float32"

    @property
    def workers(self) -> int:
        """Number of threads, all cores unless given."""
        return self.threads or os.cpu_count() or 1

    def labelled(self, label: str | int) -> "Sampling":
        """Return the same settings with another seed, whose paths are independent of these."""
        return replace(self, seed=labelled(self.seed, label))
