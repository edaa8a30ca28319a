"""The combination technique on functionals whose convergence is known."""

import pytest

from nonsmooth.grids.combination_technique import Combination


def product(*rates):
    """Prod_k (1 + rate_k^level_k), which converges to 1."""

    def functional(index):
        value = 1.0
        for rate, level in zip(rates, index, strict=True):
            value *= 1 + rate**level
        return value

    return functional


@pytest.mark.parametrize(
    "rates",
    [
        (0.3,),
        (0.4, 0.1),
        (0.3, -0.45, 0.1),
        (0.05, 0.5, 0.2, -0.3),
        (0.8,),
        (-0.9,),
        (0.8, 0.1),
        (0.7, 0.6),
    ],
)
def test_the_error_bounds_the_limit(rates):
    """The limit is within the error, from the first step on if surpluses at least halve."""
    functional = product(*rates)
    lowest = (1,) * len(rates)
    combination = Combination(lowest, functional(lowest), functional, lambda i: 2.0 ** sum(i))
    slow = max(abs(rate) for rate in rates) > 0.5
    while combination.error > 1e-3:
        assert combination.refine(float("inf"))
        # two surpluses of each variable tell how slowly they shrink
        if not slow or min(combination.dearest()[0]) > 2:
            assert abs(combination.value - 1) <= combination.error * (1 + 1e-9)
    assert combination.error > 0


@pytest.mark.parametrize("rates", [(0.7,), (0.74, 0.3)])
def test_the_first_surplus_may_count_more(rates):
    """Three times it bounds what follows if surpluses shrink to three quarters."""
    functional = product(*rates)
    lowest = (1,) * len(rates)
    combination = Combination(
        lowest, functional(lowest), functional, lambda i: 2.0 ** sum(i), alone=3.0
    )
    assert combination.error == float("inf")
    for _ in rates:
        combination.refine(float("inf"))
    assert abs(combination.value - 1) <= combination.error < float("inf")


def test_levels_are_raised_where_they_matter():
    """A variable that converges at once is raised no further than to see that."""
    functional = product(0.5, 1e-6)
    combination = Combination((1, 1), functional((1, 1)), functional, lambda i: 2.0 ** sum(i))
    while combination.error > 1e-4:
        combination.refine(float("inf"))
    (fine, coarse), there = combination.dearest()
    assert fine > 8
    assert coarse <= 2
    assert there == functional((fine, coarse))


def test_what_costs_too_much_is_left_out():
    """The error stays infinite, or that of the grids within the cost."""
    functional = product(0.5, 0.5)
    combination = Combination((1, 1), functional((1, 1)), functional, lambda i: 2.0 ** sum(i))
    assert combination.refine(7.0) == 0
    while combination.refine(16.0):
        pass
    assert 0 < abs(combination.value - 1) <= combination.error < float("inf")
