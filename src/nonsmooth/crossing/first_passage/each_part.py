"""Refinement of one part of a resolution at a time, such as a variable of a grid.

Two levels may agree although they are wrong, if both leave the same part coarse. Here each part of
the resolution is changed by itself. What the solution changes then is the error of this part, and
the error is the sum over all parts. It counts at least as much of the change before as is usual for
the part: two resolutions may agree by chance. Where changes fall slowly, it counts all that would
follow. Where the order of a method is known, its changes are extrapolated, and the error is what
this changes from one resolution to the next; at least a share of the last change, or of what this
changed before, if that is known and less. The parts with the largest errors are refined; those with
small ones are measured again in the end if one is extrapolated: long steps hide what a grid misses.

Where refining several parts together changes the solution by the sum of what each changes alone,
the next change of each is measured with the others still coarse, which takes less. What this sum
misses is an error, too, as far as the part's changes fall. Late times that are met are left out.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

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
    solve: Callable[[tuple[int, ...], int | None], np.ndarray],
    met: Callable[[Found], ArrayLike],
    tol: float,
    most: float = math.inf,
) -> Found:
    """Refine the parts until the error is met or nothing finer is left.

    Parameters
    ----------
    parts : tuple of Part
    solve : callable
        Takes the resolutions of all parts, and how many times are wanted, None for all; returns
        probability and survival probability at the first of them, or at all.
    met : callable
        Whether a result is accurate enough, shape (k,), or at all times.
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
        known: dict[tuple[int, ...], np.ndarray] = {}

        def solution(at, count):
            if at not in known:
                with solvable():
                    known[at] = solve(at, count)
                advance(1)
            return known[at][..., :count]

        return _refined(_Rounds(parts, solution, tol), met, most)


class _Best:
    """The result whose changes are smallest.

    Attributes
    ----------
    grown : int
        How often changes were not smaller than those before.
    """

    def __init__(self) -> None:
        self._found: Found | None = None
        self._doubt = self._least = self._last = np.zeros(())
        self.grown = 0

    def take(self, found: Found, sizes: np.ndarray) -> None:
        """Keep a result at the first times if its changes are smaller there than all before.

        Parameters
        ----------
        found : Found
        sizes : numpy.ndarray, shape (2, m)
            Of its changes at the m first times, at which it is new.
        """
        if self._found is None:
            self._found = Found(found.value.copy(), found.change.copy())
            self._doubt = np.zeros_like(found.value)
            self.forget()
        here = np.s_[:, : sizes.shape[1]]
        if sizes.max() < self._least[here].max():
            self._keep(found, here)
            self._least[here] = sizes
        apart = np.abs(found.value - self._found.value)[here]
        self._doubt[here] = np.maximum(self._doubt[here], apart)
        self.grown += not sizes.max() < self._last[here].max()
        self._last = sizes

    def leave(self, found: Found, count: int) -> None:
        """Keep a result as it is at all but the first times."""
        self._keep(found, np.s_[:, count:])

    def _keep(self, found, here):
        assert self._found is not None
        self._found.value[here], self._found.change[here] = found.value[here], found.change[here]
        self._doubt[here] = 0.0

    def forget(self) -> None:
        """Keep the next result, whatever its changes are."""
        self._least, self._last = np.full((2, *self._doubt.shape), np.inf)

    def found(self) -> Found:
        """Return the best result; what later ones differ from it by is an error, too."""
        assert self._found is not None
        return Found(self._found.value, self._found.change + self._doubt)


