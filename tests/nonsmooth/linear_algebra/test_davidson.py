"""Slow rates of operators whose eigenvalues are known."""

import numpy as np
import pytest

from nonsmooth.linear_algebra.davidson import slow_rates

RATES = np.concatenate([[0.5, 0.8], np.linspace(2.0, 1000.0, 400)])


def operator(seed, coupling=0.3):
    """Make a matrix with the eigenvalues 0.4 +- 2i and RATES, not normal, and its inverse."""
    rng = np.random.default_rng(seed)
    size = len(RATES) + 2
    triangle = np.diag(np.concatenate([[0.4, 0.4], RATES]))
    triangle[0, 1], triangle[1, 0] = 2.0, -2.0
    above = np.triu(rng.normal(size=(size, size)), 2) * coupling
    basis = np.linalg.qr(rng.normal(size=(size, size)))[0]
    matrix = basis @ (triangle + above) @ basis.T
    return matrix, np.linalg.inv(matrix)


def found(matrix, rough, accuracy, room=80, most=600, **given):
    """Compute the slow rates of a matrix with a rough inverse."""
    return slow_rates(
        lambda vector: matrix @ vector,
        lambda vector: rough @ vector,
        np.cos(np.arange(len(matrix))),
        4,
        accuracy,
        known=3e-2,
        room=room,
        most=most,
        **given,
    )


@pytest.mark.parametrize("room", [20, 80])
@pytest.mark.parametrize("accuracy", [1e-4, 1e-9])
def test_slowest_rate(accuracy, room):
    """The slowest rate is as accurate as it is to be, with restarts or without."""
    matrix, inverse = operator(1)
    rng = np.random.default_rng(2)
    # wrong by a fifth, so that an inverse iteration alone would stop before the first digit
    rough = inverse + inverse @ rng.normal(size=inverse.shape) * 0.1 / np.sqrt(len(inverse))
    rates = found(matrix, rough, accuracy, room)
    values = np.linalg.eigvals(matrix)
    slowest = np.argmin(values.real)
    assert abs(rates[0].real - 0.4) <= accuracy * abs(values[slowest])
    assert np.all(np.diff(rates.real) >= 0)


@pytest.mark.parametrize("seed", range(5))
def test_a_sensitive_rate_is_as_accurate_as_others(seed):
    """The residual falls until it is small in comparison with the eigenvalue's condition."""
    rng = np.random.default_rng(seed)
    triangle = np.diag(np.concatenate([[0.5, 0.7, 0.9, 1.1], np.linspace(2.0, 1000.0, 300)]))
    triangle += np.triu(rng.normal(size=triangle.shape), 1) * 0.3
    triangle[:4, :4] += np.triu(np.full((4, 4), 2.0), 1)
    basis = np.linalg.qr(rng.normal(size=triangle.shape))[0]
    matrix = basis @ triangle @ basis.T
    values, left, right = _modes(matrix)
    slowest = np.argmin(values.real)
    assert abs(left[:, slowest].conj() @ right[:, slowest]) < 0.02
    inverse = np.linalg.inv(matrix)
    rough = inverse + inverse @ rng.normal(size=inverse.shape) * 0.1 / np.sqrt(len(inverse))
    assert abs(found(matrix, rough, 1e-4)[0] - 0.5) <= 1e-4 * 0.5


def _modes(matrix):
    """Return the eigenvalues, and left and right eigenvectors of length 1."""
    values, right = np.linalg.eig(matrix)
    left = np.linalg.inv(right).conj().T
    return values, left / np.linalg.norm(left, axis=0), right


def test_complex_pairs_stay_together():
    """Whether the pair is the last of those wanted or not, both of it are returned."""
    matrix, inverse = operator(3)
    rates = found(matrix, inverse, 1e-10)
    assert rates.imag.sum() == pytest.approx(0, abs=1e-10)
    assert np.sort(rates.real)[:4] == pytest.approx([0.4, 0.4, 0.5, 0.8], rel=3e-2)


def test_a_useless_preconditioner_is_noticed():
    """The method ends after the number of vectors that it may try, or if they are all the same."""
    matrix, inverse = operator(4)
    turned = np.linalg.qr(np.random.default_rng(5).normal(size=inverse.shape))[0]
    for useless in (np.eye(len(inverse)), turned):
        with pytest.raises(np.linalg.LinAlgError, match="among 40 vectors"):
            found(matrix, useless, 1e-9, most=40)


def test_rates_that_are_not_slow_enough_need_not_be_accurate():
    """The residual is that of the other modes then; otherwise nothing changes."""
    matrix, inverse = operator(3)
    rough = inverse + 0.3 * np.diag(np.diag(inverse))
    usual = found(matrix, rough, 1e-9)
    assert np.array_equal(found(matrix, rough, 1e-9, slower=1.0), usual)
    quick = found(matrix, rough, 1e-9, slower=0.1)
    assert 1e-7 < abs(quick[0] - usual[0]) < 0.1
