"""Inverse Laplace transform on hyperbolic contours.

f(t) = 1/(2 pi i) int exp(z t) F(z) dz is computed by the trapezoidal rule on the hyperbola
z(u) = z_0 + mu (1 + sin(iu - a)). The error falls geometrically with the number of nodes if F is
analytic outside of a sector around the negative axis. One hyperbola serves all times of an
interval, with the parameters of Weideman and Trefethen, Math. Comp. 76 (2007) 1341. Where f is
small, a hyperbola through the saddle point of exp(z t) F(z) keeps the relative error small.

The nodes are as close to each other as exp(z t) requires. F alone changes less, and hyperbolas of
neighbouring intervals cover the same part of the plane. `inverted_together` evaluates F at some
nodes of several hyperbolas. At the others it takes a rational function fitted to these values by
the algorithm AAA (Nakatsukasa, Sete and Trefethen, SIAM J. Sci. Comput. 40 (2018) A1494).
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import AAA
from scipy.optimize import minimize_scalar

from nonsmooth.crossing.first_passage import tuning


@dataclass(frozen=True)
class Contour:
    """Nodes in the upper half plane and their weights.

    Attributes
    ----------
    nodes, weights : numpy.ndarray of complex, shape (k,)
    """

    nodes: np.ndarray
    weights: np.ndarray

    def until(self, count: int) -> "Contour":
        """Drop the nodes beyond the first `count`."""
        return Contour(self.nodes[:count], self.weights[:count])

    def over_z(self) -> "Contour":
        """Return the contour that inverts F(z) / z if it is given F."""
        return Contour(self.nodes, self.weights / self.nodes)

    def invert(self, transform: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Sum the trapezoidal rule.

        Parameters
        ----------
        transform : numpy.ndarray of complex, shape (k,)
            F at the nodes; F is real on the real axis.
        times : numpy.ndarray, shape (t,)

        Returns
        -------
        numpy.ndarray, shape (t,)
        """
        return (np.exp(np.outer(times, self.nodes)) @ (self.weights * transform)).imag


def hyperbola(
    first: float, last: float, count: int, sector: float = 0.0, pole: float = 0.0
) -> Contour:
    """Choose the contour for times between `first` and `last`.

    Parameters
    ----------
    first, last : float
    count : int
        Number of nodes in the upper half plane that these times would need if F were constant.
    sector : float
        F is analytic where |arg(pole - z)| > sector.
    pole : float
        Rightmost point of that sector, at most 0.

    Returns
    -------
    Contour
        With more nodes than needed, from the axis on: stop where the terms are negligible.
    """
    ratio = last / first

    def reach(a):
        return np.arccosh(
            ((np.pi - 2 * a - 2 * sector) * ratio + 4 * a - np.pi + 2 * sector)
            / ((4 * a - np.pi + 2 * sector) * np.sin(a))
        )

    def slowness(a):
        return -(np.pi**2 - 2 * np.pi * a - 2 * np.pi * sector) / reach(a)

    least, most = np.pi / 4 - sector / 2, np.pi / 2 - sector
    margin = 1e-6 * (most - least)
    a = minimize_scalar(slowness, bounds=(least + margin, most - margin), method="bounded").x
    step = reach(a) / count
    mu = (4 * np.pi * a - np.pi**2 + 2 * np.pi * sector) / reach(a) * count / last
    u = (np.arange(tuning.CONTOURS.spare * count) + 0.5) * step
    nodes = pole + mu * (1 + np.sin(1j * u - a))
    return Contour(nodes, mu * step / np.pi * 1j * np.cos(1j * u - a))


def through_saddle(saddle: float, width: float, spacing: float, tilt: float) -> Contour:
    """Choose the contour that crosses the axis at the saddle point of exp(z t) F(z).

    Parameters
    ----------
    saddle : float
        Positive.
    width : float
        Width of exp(z t) F(z) along the contour: its standard deviation if it were normal.
    spacing : float
        Of the nodes, relative to what ten digits need.
    tilt : float
        Angle of the asymptotes to the left of the vertical.

    Returns
    -------
    Contour
        With more nodes than needed, from the axis on: stop where the terms are negligible.
    """
    settings = tuning.CONTOURS
    near = spacing * min(settings.of_width * width, settings.of_saddle * saddle)
    least, scale = settings.steep
    near *= min(1.0, least + tilt / scale)
    step = near / (saddle * np.cos(tilt))
    u = (np.arange(int(settings.farthest / step)) + 0.5) * step
    bend = np.sin(1j * u - tilt)
    nodes = saddle * (1 + bend + np.sin(tilt))
    return Contour(nodes, saddle * step / np.pi * 1j * np.cos(1j * u - tilt))


def inverted(
    transform: Callable[[complex], complex], contour: Contour, times: np.ndarray, negligible: float
) -> np.ndarray:
    """Evaluate a transform along a contour until its terms are negligible, and invert it.

    Parameters
    ----------
    transform : callable
        F.
    contour : Contour
    times : numpy.ndarray, shape (t,)
        Increasing. Terms are examined at the first one, where they fall most slowly.
    negligible : float
        Relative to the first term.

    Returns
    -------
    numpy.ndarray, shape (t,)
    """
    values = _until_negligible(transform, contour, times, negligible, range(len(contour.nodes)))
    return contour.until(len(values)).invert(np.array(list(values.values())), times)


