"""What a simulation costs, estimated before it starts; what nobody can wait for is refused."""

import os

from nonsmooth.errors import ToleranceError
from nonsmooth.paths import tuning
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.sampling import Sampling


def require_time(steps: float, sampling: Sampling) -> None:
    """Refuse a simulation that would take longer than `tuning.COST.longest_run`.

    Parameters
    ----------
    steps : float
        Number of steps of each path.
    sampling : Sampling
        Number of paths and threads, and the precision.

    Raises
    ------
    ToleranceError
    """
    chosen = tuning.COST
    blocks = -(-sampling.paths // BLOCK)
    threads = min(sampling.workers, blocks)
    path_step = chosen.path_step[sampling.precision]
    work = steps * (blocks * chosen.block_step + sampling.paths * path_step)
    hours = float(work / threads / 3600)
    if hours > chosen.longest_run:
        raise ToleranceError(
            f"{sampling.paths:.2g} paths of {steps:.2g} steps would take some {hours:.0e} hours on "
            f"{threads} threads, above the limit of {chosen.longest_run:g}; choose a "
            "longer step, fewer paths or a shorter time, or average several runs with other seeds"
        )


def require_memory(numbers: float) -> None:
    """Refuse results of so many numbers in double precision that the memory does not hold them.

    Raises
    ------
    ToleranceError
    """
    needed = 8 * numbers
    there = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if needed > there:
        raise ToleranceError(
            f"the results would take {needed / 1e9:.2g} GB of memory, and the machine has "
            f"{there / 1e9:.2g}; choose fewer paths or fewer output times"
        )
