"""Refinement of one part of a resolution at a time, such as a variable of a grid.

Two levels may agree although they are wrong, if both leave the same part coarse. Here each part of
the resolution is changed by itself. What the solution changes then is the error of this part, and
the error is the sum over all parts. A part is refined whose error is large.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import Part
from nonsmooth.progress import counter


@dataclass(frozen=True)
class Found:
    """What a refinement found.

    Attributes
    ----------
    value, change : numpy.ndarray, shape (2, k)
        Probability and survival probability, and the sum of the changes of all parts.
    """

    value: np.ndarray
    change: np.ndarray


def refine_each_part(
    parts: tuple[Part, ...],
    solve: Callable[[tuple[int, ...]], np.ndarray],
    met: Callable[[Found], bool],
    tol: float,
) -> Found:
    """Refine the parts until the error is met or nothing finer is left.

    Parameters
    ----------
    parts : tuple of Part
    solve : callable
        Takes the resolutions of all parts; returns probability and survival probability.
    met : callable
        Whether a result is accurate enough.
    tol : float
        Absolute error wanted, to which the parts may contribute about equally.

    Returns
    -------
    Found
    """
    with counter("solutions") as advance:

        @cache
        def solution(at):
            found = solve(at)
            advance(1)
            return found

        return _refined(parts, solution, met, tol)


def _refined(parts, solution, met, tol):
    """Refine with solutions that are not computed twice."""
    settings = tuning.EACH_PART
    at = tuple(part.first for part in parts)
    before = np.zeros(len(parts))[:, None, None]
    while True:
        base = solution(at)
        changes = np.array(
            [solution(_stepped(at, k, part.step)) - base for k, part in enumerate(parts)]
        )
        # the changes of finer parts are added: what remains is the change of their changes
        finer = np.array([part.step > 0 for part in parts])
        counted = np.where(finer, 1.0, settings.coarser)[:, None, None]
        sizes = np.maximum(counted * np.abs(changes), settings.kept * before)
        found = Found(base + changes[finer].sum(axis=0), sizes.sum(axis=0))
        if met(found):
            return found
        open_ = [at[k] < part.last for k, part in enumerate(parts)]
        worst = np.where(open_, sizes.max(axis=(1, 2)), 0.0)
        chosen = worst >= min(worst.max(), settings.share * tol)
        if not worst.max() > 0:
            return found
        at = tuple(n + int(c and o) for n, c, o in zip(at, chosen, open_, strict=True))
        before = np.where(chosen[:, None, None], sizes, settings.kept * before)


def _stepped(at, k, step):
    return (*at[:k], at[k] + step, *at[k + 1 :])
