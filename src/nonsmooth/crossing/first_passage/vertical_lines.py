"""Inverse Laplace transform on vertical lines, by rational functions fitted to a transform F.

Contours that bend to the left come near poles of F off the real axis, and F grows there if many
paths arrive together. On a vertical line F is bounded by its value on the real axis. There it is
sampled at heights in geometric progression and fitted by the algorithm AAA (Nakatsukasa, Sete and
Trefethen, SIAM J. Sci. Comput. 40 (2018) A1494). The inverse is then a sum of exponentials over the
poles, for all times. If the fit is good to epsilon on the line Re z = s, the inverse at t is good
to exp(s t) epsilon, up to a logarithm.

F is the sum of parts, one for each exit, which are fitted without factors exp(-z t_0): exponentials
have no good rational approximation. Many paths may arrive together at t_0, long after the first
ones. The poles to the left of the line are those of later times, those to the right of it of
earlier ones.
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
    """A function of time: for each part sum_k c_k exp(p_k (t - t_0)), of other terms before t_0.

    Attributes
    ----------
    delays : numpy.ndarray, shape (m,)
        Up to which each part is 0.
    centres : numpy.ndarray, shape (m,)
        t_0 of each part.
    before, after : list of (numpy.ndarray, numpy.ndarray)
        p_k and log c_k of each part; the c_k themselves may be too large for a number.
    misfit : float
        Largest error of the fits at the samples, and at zeros far above, relative to the size of F;
        and what a fit to all samples but the last ones was wrong by at these.
    """

    delays: np.ndarray
    centres: np.ndarray
    before: list
    after: list
    misfit: float = 0.0

    def at(self, times: np.ndarray) -> np.ndarray:
        """Evaluate the function at times, shape (k,)."""
        total = np.zeros(len(times))
        for delay, centre, *sides in zip(
            self.delays, self.centres, self.before, self.after, strict=True
        ):
            late = times > centre
            for here, (exponents, logarithms) in zip(
                (~late & (times > delay), late), sides, strict=True
            ):
                since = times[here] - centre
                total[here] += np.exp(np.outer(since, exponents) + logarithms).sum(axis=1).real
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
        nothing = [(np.zeros(0), np.zeros(0))] * len(delays)
        return Exponentials(delays, delays, nothing, nothing)

    def scaled(height):
        z = complex(abscissa, height)
        values = parts(z) / size
        return values * (abscissa / z) if rising else values

    with np.errstate(divide="ignore"):
        # above, the phase of the delay is rounded by more than the accuracy
        highest = accuracy / (tuning.VERTICAL_LINES.phase * np.max(delays))
    samples = _until_negligible(scaled, line, accuracy, offset, highest)
    centres = np.maximum(delays, _centres(scaled, samples, line, accuracy, delays))
    misfit = _add_where_wrong(scaled, samples, line, accuracy, centres)
    before, after = [], []
    for (z, values), centre in zip(_columns(samples, abscissa, centres), centres, strict=True):
        poles, residues, error = _residues(z, values, accuracy)
        misfit = max(misfit, error)
        scale = np.log(size) + abscissa * centre
        early, late = _in_time(poles, residues, abscissa, rising)
        before.append((early[0], early[1] + scale))
        after.append((late[0], late[1] + scale))
    return Exponentials(delays, centres, before, after, misfit)


def _in_time(poles, residues, abscissa, rising):
    """Exponents and logarithms of coefficients, to the right of the line and to the left of it."""
    unit = tuning.VERTICAL_LINES.unit * abscissa
    exponents, left = unit * poles, unit * poles.real < abscissa
    coefficients = unit * residues / (abscissa if rising else exponents)
    early = exponents[~left], -coefficients[~left]
    late = exponents[left], coefficients[left]
    if not rising:  # the pole of 1 / z, at which F is minus the sum of the others
        late = np.append(late[0], 0.0), np.append(late[1], -coefficients.sum())
    with np.errstate(divide="ignore"):  # of coefficients that are 0
        return [(places, np.log(sizes)) for places, sizes in (early, late)]


def _until_negligible(scaled, line, accuracy, offset, highest):
    """Sample upwards until F is negligible: values by their heights."""
    settings, abscissa = tuning.VERTICAL_LINES, line.abscissa
    # heights are on a lattice that transforms of different thresholds share
    place = np.floor(np.log(line.lowest) / np.log(settings.step)) + offset
    samples, rest = {0.0: scaled(0.0)}, settings.beyond
    while rest and (height := abscissa * settings.step**place) < highest:
        samples[height] = scaled(height)
        rest = rest - 1 if np.all(np.abs(samples[height]) < accuracy) else settings.beyond
        place += 1
    return samples


def _centres(scaled, samples, line, accuracy, delays):
    """When the paths arrive, on average, that F is made of where it is half way to negligible.

    That is the change of the phase of F by height, for each part; 0 of a part that is negligible.
    The phase of the delay is taken away before, so that what is left is less than a turn.
    """
    heights, values = np.array(list(samples)), np.abs(list(samples.values()))
    largest, change = np.max(values, axis=0), line.lowest * line.abscissa
    found = np.zeros(len(largest))
    for part in np.flatnonzero(largest > accuracy):
        half_way = np.sqrt(accuracy * largest[part])
        height = heights[np.flatnonzero(values[:, part] >= half_way)[-1]]
        samples[height + change] = scaled(height + change)
        turned = samples[height + change][part] / samples[height][part]
        early = delays[part]
        found[part] = early - np.angle(turned * np.exp(1j * change * early)) / change
    return found


def _add_where_wrong(scaled, samples, line, accuracy, centres):
    """Add samples between others where fits to the samples so far are wrong.

    Returns what the last of these fits was wrong by.
    """
    settings, abscissa = tuning.VERTICAL_LINES, line.abscissa
    unsure, worst, checked = list(pairwise(sorted(samples)[1:])), np.inf, 0.0
    unit = settings.unit * abscissa
    while unsure and len(samples) < settings.most:
        columns = _columns(samples, abscissa, centres)
        fits = [_fit(*part, accuracy, settings.shares[0]) for part in columns]
        wrong, errors = [], []
        for low, high in unsure:
            middle = np.sqrt(low * high)
            samples[middle] = scaled(middle)
            found = [fit(complex(abscissa, middle) / unit) if fit else 0.0 for fit in fits]
            there = samples[middle] * np.exp(1j * middle * centres)
            errors.append(np.max(np.abs(found - there)))
            if errors[-1] > accuracy and high > settings.closest * low:
                wrong += [(low, middle), (middle, high)]
        last, worst = worst, np.nan_to_num(np.max(errors), nan=np.inf)
        checked = worst
        if settings.falls * last < worst < settings.rounded:  # no sample mends that F is rounded
            break
        unsure = wrong
    return checked


def _columns(samples, abscissa, centres):
    """Places on the line, in units that suit the fits, and values without delay, for each part."""
    heights, values = np.array(list(samples)), np.array(list(samples.values()))
    z = (abscissa + 1j * heights) / (tuning.VERTICAL_LINES.unit * abscissa)
    return [(z, part) for part in (values * np.exp(1j * np.outer(heights, centres))).T]


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
    """Poles off the line, residues at them, and the largest error of the fit.

    The residues are fitted once more, to these poles alone: those of the rational function of a
    high degree are not accurate far from the line. Where F is as good as rounded, a less close fit
    may be the better.
    """
    line, settings = z[0].real, tuning.VERTICAL_LINES
    found, least = (np.zeros(0, complex), np.zeros(0, complex)), float(np.max(np.abs(values)))
    for share in settings.shares:
        if least <= accuracy:
            break
        poles = _fit(z, values, accuracy, share).poles()
        poles = poles[poles.real != line]
        places, wanted = _mirrored(z, values)
        distances = np.abs(line - poles.real)
        columns = distances / (places[:, None] - poles)
        strengths = np.linalg.lstsq(columns, wanted, rcond=settings.rounding)[0]
        error = np.max(np.abs(columns @ strengths - wanted))
        if error < least:
            found, least = (poles, distances * strengths), error
    return *found, least
