"""The one loop that refines: solve on finer and finer levels until they agree."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Refined:
    """What a refinement ends with.

    Attributes
    ----------
    value : object
        The solution on the finest level that was tried.
    error : object
        Its estimated error; None if there was one level only.
    met : bool
        Whether the error is small enough.
    solutions : tuple
        On all levels that were tried, the finest last.
    """

    value: Any
    error: Any
    met: bool
    solutions: tuple = ()


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
        Levels of resolution, from coarse to fine: degrees, grids, or steps. It ends where finer
        ones cannot be afforded.
    solve : callable
        Takes a level, returns the solution on it.
    error : callable
        Takes the solutions on all levels so far, two at least, the finest last; returns the
        estimated error of the last. Two levels may agree by chance, because errors change sign:
        the earlier ones are there to be asked as well.
    met : callable
        Takes a solution and its error; returns whether to stop with it.
    hopeless : callable
        Takes a solution and its error; returns whether to stop without it, as where levels move
        apart.

    Returns
    -------
    Refined
    """
    solutions, estimate = [], None
    for level in levels:
        solutions.append(solve(level))
        if len(solutions) < 2:
            continue
        estimate = error(solutions)
        if met(solutions[-1], estimate):
            return Refined(solutions[-1], estimate, True, tuple(solutions))
        if hopeless(solutions[-1], estimate):
            break
    return Refined(solutions[-1], estimate, False, tuple(solutions))
