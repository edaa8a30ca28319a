"""Refinement of one part of a resolution at a time, such as a variable of a grid.

Two levels may agree although they are wrong, if both leave the same part coarse. Here each part of
the resolution is changed by itself. What the solution changes then is the error of this part, and
the error is the sum over all parts. It counts at least as much of the change before as is usual for
the part: two resolutions may agree by chance. Where changes fall slowly, it counts all that would
follow. Where the order of a method is known, its changes are extrapolated, and the error is what
this changes from one resolution to the next; at least a share of the last change, or of what this
changed before, if that is known and less. The parts with the largest errors are refined; those with
small ones are measured again in the end if one is extrapolated: long steps hide what a grid misses.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import Part
from nonsmooth.errors import ToleranceError
from nonsmooth.kinetic.ordinates_plane import UnstableError
from nonsmooth.progress import counter
from nonsmooth.refine import further_terms, solvable


@dataclass(frozen=True)
class Found:
    """What a refinement found.

    Attributes
    ----------
    value, change : numpy.ndarray, shape (2, k)
        Probability and survival probability, and the sum of the changes of all parts; where these
        fall by less than a half, of all that would follow.
    """

    value: np.ndarray
    change: np.ndarray


def refine_each_part(
    parts: tuple[Part, ...],
    solve: Callable[[tuple[int, ...]], np.ndarray],
    met: Callable[[Found], bool],
    tol: float,
    most: float = math.inf,
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
    most : float
        How often errors are measured, unless they are close to `tol` then: another method may take
        less than going on.

    Returns
    -------
    Found
        The last if it is met; else the best before a grid is unstable, refused or no longer better,
        or the tolerance is out of reach, with what later ones differ from it by.

    Raises
    ------
    UnstableError
        If the first one is, and the next one, too.
    ToleranceError
        If the first one, or one that it is compared with, is refused or not `solvable`.
    """
    with counter("solutions") as advance:

        @cache
        def solution(at):
            with solvable():
                found = solve(at)
            advance(1)
            return found

        return _refined(parts, solution, met, tol, most)


class _Best:
    """The result whose changes are smallest.

    Attributes
    ----------
    grown : int
        How often changes were not smaller than those before.
    """

    def __init__(self) -> None:
        self._found: Found | None = None
        self._least, self._last, self.grown = math.inf, math.inf, 0
        self._doubt = np.zeros(0)

    def take(self, found: Found, size: float) -> None:
        """Keep a result if its changes, which are of a size, are smaller than all before."""
        if self._found is None or size < self._least:
            self._found, self._least, self._doubt = found, size, np.zeros_like(found.value)
        self._doubt = np.maximum(self._doubt, np.abs(found.value - self._found.value))
        self.grown += not size < self._last
        self._last = size

    def forget(self) -> None:
        """Keep the next result, whatever its changes are."""
        self._least = self._last = math.inf

    def found(self) -> Found:
        """Return the best result; what later ones differ from it by is an error, too."""
        assert self._found is not None
        return Found(self._found.value, self._found.change + self._doubt)


def _refined(parts, solution, met, tol, most):
    """Refine with solutions that are not computed twice."""
    settings = tuning.EACH_PART
    at = begun = tuple(part.first - int(part.coarser and tol >= settings.loose) for part in parts)
    # the changes of finer parts are added: what remains is the change of their changes
    finer, settled = np.array([part.step > 0 for part in parts]), np.full(len(parts), False)
    rows = [(part.counted, part.falls, part.beyond) for part in parts]
    counted, falls, beyond = np.transpose(rows)[:, :, None, None]
    before, found, changes, further_before, best = None, None, None, np.inf, _Best()
    while True:
        try:
            base = solution(at)
            changes = np.array(
                [
                    changes[k] if settled[k] else solution(_stepped(at, k, part.step)) - base
                    for k, part in enumerate(parts)
                ]
            )
            if before is None:
                before = _changes_from_coarser(parts, solution, at)
                floor = falls * np.abs(before)
        except (UnstableError, ToleranceError) as refused:
            if found is not None:
                return best.found()
            if at != begun or not isinstance(refused, UnstableError):
                raise
            at = tuple(min(n + 1, part.last) for n, part in zip(at, parts, strict=True))
            continue
        rates = _rates(changes, before)
        extrapolated = (1 + beyond) * changes
        # what this adds to the change before, which is extrapolated, too
        further = extrapolated - beyond * before
        least = np.minimum(falls * np.abs(changes), settings.again * further_before)
        floor = np.where(beyond > 0, least, floor)
        sizes = np.maximum(counted * np.abs(further), floor)
        errors = further_terms(rates)[:, None, None] * sizes
        value = base + extrapolated[finer].sum(axis=0)
        found, most = Found(value, errors.sum(axis=0)), most - 1
        best.take(found, sizes.sum(axis=0).max())
        over = met(found)
        if not over and best.grown > settings.patience:
            return best.found()
        left = np.array([part.last - n for n, part in zip(at, parts, strict=True)])
        worst = errors.max(axis=(1, 2))
        small = worst <= settings.settled * tol
        chosen = _to_refine(np.where((left > 0) & ~small, worst, 0.0), errors, falls, tol)
        hopeless = _least(further, rates, falls, left) > settings.hopeless * tol
        if most <= 0 and not over and np.max(found.change) > settings.close * tol:
            return best.found()
        if over or hopeless or not chosen.any():
            if not (settled.any() and beyond.any()):
                return found if over else best.found()
            # steps that are still long hide what a grid misses
            settled = np.full(len(parts), False)
            best.forget()
            continue
        # what hardly counts is neither refined nor measured again on the next grid
        settled = small
        at = tuple(n + int(c) for n, c in zip(at, chosen, strict=True))
        refined = chosen[:, None, None]
        further_before = np.where(refined, np.abs(further), further_before)
        floor, before = np.where(refined, falls * sizes, floor), np.where(refined, changes, before)


def _changes_from_coarser(parts, solution, at):
    """Compute what the parts changed before: two resolutions may agree by chance, three hardly."""
    base = solution(at)
    return np.array(
        [
            base - solution(_stepped(at, k, -1))
            if part.step > 0 and at[k] > 0
            else np.zeros_like(base)
            for k, part in enumerate(parts)
        ]
    )


def _rates(changes, before):
    """Return what each part changes over what it changed before; 0 where this is not known."""
    last, first = (np.max(np.abs(size), axis=(1, 2)) for size in (changes, before))
    return np.divide(last, first, out=np.zeros_like(last), where=first > 0)


def _least(changes, rates, falls, left):
    """Extrapolate the sum of the changes to the finest resolutions of all parts.

    Each is taken to go on to fall as it has fallen, at least as is usual for its part.
    """
    sizes = np.max(np.abs(changes), axis=(1, 2))
    return np.sum(sizes * np.clip(rates, np.ravel(falls), 1.0) ** left)


def _to_refine(worst, sizes, falls, tol):
    """Choose the worst parts, as few as should do."""
    chosen = np.zeros(len(worst), dtype=bool)
    left = sizes.copy()
    for k in np.argsort(-worst):
        if worst[k] > 0 and left.sum(axis=0).max() > tuning.EACH_PART.enough * tol:
            left[k] *= falls[k]
            chosen[k] = True
    return chosen


def _stepped(at, k, step):
    return (*at[:k], at[k] + step, *at[k + 1 :])
