"""The kinetic equation of one state variable in a basis, on a vertical line."""

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.kinetic.bases.reduced_line import on_line
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.ordinates_line import ordinates
from references import SKEWED

QUADRATIC = ns.Scene("friction", ns.White(1.2), damping=0.7, observable="y**2 - 0.2")


def heights(abscissa, highest):
    """Heights between those that are checked."""
    found = abscissa * 2.0 ** np.arange(-5, 30, 2)
    return found[found < highest]


def exact(grid, *intervals):
    """Parts of the transforms on the grid itself."""
    return lambda z: np.array([modes(grid, z).by_exit(*interval) for interval in intervals])


@pytest.mark.parametrize(
    ("scene", "levels"),
    [
        (SKEWED, (-0.6, 0.8)),
        (QUADRATIC, (-2.0, 2.5)),
        (ns.Scene("friction", n=math.inf, observable="y + 0.3*abs(y)"), (-1.0, 0.2)),
        (ns.Scene("friction", observable="y + 0.3*cos(y)", start={"y": 1.0}), (-1.0, 1.5)),
    ],
    ids=["skewed", "quadratic", "limit", "start"],
)
@pytest.mark.parametrize(("abscissa", "accuracy"), [(0.02, 1e-8), (0.1, 1e-6)])
def test_transforms_are_those_of_the_grid(scene, levels, abscissa, accuracy):
    """Between the heights that were checked, too, relative to the value on the axis."""
    grid = ordinates(scene, 9, 0.05, distances=(-levels[0], levels[1]))
    whole = exact(grid, levels)
    reduced, highest, inexact = on_line(grid, [levels], whole, abscissa, accuracy)
    assert len(reduced.ones) <= 0.75 * len(grid.moving)
    size = abs(whole(complex(abscissa)).sum())
    off = [
        np.max(np.abs(modes(reduced, z).by_exit(*levels) - whole(z)[0]))
        for z in abscissa + 1j * heights(abscissa, highest)
    ]
    # one height need not be good enough, and the next is that where transforms are negligible
    assert np.all(np.abs(whole(complex(abscissa, 16 * highest))) <= accuracy * size)
    assert 0 < inexact < accuracy
    assert max(off) <= 3 * inexact * size  # as much as its inverse is taken to have


def test_several_intervals_share_a_basis():
    """Each has the accuracy of its own size."""
    grid = ordinates(SKEWED, 9, 0.05, distances=(0.3, 0.4))
    intervals = [(-0.3, 0.4), (-0.9, 1.2)]
    whole = exact(grid, *intervals)
    reduced, highest, _ = on_line(grid, intervals, whole, 0.05, 1e-8)
    for z in 0.05 + 1j * heights(0.05, highest):
        for interval, values in zip(intervals, whole(z), strict=True):
            size = modes(grid, 0.05).by_exit(*interval).real.sum()
            found = modes(reduced, z).by_exit(*interval)
            assert np.max(np.abs(found - values)) <= 1e-8 * size


@pytest.mark.parametrize(
    ("degree", "time", "abscissa", "accuracy"), [(4, 1.0, 0.02, 1e-15), (9, 1e-4, 1e-8, 1e-8)]
)
def test_none_where_no_basis_is_good_enough(degree, time, abscissa, accuracy):
    """Beyond rounding it would take all functions; so near to z = 0 walls have the same modes."""
    grid = ordinates(SKEWED, degree, time)
    assert on_line(grid, [(-0.6, 0.8)], exact(grid, (-0.6, 0.8)), abscissa, accuracy) is None


def test_constants_are_in_the_basis():
    """At z = 0 all paths leave: what is lost is only the rate z.

    Without constants it would be some of the accuracy, 1e-7; here it has the size of z times the
    mean duration, so far from the line not its digits.
    """
    grid = ordinates(QUADRATIC, 7, 0.1)
    reduced, *_ = on_line(grid, [(-1.0, 1.0)], exact(grid, (-1.0, 1.0)), 0.1, 1e-6)
    z = 1e-9
    lost = 1 - modes(reduced, z).by_exit(-1.0, 1.0).real.sum()
    duration = 1 - modes(grid, z).by_exit(-1.0, 1.0).real.sum()
    assert 0 < lost < 2 * duration < 3e-8
