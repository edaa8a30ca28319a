"""Dense linear algebra during which Ctrl-C is heard.

Most of scipy's holds Python's lock until LAPACK is done, which takes a minute for some thousand
unknowns; numpy's releases it. Each function works in a thread for which the caller waits, see
`progress.interruptible`.
"""

from functools import partial

import numpy as np
import scipy.sparse.linalg
from scipy.linalg import lu_solve

from nonsmooth.progress import interruptible


def eigh(matrix: np.ndarray, metric: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve A v = nu M v with symmetric A and M, M positive definite.

    Parameters
    ----------
    matrix, metric : numpy.ndarray, shape (n, n)
        A and M.

    Returns
    -------
    values : numpy.ndarray, shape (n,)
        Increasing.
    vectors : numpy.ndarray, shape (n, n)
        In columns, orthonormal with respect to M.

    Raises
    ------
    numpy.linalg.LinAlgError
        If M is not positive definite, or entries are not finite.
    """

    def solve():
        _require_finite(matrix, metric)
        factor = np.linalg.cholesky(metric)
        reduced = forward(factor, forward(factor, matrix).T)
        values, vectors = np.linalg.eigh((reduced + reduced.T) / 2)
        return values, backward(factor, vectors)

    return interruptible(solve)


def svd(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the thin singular value decomposition."""
    return interruptible(partial(np.linalg.svd, matrix, full_matrices=False))


def cholesky(matrix: np.ndarray) -> np.ndarray:
    """Return the lower Cholesky factor of a symmetric matrix."""
    return interruptible(partial(np.linalg.cholesky, matrix))


def inverse(matrix: np.ndarray) -> np.ndarray:
    """Return the inverse."""
    return interruptible(partial(np.linalg.inv, matrix))


def forward(factor: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Solve L z = values with a lower triangular L."""
    return _triangular(factor, values, transposed=True)


def backward(factor: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Solve L^T z = values with a lower triangular L."""
    return _triangular(factor, values, transposed=False)


def _triangular(factor, values, transposed):
    # L^T as the upper factor of a matrix whose lower factor is 1: of scipy's triangular solutions
    # only this one releases the lock
    upper = np.asfortranarray(np.tril(factor).T)
    none = np.arange(len(factor))
    solve = partial(lu_solve, (upper, none), values, trans=int(transposed), check_finite=False)
    return interruptible(solve)


def exponential(matrix: np.ndarray) -> np.ndarray:
    """Return exp of a matrix, by scaling and squaring; what is too large is not a number."""

    def solve():
        try:
            with np.errstate(all="ignore"):
                # that of sparse matrices is made of numpy's products, unlike that of dense ones
                return scipy.sparse.linalg.expm(matrix)
        except (OverflowError, ValueError):
            return np.full_like(matrix, np.nan)

    return interruptible(solve)


def _require_finite(*matrices):
    if not all(np.all(np.isfinite(matrix)) for matrix in matrices):
        raise np.linalg.LinAlgError("entries are not finite")
