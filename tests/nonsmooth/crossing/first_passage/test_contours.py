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
    """exp(-sqrt z) and poles with their mirror images, and how often it was evaluated."""

    def __init__(self, poles=()):
        self.poles, self.evaluated = poles, 0

    def __call__(self, z):
        """Evaluate it once more."""
        self.evaluated += 1
        beside = sum(1 / (z - pole) + 1 / (z - np.conj(pole)) for pole in self.poles)
        return np.exp(-np.sqrt(z)) + 0.05 * beside


INTERVALS = (1.0, 4.0), (4.5, 90.0)
NEGLIGIBLE = 1e-9  # of a term; those that are left out fall geometrically


def laid():
    """Hyperbolas of neighbouring intervals, that invert F / z to 1e-9, and their times."""
    return [
        (hyperbola(first, last, 24, 0.3).over_z(), np.geomspace(first, last, 9))
        for first, last in INTERVALS
    ]


def alone(contours):
    """How often a transform is evaluated for each contour alone."""
    transform = Counted()
    for contour in contours:
        inverted(transform, *contour, NEGLIGIBLE)
    return transform.evaluated


def test_fits_along_contours_change_less_than_was_asked():
    """A looser accuracy takes fewer values, and any takes fewer than each contour alone."""
    contours, taken = laid(), []
    for accuracy in (1e-3, 1e-5, 1e-7):
        transform = Counted()
        found = inverted_together(transform, contours, NEGLIGIBLE, accuracy)
        for (_, times), values in zip(contours, found, strict=True):
            assert np.max(np.abs(values - erfc(0.5 / np.sqrt(times)))) < accuracy + 10 * NEGLIGIBLE
        taken.append(transform.evaluated)
    assert taken[0] < taken[1] < taken[2] < alone(contours)
    assert taken[0] < alone(contours) / 2


def test_where_no_change_is_allowed_all_nodes_are_evaluated():
    """Those that a contour alone takes, and up to three more."""
    transform, contours = Counted(), laid()
    found = inverted_together(transform, contours, NEGLIGIBLE, 0.0)
    for (_, times), values in zip(contours, found, strict=True):
        assert np.max(np.abs(values - erfc(0.5 / np.sqrt(times)))) < 10 * NEGLIGIBLE
    assert 0 <= transform.evaluated - alone(contours) <= 3 * len(contours)


@pytest.mark.parametrize("count", range(1, 13))
def test_short_contours_are_summed(count):
    """A place at which none of them has a node settles nothing."""
    ((contour, times), *_) = laid()
    contour = contour.until(count)
    (found,) = inverted_together(Counted(), [(contour, times)], 0.0, 1e-9)
    exact = contour.invert(np.exp(-np.sqrt(contour.nodes)), times)
    # the sum of the terms, each rounded
    size = np.sum(np.abs(contour.weights)) * np.exp(contour.nodes[0].real * times[-1])
    assert np.max(np.abs(found - exact)) < 1e-9 + 1e-14 * size


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("places", [(2, 6, 9), (1,), (2,), (5,), (10,)], ids=str)
def test_poles_between_the_first_nodes_are_seen(places, accuracy, which):
    """Each is beside a node that the first fit leaves out, as far from it as the next node.

    At all times the inverse is as accurate as was asked.
    """
    contours = laid()[which : which + 1]
    nodes = contours[0][0].nodes
    poles = [nodes[k] - abs(nodes[k + 1] - nodes[k]) for k in places]
    transform = Counted(poles)
    (found,) = inverted_together(transform, contours, NEGLIGIBLE, accuracy)
    (every,) = inverted_together(Counted(poles), contours, NEGLIGIBLE, 0.0)
    assert np.max(np.abs(found - every)) < accuracy
    if len(places) > 1:
        smooth = Counted()
        inverted_together(smooth, contours, NEGLIGIBLE, accuracy)
        assert transform.evaluated > smooth.evaluated


def test_what_is_not_finite_stays():
    """As in a sum over all nodes, for whoever asks to find."""
    found = inverted_together(lambda z: complex(np.nan, 0), laid(), NEGLIGIBLE, 1e-3)
    assert all(np.isnan(values).all() for values in found)
