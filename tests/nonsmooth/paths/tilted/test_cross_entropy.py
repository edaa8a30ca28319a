"""The fit of a guide to paths that have reached a level."""

import numpy as np

from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.tilted import poisson
from nonsmooth.paths.tilted.cross_entropy import refitted
from nonsmooth.paths.tilted.tilt import Aim
from references import FRICTION, PLASTIC


def test_fit_makes_weights_even():
    """Over a short time the displacement itself is most of int y, far from the Brownian limit.

    The guide of that limit has single heavy weights. Four fits make the effective number of paths
    at least ten times as large.
    """
    aim = Aim(1, (-np.inf, 1.2), 2.0)
    guide = first = poisson.fitted(PLASTIC, 0.05, 1)
    numbers = []
    for k in range(4):
        sampling = Sampling(0.05, 2000, (2, k))
        guide, effective = refitted(PLASTIC, guide, first, aim, sampling)
        numbers.append(effective)
    assert numbers[-1] > 10 * numbers[0]


def test_nothing_is_learnt_if_no_path_arrives():
    """The guide stays what it is, and the effective number is 0."""
    aim = Aim(1, (-np.inf, 1e4), 1.0)
    first = poisson.fitted(FRICTION, 0.05, 1)
    guide, effective = refitted(FRICTION, first, first, aim, Sampling(0.05, 1000, 2))
    assert guide is first
    assert effective == 0
