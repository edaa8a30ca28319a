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
from nonsmooth.kinetic.ordinates_plane import UnstableError
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
        Absolute error wanted.

    Returns
    -------
    Found
        The last, or the last before a grid is unstable or no longer better.

    Raises
    ------
    UnstableError
        If the first one is.
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
    loose = sum(tol >= limit for limit in settings.loose)
    at = tuple(part.first - min(part.coarser, loose) for part in parts)
    # the changes of finer parts are added: what remains is the change of their changes
    finer = np.array([part.step > 0 for part in parts])
    counted = np.where(finer, 1.0, settings.coarser)[:, None, None]
    before, found = np.zeros(len(parts))[:, None, None], None
    while True:
        try:
            base = solution(at)
            changes = np.array(
                [solution(_stepped(at, k, part.step)) - base for k, part in enumerate(parts)]
            )
        except UnstableError:
            if found is None:
                raise
            return found
        sizes = np.maximum(counted * np.abs(changes), settings.kept * before)
        coarser, found = found, Found(base + changes[finer].sum(axis=0), sizes.sum(axis=0))
        if met(found):
            return found
        if coarser is not None and not found.change.max() < coarser.change.max():
            return coarser
        open_ = np.array([at[k] < part.last for k, part in enumerate(parts)])
        chosen = _to_refine(np.where(open_, sizes.max(axis=(1, 2)), 0.0), sizes, tol)
        if not chosen.any():
            return found
        at = tuple(n + int(c) for n, c in zip(at, chosen, strict=True))
        before = np.where(chosen[:, None, None], sizes, settings.kept * before)


def _to_refine(worst, sizes, tol):
    """Choose the worst parts: as few as should do, for the others need not be computed again."""
    chosen = np.zeros(len(worst), dtype=bool)
    left = sizes.copy()
    for k in np.argsort(-worst):
        if worst[k] > 0 and left.sum(axis=0).max() > tuning.EACH_PART.enough * tol:
            left[k] *= tuning.EACH_PART.expected
            chosen[k] = True
    return chosen


def _stepped(at, k, step):
    return (*at[:k], at[k] + step, *at[k + 1 :])
