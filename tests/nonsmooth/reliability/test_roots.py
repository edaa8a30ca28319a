"""Roots of a probability that is known with errors: limits that hold."""

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.reliability import tuning
from nonsmooth.reliability.roots import (
    FALLING,
    RISING,
    Values,
    root_on_grid,
    searched,
    solved_roots,
)

REFERENCE = {
    RISING: lambda x: float(ns.brownian_crossing(1.0, x)),
    FALLING: lambda x: float(ns.brownian_crossing(x, 1.0)),
}


def straight(x):
    """Brownian motion itself."""
    return x


def warped(x):
    """Slopes of 1.2 to 2.8 in logarithms, as when int g spreads faster at early times."""
    return x**2 * np.exp(0.8 * np.sin(np.log(x)))


def brownian(error, wrong, sense, warp=straight):
    """W_star in b or in T, off by `wrong` times a stated error."""

    def evaluate(x):
        W = np.array([REFERENCE[sense](one) for one in warp(np.asarray(x))])
        shown = np.clip(W + wrong * error, 0, 1)
        limits = np.clip(shown - error, 0, 1), np.clip(shown + error, 0, 1)
        return Values(shown, np.full(len(x), error), *limits)

    return evaluate


def solved_root(evaluate, reference, target, guess, sense):
    """Find a single root."""
    search = searched(reference, target, guess, sense)
    return solved_roots([search], lambda wanted: {k: evaluate(x) for k, x in wanted.items()})[0]


def inside(root, target, sense, warp=straight):
    """Whether W_star takes the value between the limits: it is monotone."""
    exact = brownian(0.0, 0.0, sense, warp)
    ends = exact(np.array([root.lower, root.upper])).probability
    return sense * ends[0] <= sense * target <= sense * ends[1]


@pytest.mark.parametrize("warp", [straight, pytest.param(warped, marks=pytest.mark.slow)])
@pytest.mark.parametrize("sense", [RISING, FALLING])
@pytest.mark.parametrize("wrong", [-1.0, 0.0, 0.9])
@pytest.mark.parametrize("target", [1e-6, 0.02, 0.5, 0.97])
def test_limits_hold_the_root_if_those_of_W_hold(target, wrong, sense, warp):
    """Errors from rounding to a third of P, from guesses that are off by a factor of 20."""
    for relative in (1e-9, 1e-4, 0.3):
        error = relative * min(target, 1 - target)
        for guess in (0.05, 1.0, 20.0):
            shown = brownian(error, wrong, sense, warp)
            root = solved_root(shown, REFERENCE[sense], target, (guess, 1.0), sense)
            assert 0 < root.lower <= root.value <= root.upper < np.inf
            assert inside(root, target, sense, warp)
            # not much wider than twice the error of W, in terms of W
            ends = brownian(0.0, 0.0, sense, warp)(np.array([root.lower, root.upper])).probability
            assert abs(ends[1] - ends[0]) < 9 * error + 1e-10