def _until_negligible(transform, contour, times, negligible, chosen):
    """Evaluate chosen nodes and the last one, until the terms are negligible: values by nodes."""
    values: dict[int, complex] = {}
    last = min(len(contour.nodes), tuning.CONTOURS.truncation_most) - 1
    for k in range(last + 1):
        if k not in chosen and k != last:
            continue
        values[k] = transform(contour.nodes[k])
        term = np.abs(contour.weights[k] * values[k]) * np.exp(contour.nodes[k].real * times[0])
        if k == 0:
            largest = term
        elif term < negligible * largest:
            break
    return values


def inverted_together(
    transform: Callable[[complex], complex],
    contours: Sequence[tuple[Contour, np.ndarray]],
    negligible: float,
    accuracy: float,
) -> list[np.ndarray]:
    """Invert a transform on several contours, with a rational fit in the place of most values.

    Nodes are added to a contour until a fit agrees with the one before, at all nodes that had no
    values then.

    Parameters
    ----------
    transform : callable
        F, real on the real axis.
    contours : sequence of (Contour, numpy.ndarray)
        Each with the times that it serves, increasing.
    negligible : float
        Size of a term that ends a contour, relative to the first one, at the first time.
    accuracy : float
        Absolute; what the last fit may change. If it is 0, all nodes are evaluated.

    Returns
    -------
    list of numpy.ndarray
        The inverse at the times of each contour.
    """
    fits = tuning.CONTOUR_FITS
    sampled = [_Sampled.begun(transform, *one, negligible) for one in contours]
    if accuracy == 0:
        for one in sampled:
            one.evaluate(transform, fits.then)
    values, changes = _filled(sampled, fits.closeness * accuracy), [np.inf] * len(sampled)
    for count in range(1, len(fits.then) + 1):
        unsettled = [one for one, c in zip(sampled, changes, strict=True) if not c <= accuracy]
        if not unsettled:
            break
        if sum(one.evaluate(transform, fits.then[:count]) for one in unsettled):
            before, values = values, _filled(sampled, fits.closeness * accuracy)
            changes = [
                one.change(old, new) for one, old, new in zip(sampled, before, values, strict=True)
            ]
    return [one.contour.invert(v, one.times) for one, v in zip(sampled, values, strict=True)]


@dataclass(frozen=True)
class _Sampled:
    """A contour as far as its terms count, and a transform at some of its nodes.

    Attributes
    ----------
    contour : Contour
    times : numpy.ndarray
    known : numpy.ndarray of bool, shape (k,)
    values : numpy.ndarray of complex, shape (k,)
        Where they are known.
    """

    contour: Contour
    times: np.ndarray
    known: np.ndarray
    values: np.ndarray

    @classmethod
    def begun(cls, transform, contour, times, negligible):
        """Evaluate some nodes, until the terms are negligible."""
        chosen = range(0, len(contour.nodes), tuning.CONTOUR_FITS.first)
        values = _until_negligible(transform, contour, times, negligible, chosen)
        at, count = list(values), max(values) + 1
        found = cls(contour.until(count), times, np.full(count, False), np.zeros(count, complex))
        found.known[at], found.values[at] = True, list(values.values())
        return found

    def evaluate(self, transform, places):
        """Evaluate the nodes at some places of each period; return how many were not known."""
        at = np.arange(len(self.known)) % tuning.CONTOUR_FITS.period
        new = np.flatnonzero(np.isin(at, places) & ~self.known)
        self.values[new] = [transform(z) for z in self.contour.nodes[new]]
        self.known[new] = True
        return len(new)

    def change(self, before, after):
        """Bound what is changed of the inverse."""
        exponents = np.max(np.outer(self.times[[0, -1]], self.contour.nodes.real), axis=0)
        return np.sum(np.abs(self.contour.weights * (after - before)) * np.exp(exponents))


def _filled(sampled, tolerance):
    """Values along all contours; those that are not known are taken from a fit to the others."""
    if all(one.known.all() for one in sampled):
        return [one.values for one in sampled]
    z = np.concatenate([one.contour.nodes[one.known] for one in sampled])
    values = np.concatenate([one.values[one.known] for one in sampled])
    largest = np.max(np.abs(values))
    if not np.isfinite(largest):
        return [np.where(one.known, one.values, np.nan) for one in sampled]
    with warnings.catch_warnings():
        # of a fit that is inaccurate; the next one shows that
        warnings.simplefilter("ignore", RuntimeWarning)
        # F is real on the axis: its values at the mirror images are known, too
        z, values = np.append(z, z.conj()), np.append(values, values.conj())
        fit = AAA(z, values, rtol=tolerance / max(largest, tolerance))
        return [np.where(one.known, one.values, fit(one.contour.nodes)) for one in sampled]
