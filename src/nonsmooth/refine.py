"""The one loop that refines, until two levels agree."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from operator import length_hint
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.linalg import ArpackError

from nonsmooth.errors import ToleranceError
from nonsmooth.progress import counter, interruptible

MOST = 10.0  # chosen: terms that hardly shrink tell nothing of their sum


@dataclass(frozen=True)
class Refined:
    """The result of a refinement.

    Attributes
    ----------
    value : object
        The solution on the finest level that was tried.
    error : object
        Its estimated error; None if only one level was tried.
    met : bool
        Whether the error is small enough.
    solutions : tuple
        The solutions on all levels that were tried, the finest last.
    """

    value: Any
    error: Any
    met: bool
    solutions: tuple = ()


@contextmanager
def solvable() -> Iterator[None]:
    """Refuse equations that cannot be solved, as a `ToleranceError`.

    Raises
    ------
    ToleranceError
        If they are singular in double precision, or the memory does not hold them.
    """
    try:
        yield
    except (np.linalg.LinAlgError, ArpackError) as error_of_library:
        raise ToleranceError(
            f"the equations are singular in double precision ({error_of_library}); give "
            "parameters of more similar sizes or use Monte Carlo"
        ) from None
    except MemoryError:
        raise ToleranceError(
            "the memory does not hold the equations; choose a larger tol, parameters of "
            "more similar sizes or Monte Carlo, or free memory"
        ) from None


def until_agreement(
    levels: Iterable,
    solve: Callable[[Any], Any],
    error: Callable[[list], Any],
    met: Callable[[Any, Any], bool],
    hopeless: Callable[[Any, Any], bool] = lambda value, error: False,
) -> Refined:
    """Solve on finer and finer levels until the estimated error is small enough.

    Parameters
    ----------
    levels : iterable
        Levels of resolution, from coarse to fine: degrees, grids, or steps. It ends with the
        finest level that can be afforded.
    solve : callable
        Takes a level, returns the solution on it.
    error : callable
        Takes the solutions on all levels so far, at least two, the finest last; returns the
        estimated error of the last. It is given all of them because two levels may agree by
        chance, where the error changes its sign; the earlier levels then show it.
    met : callable
        Takes a solution and its error; returns whether the error is small enough.
    hopeless : callable
        Takes a solution and its error; returns whether to give up, for example because the
        differences between levels do not become smaller.

    Returns
    -------
    Refined

    Raises
    ------
    ToleranceError
        If the first or the second level is refused, or its equations are not `solvable`.
    """
    solutions, estimate = [], None
    with counter("levels of resolution", length_hint(levels)) as advance:
        for level in levels:
            try:
                with solvable():
                    solutions.append(interruptible(partial(solve, level)))
            except ToleranceError:
                if estimate is not None:  # what the levels before have found remains
                    break
                raise
            advance(1)
            if len(solutions) < 2:
                continue
            estimate = error(solutions)
            if met(solutions[-1], estimate):
                return Refined(solutions[-1], estimate, True, tuple(solutions))
            if hopeless(solutions[-1], estimate):
                break
    return Refined(solutions[-1], estimate, False, tuple(solutions))


def further_terms(ratio: ArrayLike) -> np.ndarray:
    """Sum up all further terms of a geometric series, in units of its last term.

    Differences of levels of resolution are taken for such a series; what follows is the error.

    Parameters
    ----------
    ratio : array_like
        The last term over the one before; negative where the signs change.

    Returns
    -------
    numpy.ndarray
        From 1 to `MOST`, of the shape of `ratio`.
    """
    shrinking = np.minimum(ratio, MOST / (1 + MOST))
    return np.maximum(shrinking / (1 - shrinking), 1.0)
