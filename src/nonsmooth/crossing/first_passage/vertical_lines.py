"""Inverse Laplace transform on vertical lines, by rational functions fitted to a transform F.

Contours that bend to the left come near poles of F off the real axis, and F grows there if many
paths arrive together. On a vertical line F is bounded by its value on the real axis. There it is
sampled at heights in geometric progression and fitted by the algorithm AAA (Nakatsukasa, Sete and
Trefethen, SIAM J. Sci. Comput. 40 (2018) A1494). The inverse is then a sum of exponentials over the
poles to the left of the line, for all times. If the fit is good to epsilon on the line Re z = s,
the inverse at t is good to exp(s t) epsilon, up to a logarithm.

F is the sum of parts, one for each exit, which are fitted without factors exp(-z t_0), t_0 being
the time before which no path arrives: exponentials have no good rational approximation.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import AAA

from nonsmooth.crossing.first_passage import tuning

Parts = Callable[[complex], np.ndarray]  # the parts of F at a point, shape (m,)


@dataclass(frozen=True)
class Exponentials:
    """A function of time: for each part sum_k c_k exp(p_k (t - t_0)), 0 before t_0.

    Attributes
    ----------
    delays : numpy.ndarray, shape (m,)
        t_0 of each part.
    terms : list of (numpy.ndarray, numpy.ndarray)
        p_k and log c_k of each part; the c_k themselves may be too large for a number.
    misfit : float
        Largest error of the fits at the samples, and at zeros far above, relative to the size of F.
    """

    delays: np.ndarray
    terms: list
    misfit: float = 0.0

    def at(self, times: np.ndarray) -> np.ndarray:
        """Evaluate the function at times, shape (k,)."""
        total = np.zeros(len(times))
        for delay, (exponents, logarithms) in zip(self.delays, self.terms, strict=True):
            begun = times > delay
            since = times[begun] - delay
            total[begun] += np.exp(np.outer(since, exponents) + logarithms).sum(axis=1).real
        return total


@dataclass(frozen=True)
class Line:
    """A vertical line, and what is known of F on it.

    Attributes
    ----------
    abscissa : float
        Re z; positive.
    size : float
        Of F, to which accuracies are relative.
    lowest : float
        Height up to which F hardly changes.
    """

    abscissa: float
    size: float
    lowest: float


def line(parts: Parts, abscissa: float) -> Line:
    """Return a line on which the transform of a probability is largest on the real axis.

    Parameters
    ----------
    parts : callable
        The parts of F.
    abscissa : float

    Returns
    -------
    Line
    """
    settings = tuning.VERTICAL_LINES
    size = np.sum(parts(complex(abscissa))).real
    # 1 - F over z is a mean duration: F changes little closer to the axis than its inverse
    return Line(abscissa, size, settings.first / max(1 - size, settings.least))


def inverted(
    parts: Parts, line: Line, delays: np.ndarray, accuracy: float, rising: bool, offset: float
) -> Exponentials:
    """Invert F(z) / z by a rational fit on a vertical line.

    Parameters
    ----------
    parts : callable
        The parts of F.
    line : Line
    delays : numpy.ndarray, shape (m,)
        Times before which the parts contribute nothing.
    accuracy : float
        Of the fit, relative to the size of F.
    rising : bool
        Whether the inverse is still small, so that F / z is fitted instead of F: the pole at 0 is
        far from the line then, and its residue would cancel.
    offset : float
        Between 0 and 1: shifts the places, so that two fits share none.

    Returns
    -------
    Exponentials
    """
    abscissa, size = line.abscissa, line.size
    if size <= 0:  # rounding
        return Exponentials(delays, [(np.zeros(0), np.zeros(0))] * len(delays))

    def scaled(height):
        z = complex(abscissa, height)
        values = parts(z) * np.exp(1j * height * delays) / size
        return values * (abscissa / z) if rising else values

    with np.errstate(divide="ignore"):
        # above, the phase of exp(-z t_0) is rounded by more than the accuracy
        highest = accuracy / (tuning.VERTICAL_LINES.phase * np.max(delays))
    sampled = _sampled(scaled, line, accuracy, offset, highest)
    terms, misfit, unit = [], 0.0, tuning.VERTICAL_LINES.unit * abscissa
    for (z, values), delay in zip(sampled, delays, strict=True):
        *found, error = _residues(z, values, accuracy)
        misfit = max(misfit, error)
        poles, residues = (unit * part for part in found)
        if rising:
            exponents, coefficients = poles, residues / abscissa
        else:  # the pole of 1 / z, at which F is minus the sum of the others
            coefficients = residues / poles
            exponents = np.append(poles, 0.0)
            coefficients = np.append(coefficients, -coefficients.sum())
        with np.errstate(divide="ignore"):  # of coefficients that are 0
            terms.append((exponents, np.log(coefficients) + np.log(size) + abscissa * delay))
    return Exponentials(delays, terms, misfit)


def _sampled(scaled, line, accuracy, offset, highest):
    """Sample until F is negligible, and then where fits to the samples so far are wrong."""
    settings, abscissa = tuning.VERTICAL_LINES, line.abscissa
    # heights are on a lattice that transforms of different thresholds share
    place = np.floor(np.log(line.lowest) / np.log(settings.step)) + offset
    samples, rest = {0.0: scaled(0.0)}, settings.beyond
    while rest and (height := abscissa * settings.step**place) < highest:
        samples[height] = scaled(height)
        rest = rest - 1 if np.all(np.abs(samples[height]) < accuracy) else settings.beyond
        place += 1
    unsure, worst = list(pairwise(list(samples)[1:])), np.inf
    unit = settings.unit * abscissa
    while unsure and len(samples) < settings.most:
        columns = _columns(samples, abscissa)
        fits = [_fit(*part, accuracy, settings.shares[0]) for part in columns]
        wrong, errors = [], []
        for low, high in unsure:
            middle = np.sqrt(low * high)
            samples[middle] = scaled(middle)
            found = [fit(complex(abscissa, middle) / unit) if fit else 0.0 for fit in fits]
            errors.append(np.max(np.abs(found - samples[middle])))
            if errors[-1] > accuracy:
                wrong += [(low, middle), (middle, high)]
        if max(errors) > settings.falls * worst:  # this is rounding of F, which no sample mends
            break
        unsure, worst = wrong, max(errors)
    return _columns(samples, abscissa)


def _columns(samples, abscissa):
    """Places on the line, in units that suit the fits, and values, for each part."""
    z = (abscissa + 1j * np.array(list(samples))) / (tuning.VERTICAL_LINES.unit * abscissa)
    return [(z, part) for part in np.array(list(samples.values())).T]


def _mirrored(z, values):
    """Add zeros far up the line, and the mirror images of all below the real axis."""
    far = np.max(z.imag) * np.array(tuning.VERTICAL_LINES.far)
    z = np.append(z, z[0].real + 1j * far)
    values = np.append(values, np.zeros(len(far)))
    above = z.imag > 0
    return np.append(z, z[above].conj()), np.append(values, values[above].conj())


def _fit(z, values, accuracy, share):
    """Fit a rational function that is real on the real axis; None if 0 is accurate enough."""
    settings = tuning.VERTICAL_LINES
    largest = np.max(np.abs(values))
    if largest <= accuracy:
        return None
    rtol = share * accuracy / largest
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # that the samples are rounded
        return AAA(*_mirrored(z, values), rtol=rtol, max_terms=settings.terms, clean_up=False)


def _residues(z, values, accuracy):
    """Poles to the left of the line, residues at them, and the largest error of the fit.

    The residues are fitted once more, to these poles alone: those of the rational function of a
    high degree are not accurate far from the line. Where F is as good as rounded, a close fit has
    poles to the right, too, without which it is worse than a less close one.
    """
    line, settings = z[0].real, tuning.VERTICAL_LINES
    found, least = (np.zeros(0, complex), np.zeros(0, complex)), float(np.max(np.abs(values)))
    for share in settings.shares:
        if least <= accuracy:
            break
        poles = _fit(z, values, accuracy, share).poles()
        poles = poles[poles.real < line]
        places, wanted = _mirrored(z, values)
        distances = line - poles.real
        columns = distances / (places[:, None] - poles)
        strengths = np.linalg.lstsq(columns, wanted, rcond=settings.rounding)[0]
        error = np.max(np.abs(columns @ strengths - wanted))
        if error < least:
            found, least = (poles, distances * strengths), error
    return *found, least
