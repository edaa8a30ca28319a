"""Edges of the elements of one variable that crowd together where a function is hard to resolve.

There are three gradings. `geometric` has an exact ratio; the caller adds the point towards which
the edges crowd, and with it the smallest element. `graded` has equal ratios and ends exactly at the
smallest distance. `growing` starts with the smallest element and limits the size of the largest.

The other functions put edges together: `mirrored`, `distinct` and `split`.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

_EXACT = 1e-9  # rounding must not add an element where the ratio of the ends is an exact power


def layers(end: float, finest: float, ratio: float) -> int:
    """Count the factors `ratio` by which an end must be divided to reach `finest`, at least 1."""
    return max(1, math.ceil(math.log(end / finest, ratio) - _EXACT))


def geometric(end: float, ratio: float, count: int) -> np.ndarray:
    """Distances that fall from an end by exactly a ratio; the point 0 itself is left out.

    Parameters
    ----------
    end : float
        The first and largest distance.
    ratio : float
        Of neighbouring distances, above 1.
    count : int
        Of distances.

    Returns
    -------
    numpy.ndarray, shape (count,)
        Decreasing.
    """
    return end * ratio ** -np.arange(float(count))


def graded(end: float, finest: float, ratio: float) -> np.ndarray:
    """Distances that fall from an end to the finest one by equal ratios.

    Parameters
    ----------
    end, finest : float
        The first and the last distance.
    ratio : float
        Of neighbouring distances, at most.

    Returns
    -------
    numpy.ndarray
        Decreasing.
    """
    count = layers(end, finest, ratio)
    return end * (finest / end) ** (np.arange(count + 1) / count)


def growing(
    start: float, end: float, finest: float, widest: float, spare: float = 0.0
) -> np.ndarray:
    """Edges from a start to an end, each element twice as wide as the one before, up to a widest.

    Parameters
    ----------
    start, end : float
        start < end. The last edge may lie beyond the end.
    finest, widest : float
        Widths of the first element and, at most, of the others.
    spare : float
        The last element is left out if at most so many of its widths remain before the end.

    Returns
    -------
    numpy.ndarray
        Increasing, from `start` on.
    """
    edges, width = [start], finest
    while edges[-1] + spare * width < end:
        edges.append(edges[-1] + width)
        width = min(2 * width, widest)
    return np.array(edges)


def mirrored(edges: ArrayLike) -> np.ndarray:
    """Sort edges > 0, add the origin and the edges' mirror images."""
    edges = np.asarray(edges)
    return np.unique(np.concatenate([-edges, [0.0], edges]))


def distinct(edges: ArrayLike, tolerance: float = 0.0, relative: float = 0.0) -> np.ndarray:
    """Sort edges; of those that lie too close together, keep the first.

    Parameters
    ----------
    edges : array_like
    tolerance, relative : float
        An element must be wider than `tolerance` plus `relative` times its distance from 0.

    Returns
    -------
    numpy.ndarray
    """
    edges = np.unique(edges)
    apart = np.diff(edges) > tolerance + relative * np.abs(edges[1:])
    return edges[np.append(True, apart)]


def split(edges: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Split each element into equal parts.

    Parameters
    ----------
    edges : numpy.ndarray, shape (e + 1,)
    parts : numpy.ndarray of int, shape (e,)
        How many of each element.

    Returns
    -------
    numpy.ndarray
    """
    pieces = [
        left + width * np.arange(count) / count
        for left, width, count in zip(edges[:-1], np.diff(edges), parts, strict=True)
    ]
    return np.append(np.concatenate(pieces), edges[-1])
