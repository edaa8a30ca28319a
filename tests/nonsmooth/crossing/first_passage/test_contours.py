"""The inverse Laplace transform on hyperbolas (Weideman and Trefethen 2007)."""

import numpy as np
import pytest
from scipy.special import erfc

from nonsmooth.crossing.first_passage.contours import (
    hyperbola,
    inverted,
    inverted_together,
    through_saddle,
)


@pytest.mark.parametrize(("ratio", "count", "rate"), [(1.01, 10, 2.0), (10.0, 24, 0.9)])
def test_inverts_to_the_declared_rate(ratio, count, rate):
    """exp(-sqrt z)/z is the transform of erfc(1/(2 sqrt t)); error exp(-rate count)."""
    contour = hyperbola(1.0, ratio, count).until(count)
    times = np.linspace(1.0, ratio, 7)
    value = contour.invert(np.exp(-np.sqrt(contour.nodes)) / contour.nodes, times)
    assert np.max(np.abs(value - erfc(0.5 / np.sqrt(times)))) < np.exp(-rate * count)


def test_a_saddle_point_keeps_relative_accuracy():
    """The same transform at t = 0.01, where erfc(5) = 1.5e-12: to ten digits, as spacing 1 says.

    The exponent z t - sqrt z - log z is stationary near z = 1/(4 t^2).
    """
    time, place = 0.01, 2500.0
    width = place / np.sqrt(place**0.5 / 4)  # the second derivative of -sqrt z is z^(-3/2) / 4
    contour = through_saddle(place, width, 1.0, 0.4)
    value = inverted(lambda z: np.exp(-np.sqrt(z)) / z, contour, np.array([time]), 1e-14)[0]
    assert value == pytest.approx(erfc(0.5 / np.sqrt(time)), rel=1e-9)


class Counted:
    """exp(-sqrt z), and how often it was evaluated; poles may be added."""

    def __init__(self, poles=()):
        self.poles, self.evaluated = poles, 0

    def __call__(self, z):
        """Evaluate it once more."""
        self.evaluated += 1
        return np.exp(-np.sqrt(z)) + sum(self.term(z, pole) for pole in self.poles)

    @staticmethod
    def term(z, pole):
        """Real on the real axis; 0.1 / z is added if the pole is 0."""
        return 0.05 / (z - pole) + 0.05 / (z - np.conj(pole))

    def inverse(self, times):
        """Return the inverse of it over z."""
        found = erfc(0.5 / np.sqrt(times))
        for pole in self.poles:
            found += 0.1 * np.real((np.exp(pole * times) - 1) / pole)
        return found


INTERVALS = (1.0, 4.0), (4.5, 90.0)
NEGLIGIBLE = 1e-9  # of a term; those that are left out fall geometrically


def laid():
    """Hyperbolas of neighbouring intervals, that invert F / z to 1e-9, and their times."""
    return [
        (hyperbola(first, last, 24, 0.3).over_z(), np.geomspace(first, last, 9), NEGLIGIBLE)
        for first, last in INTERVALS
    ]


def alone(contours):
    """How often a transform is evaluated for each contour alone."""
    transform = Counted()
    for contour in contours:
        inverted(transform, *contour)
    return transform.evaluated


def test_fits_along_contours_change_less_than_was_asked():
    """Fewer values are computed for less, and always less than each contour takes alone."""
    contours, taken = laid(), []
    for accuracy in (1e-3, 1e-5, 1e-7):
        transform = Counted()
        found = inverted_together(transform, contours, accuracy)
        for (_, times, _), values in zip(contours, found, strict=True):
            assert np.max(np.abs(values - transform.inverse(times))) < accuracy + 10 * NEGLIGIBLE
        taken.append(transform.evaluated)
    assert taken[0] < taken[1] < taken[2] < alone(contours)
    assert taken[0] < alone(contours) / 2


def test_without_an_accuracy_no_value_is_fitted():
    """All nodes are evaluated, up to three more than on each contour alone."""
    transform, contours = Counted(), laid()
    found = inverted_together(transform, contours, 0.0)
    for (_, times, _), values in zip(contours, found, strict=True):
        assert np.max(np.abs(values - transform.inverse(times))) < 10 * NEGLIGIBLE
    assert 0 <= transform.evaluated - alone(contours) <= 3 * len(contours)


def test_poles_between_the_first_nodes_are_seen():
    """Each is as far from the contour as the nodes are from each other, where one is left out.

    A fit to every fourth node cannot know it: nodes are added until the fit does.
    """
    first, smooth = laid()[:1], Counted()
    nodes = first[0][0].nodes
    transform = Counted([nodes[k] - abs(nodes[k + 1] - nodes[k]) for k in (2, 6, 9)])
    found, every, _ = (
        inverted_together(of, first, accuracy)[0]
        for of, accuracy in ((transform, 1e-3), (Counted(transform.poles), 0.0), (smooth, 1e-3))
    )
    assert np.max(np.abs(found - every)) < 1e-3
    assert transform.evaluated > smooth.evaluated