class _Rounds:
    """Rounds of measuring what each part changes, and of refining some of them.

    Parameters
    ----------
    parts, tol
        As for `refine_each_part`.
    solution : callable
        Takes the resolutions of all parts, and how many times are wanted.

    Attributes
    ----------
    at : tuple of int
        Resolutions.
    tol : float
    """

    def __init__(self, parts: tuple[Part, ...], solution: Callable, tol: float):
        self._parts, self._solution, self.tol = parts, solution, tol
        rows = [(part.counted, part.falls, part.beyond) for part in parts]
        self._counted, self._falls, self._beyond = np.transpose(rows)[:, :, None, None]
        self._finer = np.array([part.step > 0 for part in parts])
        loose = tol >= tuning.EACH_PART.loose
        self.at = tuple(part.first - int(part.coarser and loose) for part in parts)
        self._count: int | None = None
        self._refined = self._settled = np.full(len(parts), False)
        self._previous: tuple[int, ...] = ()
        self._further_before: float | np.ndarray = np.inf

    def begin_finer(self) -> None:
        """Begin at the next resolution."""
        self.at = tuple(min(n + 1, p.last) for n, p in zip(self.at, self._parts, strict=True))

    def measured(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Measure what the parts change.

        Returns
        -------
        value : numpy.ndarray, shape (2, m)
            At the m times that are still wanted.
        sizes, errors : numpy.ndarray, shape (number of parts, 2, m)
            What is left of the changes, and of all that would follow.
        """
        settings, base = tuning.EACH_PART, self._solution(self.at, self._count)
        changes, missed = self._measure(base)
        if not self._previous:
            self._before = self._changes_from_coarser(base)
            self._floor = self._falls * np.abs(self._before)
        self._base, self._changes = base, changes
        self._rates = _rates(changes, self._before)
        # the changes of finer parts are added: what remains is the change of their changes
        extrapolated = (1 + self._beyond) * changes
        # what this adds to the change before, which is extrapolated, too
        self._further = extrapolated - self._beyond * self._before
        least = np.minimum(self._falls * np.abs(changes), settings.again * self._further_before)
        self._floor = np.where(self._beyond > 0, least, self._floor)
        sizes = np.maximum(self._counted * np.abs(self._further), self._floor)
        sizes += np.clip(self._rates[:, None, None], self._falls, 1.0) * missed
        errors = further_terms(self._rates)[:, None, None] * sizes
        return base + extrapolated[self._finer].sum(axis=0), sizes, errors

    def _measure(self, base):
        """Measure changes, and what their sum misses of refining those that are not at `at`."""
        changes = {
            k: self._change(self.at, k, base)
            for k in np.flatnonzero(~self._settled & ~(self._finer & self._refined)).tolist()
        }
        refined = np.flatnonzero(self._finer & self._refined).tolist()
        missed, additive = 0.0, False
        if refined:
            coarser = (changes[k] for k in np.flatnonzero(~self._finer & self._refined).tolist())
            missed = np.abs(base + sum(coarser) - self._predicted)
            additive = missed.max() <= tuning.EACH_PART.additive * self.tol
        for k in refined:
            at = _stepped(self._previous, k, 1) if additive else self.at
            changes[k] = self._change(at, k, self._solution(at, self._count))
        for k in np.flatnonzero(self._settled).tolist():
            changes[k] = self._changes[k]
        elsewhere = (self._finer & self._refined & additive)[:, None, None]
        return np.array([changes[k] for k in range(len(self._parts))]), elsewhere * missed

    def _change(self, at, k, base):
        """Return what a part changes from resolutions whose solution is `base`."""
        return self._solution(_stepped(at, k, self._parts[k].step), self._count) - base

    def _changes_from_coarser(self, base):
        """Return what parts changed before: two resolutions may agree by chance, three hardly."""
        return np.array(
            [
                base - self._solution(_stepped(self.at, k, -1), self._count)
                if part.step > 0 and self.at[k] > 0
                else np.zeros_like(base)
                for k, part in enumerate(self._parts)
            ]
        )

    @property
    def hopeless(self) -> bool:
        """Whether the tolerance is out of reach of the finest resolutions."""
        least = _least(self._further, self._rates, self._falls, self._left)
        return least > tuning.EACH_PART.hopeless * self.tol

    @property
    def _left(self):
        """How many finer resolutions there are of each part."""
        return np.array([part.last - n for n, part in zip(self.at, self._parts, strict=True)])

    @property
    def hides(self) -> bool:
        """Whether small changes were measured with steps that were longer than they are now."""
        return bool(self._settled.any() and self._beyond.any())

    def again(self) -> None:
        """Measure small changes again."""
        self._settled = np.full(len(self._parts), False)

    def refine(self, errors: np.ndarray, sizes: np.ndarray, count: int) -> bool:
        """Refine the worst parts, for the first times; return whether there are any.

        Parameters
        ----------
        errors, sizes
            Those that were measured.
        count : int
            How many times are still wanted.
        """
        errors, sizes = errors[..., :count], sizes[..., :count]
        worst = errors.max(axis=(1, 2))
        # what hardly counts is neither refined nor measured again on the next grid
        small = worst <= tuning.EACH_PART.settled * self.tol
        worst = np.where((self._left > 0) & ~small, worst, 0.0)
        chosen = _to_refine(worst, errors, self._falls, self.tol)
        if not chosen.any():
            return False
        rows, changes = chosen[:, None, None], self._changes[..., :count]
        further = np.broadcast_to(self._further_before, self._further.shape)
        self._further_before = np.where(rows, np.abs(self._further), further)[..., :count]
        self._floor = np.where(rows, self._falls * sizes, self._floor[..., :count])
        self._before = np.where(rows, changes, self._before[..., :count])
        self._predicted = self._base[..., :count] + changes[self._finer & chosen].sum(axis=0)
        self._changes, self._count = changes, count
        self._settled, self._refined, self._previous = small, chosen, self.at
        self.at = tuple(n + int(c) for n, c in zip(self.at, chosen, strict=True))
        return True


def _refined(rounds, met, most):
    """Refine with solutions that are not computed twice."""
    settings, best, begun = tuning.EACH_PART, _Best(), rounds.at
    found: Found | None = None
    while True:
        try:
            value, sizes, errors = rounds.measured()
        except (UnstableError, ToleranceError) as refused:
            if found is not None:
                return best.found()
            if rounds.at != begun or not isinstance(refused, UnstableError):
                raise
            rounds.begin_finer()
            continue
        found, most = _renewed(found, value, errors.sum(axis=0)), most - 1
        best.take(found, sizes.sum(axis=0))
        good = np.broadcast_to(met(found), found.value.shape[1:])
        over, count = good.all(), value.shape[1]
        if not over and best.grown > settings.patience:
            return best.found()
        if most <= 0 and not over and np.max(found.change) > settings.close * rounds.tol:
            return best.found()
        if not (over or rounds.hides):
            count = min(count, int(np.flatnonzero(~good)[-1]) + 1)
            best.leave(found, count)
        if over or rounds.hopeless or not rounds.refine(errors, sizes, count):
            if not rounds.hides:
                return found if over else best.found()
            # steps that are still long hide what a grid misses
            rounds.again()
            best.forget()


def _renewed(found, value, change):
    """Put what is new at the first times in the place of what was found."""
    if found is None:
        return Found(value, change)
    count = value.shape[1]
    return Found(
        np.hstack([value, found.value[:, count:]]), np.hstack([change, found.change[:, count:]])
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
