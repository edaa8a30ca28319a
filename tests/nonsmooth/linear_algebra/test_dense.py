"""Dense linear algebra: what scipy finds, to rounding, while Ctrl-C is heard."""

import os
import signal
import sys
import threading
import time

import numpy as np
import pytest
import scipy.linalg

from nonsmooth.linear_algebra import dense

SIZE = 60
EPS = np.finfo(float).eps
RNG = np.random.default_rng(1)
MATRIX = RNG.standard_normal((SIZE, SIZE))
METRIC = MATRIX @ MATRIX.T + SIZE * np.eye(SIZE)
SYMMETRIC = MATRIX + MATRIX.T


def test_eigenvectors_are_orthonormal_and_solve_the_problem():
    """Residuals are rounding: a few eps, times the size and the norms of the matrices."""
    values, vectors = dense.eigh(SYMMETRIC, METRIC)
    condition = np.linalg.cond(METRIC)
    assert np.max(np.abs(vectors.T @ METRIC @ vectors - np.eye(SIZE))) < SIZE * EPS * condition
    residual = SYMMETRIC @ vectors - METRIC @ vectors * values
    assert np.max(np.abs(residual)) < SIZE * EPS * np.linalg.norm(SYMMETRIC, 2) * condition
    expected = scipy.linalg.eigh(SYMMETRIC, METRIC, eigvals_only=True)
    assert np.max(np.abs(values - expected)) < SIZE * EPS * np.max(np.abs(values)) * condition


def test_triangular_equations():
    """To the last bit, those of LAPACK's triangular solution."""
    factor = dense.cholesky(METRIC)
    for values in (MATRIX, MATRIX[0]):
        z = scipy.linalg.solve_triangular(factor, values, lower=True)
        assert np.array_equal(dense.forward(factor, values), z)
        z = scipy.linalg.solve_triangular(factor, values, lower=True, trans="T")
        assert np.array_equal(dense.backward(factor, values), z)


@pytest.mark.parametrize("size", [1e-8, 0.1, 1.0, 30.0])
def test_exponential(size):
    """As scipy's, up to rounding that squaring multiplies by the norm."""
    matrix = -size * METRIC / np.linalg.norm(METRIC, 1) + 0.1 * size * (MATRIX - MATRIX.T)
    norm = max(1.0, np.linalg.norm(matrix, 1))
    found, expected = dense.exponential(matrix), scipy.linalg.expm(matrix)
    assert np.max(np.abs(found - expected)) < 10 * EPS * norm * SIZE * np.max(np.abs(expected))


def test_what_is_not_finite_is_told():
    """By an error, or by what is not a number."""
    broken = np.full((3, 3), np.nan)
    with pytest.raises(np.linalg.LinAlgError):
        dense.eigh(broken, np.eye(3))
    assert np.all(np.isnan(dense.exponential(broken)))
    assert not np.any(np.isfinite(dense.exponential(np.full((3, 3), 1e40))))


LONG = {
    "eigh": lambda matrix: dense.eigh(matrix, matrix),
    "svd": dense.svd,
    "cholesky": lambda matrix: [dense.cholesky(matrix) for _ in range(20)],
    "inverse": lambda matrix: [dense.inverse(matrix) for _ in range(5)],
    "backward": lambda matrix: [dense.backward(matrix, matrix) for _ in range(10)],
    "exponential": dense.exponential,
}


def _then_wait(call, matrix):
    call(matrix)
    time.sleep(60)


@pytest.mark.parametrize("call", LONG.values(), ids=LONG.keys())
def test_ctrl_c_is_heard_within(call, monkeypatch):
    """KeyboardInterrupt comes long before the work would be done.

    The signal is sent after a tenth of a second; 0.9 seconds later it must have been heard,
    where the work takes longer than that. Time is that of the processor. Python ignores exceptions
    while it removes an object, and says so; the signal is sent once more then.
    """
    half = RNG.standard_normal((1500, 1500))
    matrix = half @ half.T + 1500 * np.eye(1500)
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    sent = []

    def press():
        time.sleep(0.1)
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    def ignored(error):
        assert error.exc_type is KeyboardInterrupt
        threading.Thread(target=press).start()

    monkeypatch.setattr(sys, "unraisablehook", ignored)
    presser = threading.Thread(target=press)
    presser.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            _then_wait(call, matrix)
        assert time.process_time() - sent[-1] < 0.9
    finally:
        signal.signal(signal.SIGINT, previous)
        presser.join()