@pytest.mark.parametrize("spread", [1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("wrong", [-1.0, 0.9])
@pytest.mark.parametrize("guessed", [1.0, 10.0])
def test_limits_hold_where_W_rises_within_a_spread(spread, wrong, guessed):
    """Int g is normal about 6 (1 - exp(-T)) - T, as when friction slows a fast start down."""
    rng = np.random.default_rng(11)

    def law(x, level):
        mean = 6 * (1 - np.exp(-x)) - x
        return stats.norm.cdf((mean - level) / spread)

    for target in (1e-6, 1e-3, 0.02, 0.3, 0.5, 0.9, 0.98, 0.999):
        level = rng.uniform(0.05, 2.0)  # int g reaches 3.2 at the latest, at T = 1.79
        error = 10 ** rng.uniform(-10, -2) * min(target, 1 - target)

        def shown(x, level=level, error=error):
            W = np.clip(law(np.asarray(x), level) + wrong * error, 0, 1)
            return Values(W, np.full(len(x), error), W - error, W + error)

        guess = rng.uniform(0.5, 2) * level / 5, guessed
        root = solved_root(shown, REFERENCE[RISING], target, guess, RISING)
        ends = law(np.array([root.lower, root.upper]), level)
        assert ends[0] <= target <= ends[1]


@pytest.mark.parametrize("spread", [1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("wrong", [-1.0, 0.9])
@pytest.mark.parametrize("guessed", [1.0, 10.0])
def test_limits_hold_where_W_falls_within_a_spread(spread, wrong, guessed):
    """Int g is normal about a mean way, and thresholds are asked for."""
    rng = np.random.default_rng(12)
    for target in (1e-6, 1e-3, 0.02, 0.3, 0.5, 0.9, 0.98, 0.999):
        mean = rng.uniform(0.5, 2.0)
        error = 10 ** rng.uniform(-10, -2) * min(target, 1 - target)

        def shown(x, mean=mean, error=error):
            W = np.clip(stats.norm.cdf((mean - np.asarray(x)) / spread) + wrong * error, 0, 1)
            return Values(W, np.full(len(x), error), W - error, W + error)

        guess = rng.uniform(0.5, 2) * mean, guessed
        root = solved_root(shown, REFERENCE[FALLING], target, guess, FALLING)
        ends = stats.norm.cdf((mean - np.array([root.lower, root.upper])) / spread)
        assert ends[1] <= target <= ends[0]


@pytest.mark.parametrize("sense", [RISING, FALLING])
@pytest.mark.parametrize("relative", [1e-6, 1e-3])
@pytest.mark.parametrize(("warp", "most"), [(straight, 2), (warped, 4)])
def test_few_values_suffice(warp, most, relative, sense):
    """From a guess that is off by a few per cent, as from some thousand paths."""
    rng = np.random.default_rng(5)
    for target in (1e-6, 0.1, 0.5, 0.97):
        start = brownian(1e-13, 0.0, sense, warp), REFERENCE[sense], target, (1.0, 1.0), sense
        exact = solved_root(*start)
        asked = []

        def counted(x, target=target, asked=asked):
            asked.extend(x)
            return brownian(relative * min(target, 1 - target), 1.0, sense, warp)(x)

        guess = exact.value * np.exp(rng.uniform(-0.03, 0.03))
        root = solved_root(counted, REFERENCE[sense], target, (guess, 1.0), sense)
        assert len(asked) <= most
        assert inside(root, target, sense, warp)


@pytest.mark.parametrize("warp", [straight, warped])
@pytest.mark.parametrize("wrong", [-1.0, 0.9])
@pytest.mark.parametrize(("tol", "most"), [(0.0, 2), (0.05, 1)])
def test_places_beside_the_guess_save_calls(tol, most, wrong, warp):
    """They tell the slope at once, which is enough where W may be off by a part of P."""
    rng, relative = np.random.default_rng(7), 3e-3
    for target in (1e-6, 0.1, 0.5, 0.97):
        part = min(target, 1 - target)
        shown, reference = brownian(relative * part, wrong, RISING, warp), REFERENCE[RISING]
        start = brownian(1e-13, 0.0, RISING, warp), reference, target, (1.0, 1.0), RISING
        guess = solved_root(*start).value * np.exp(rng.uniform(-0.06, 0.06))
        calls = []

        def evaluate(wanted, calls=calls, shown=shown):
            calls.append(wanted)
            return {k: shown(x) for k, x in wanted.items()}

        search = searched(reference, target, (guess, 1.0), RISING, tol * part, tuning.SEARCH.beside)
        (root,) = solved_roots([search], evaluate)
        assert len(calls) <= most
        assert inside(root, target, RISING, warp)


@pytest.mark.parametrize("sense", [RISING, FALLING])
def test_roots_together_are_those_alone(sense):
    """With W at all x in one call, and as many calls as the one that takes most."""
    targets, shown, calls = (1e-6, 0.1, 0.5, 0.97), brownian(1e-9, 0.5, sense, warped), []

    def search(target):
        return searched(REFERENCE[sense], target, (1.0, 1.0), sense)

    def evaluate(wanted):
        calls.append(len(wanted))
        return {k: shown(x) for k, x in wanted.items()}

    alone = [solved_roots([search(target)], evaluate)[0] for target in targets]
    most, calls[:] = len(calls), []
    together = solved_roots([search(target) for target in targets], evaluate)
    assert together == alone
    assert calls[0] == len(targets)
    assert 2 * len(calls) < most


@pytest.mark.parametrize("sense", [RISING, FALLING])
def test_a_guess_that_is_the_root(sense):
    """Without any error, at the first value: there is nothing to look for."""
    target = REFERENCE[sense](1.0)
    root = solved_root(brownian(0.0, 0.0, sense), REFERENCE[sense], target, (1.0, 1.0), sense)
    assert root.value == pytest.approx(1.0, rel=1e-11)
    assert root.error < 1e-10


@pytest.mark.parametrize("sense", [RISING, FALLING])
def test_a_limit_stays_open_where_the_error_leaves_it_open(sense):
    """An error of 0.3 around P = 0.1: W may be as small as it likes."""
    root = solved_root(brownian(0.3, 0.0, sense), REFERENCE[sense], 0.1, (1.0, 1.0), sense)
    assert (root.lower == 0) if sense == RISING else np.isinf(root.upper)
    assert np.isfinite(root.upper) if sense == RISING else root.lower > 0


@pytest.mark.parametrize("sense", [RISING, FALLING])
def test_limits_on_a_grid(sense):
    """Noise of W is within its limits: the root is between points of the grid."""
    rng, x = np.random.default_rng(3), np.geomspace(0.1, 3, 41)
    exact = brownian(0.0, 0.0, sense)(x).probability
    for _ in range(100):
        target, error = rng.uniform(0.1, 0.5), 10 ** rng.uniform(-4, -1.5)
        shown = exact + error * rng.uniform(-1, 1, len(x))
        values = Values(shown, np.full(len(x), error), shown - error, shown + error)
        root = root_on_grid(x, values, target, sense)
        assert inside(root, target, sense)
        assert root.upper / root.lower < 3


@pytest.mark.parametrize("sense", [RISING, FALLING])
def test_a_jump_is_within_the_error_on_a_grid(sense):
    """W jumps from 0.02 to 0.3 between two points: what is asked in between is where it jumps."""
    x, jump = np.geomspace(0.1, 3, 41), 0.7
    W = np.where(sense * (x - jump) > 0, 0.3, 0.02) + 1e-3 * sense * np.log(x)
    values = Values(W, np.full(len(x), 1e-4), W - 1e-4, W + 1e-4)
    for target in (0.05, 0.15, 0.28):
        root = root_on_grid(x, values, target, sense)
        assert abs(root.value - jump) <= root.error
        assert root.lower <= jump <= root.upper
