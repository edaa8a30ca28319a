"""The inverse Laplace transform by rational fits on vertical lines."""

import numpy as np
import pytest
from scipy.special import erfc, ndtr

from nonsmooth.crossing.first_passage.tuning import VERTICAL_LINES
from nonsmooth.crossing.first_passage.vertical_lines import inverted, line


def fitted(parts, abscissa, *rest):
    """Invert on the line through a place on the axis."""
    return inverted(parts, line(parts, abscissa), *rest)


def bound(accuracy, abscissa, highest, last):
    """exp(s t) epsilon / pi, times the integral of |dz / z| along the line up to some height."""
    length = 1 + np.log(highest / abscissa)
    return accuracy * np.exp(abscissa * last) * length / np.pi


@pytest.mark.parametrize("offset", [0.0, 0.5])
def test_one_fit_serves_many_times(offset):
    """exp(-sqrt z) is the transform of erfc(1/(2 sqrt t)); its error is that of the fit."""
    times, accuracy = np.geomspace(0.1, 100.0, 40), 1e-8
    found = fitted(
        lambda z: np.array([np.exp(-np.sqrt(z))]), 0.01, np.zeros(1), accuracy, False, offset
    ).at(times)
    # |F| is below the accuracy at sqrt(z / 2) = 18.4
    assert np.max(np.abs(found - erfc(0.5 / np.sqrt(times)))) < bound(accuracy, 0.01, 680, 100)


@pytest.mark.parametrize("scale", [1e-20, 1e20])
def test_units_of_time_do_not_matter(scale):
    """Poles are found where all of them are huge or tiny."""
    times, accuracy = scale * np.geomspace(0.1, 100.0, 40), 1e-8
    found = fitted(
        lambda z: np.array([np.exp(-np.sqrt(scale * z))]),
        0.01 / scale,
        np.zeros(1),
        accuracy,
        False,
        0.0,
    ).at(times)
    error = np.max(np.abs(found - erfc(0.5 / np.sqrt(times / scale))))
    assert error < bound(accuracy, 0.01, 680, 100)


def test_small_values_keep_relative_accuracy():
    """The same through the saddle point near 1/(4 t^2), where erfc(5) = 1.5e-12.

    The bound of the probability is 30 times as large, and the error relative to it.
    """
    found = fitted(
        lambda z: np.array([np.exp(-np.sqrt(z))]), 2500.0, np.zeros(1), 1e-9, True, 0.0
    ).at(np.array([0.01]))
    assert found[0] == pytest.approx(erfc(5.0), rel=30 * bound(1e-9, 1.0, 10.0, 0.0))


def test_delays_are_exact():
    """Two parts begin at 1 and at 30, which no rational function of few poles could tell."""
    times, accuracy, delays = np.array([0.5, 1.001, 5.0, 29.9, 30.01, 40.0]), 1e-8, (1.0, 30.0)

    def parts(z):
        return np.array([np.exp(-z * delay) / (2 + 2 * z) for delay in delays])

    found = fitted(parts, 1 / 40, np.array(delays), accuracy, False, 0.0).at(times)
    exact = sum(np.where(times > t, 1 - np.exp(np.minimum(t - times, 0)), 0) / 2 for t in delays)
    assert np.max(np.abs(found - exact)) < 2 * bound(accuracy, 1 / 40, 1e8, 40.0)


def test_many_may_arrive_long_after_the_first():
    """A tenth arrives smoothly from 0 on, the others at 1 with a standard deviation of 0.02.

    The transform of the others turns 37 times before it is negligible, at |z| = 230.
    """
    times, accuracy, spread, asked = np.linspace(0.05, 3.0, 60), 1e-5, 0.02, []

    def parts(z):
        asked.append(z)
        together = np.exp(-z + (spread * z) ** 2 / 2)
        return np.array([0.9 * together + 0.1 * np.exp(-np.sqrt(z))])

    found = fitted(parts, 1 / 3, np.zeros(1), accuracy, False, 0.0).at(times)
    exact = 0.9 * ndtr((times - 1) / spread) + 0.1 * erfc(0.5 / np.sqrt(times))
    assert np.max(np.abs(found - exact)) < bound(accuracy, 1 / 3, 230, 3.0)
    assert len(asked) < VERTICAL_LINES.most


def test_what_is_negligible_is_0():
    """A transform below the accuracy is 0."""
    found = fitted(lambda z: np.array([1.0 / (1 + z), 1e-12]), 0.1, np.zeros(2), 1e-9, False, 0.0)
    assert len(found.after[1][0]) <= 1
    assert not len(found.before[1][0])
    assert found.at(np.array([3.0]))[0] == pytest.approx(1 - np.exp(-3.0), abs=1e-8)
