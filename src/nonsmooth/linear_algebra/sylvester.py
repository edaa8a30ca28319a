"""Sylvester's equation A X + X B = C, by matrix products.

LAPACK solves the triangular equation that Schur's forms leave column by column, which takes more
time than the forms. Here its halves are solved, one after the other, down to small blocks: nearly
all of the work is in products. See Jonsson and Kagstrom, ACM Trans. Math. Softw. 28 (2002) 392.
"""

import numpy as np
import scipy.linalg
from scipy.linalg.lapack import dtrsyl

_SMALL = 64  # chosen: blocks that LAPACK solves


def sylvester(A: np.ndarray, B: np.ndarray, C: np.ndarray) -> np.ndarray:
    """Solve A X + X B = C.

    Parameters
    ----------
    A, B, C : numpy.ndarray, shapes (m, m), (n, n), (m, n)
        Real. No eigenvalue of A may be minus one of B.

    Returns
    -------
    numpy.ndarray, shape (m, n)
    """
    R, U = scipy.linalg.schur(A)
    S, V = scipy.linalg.schur(B.T)
    return U @ _triangular(R, S, U.T @ C @ V) @ V.T


def _triangular(R, S, C):
    """Solve R X + X S^T = C with upper quasi-triangular R and S."""
    m, n = C.shape
    if max(m, n) <= _SMALL:
        found, scale, _ = dtrsyl(R, S, C, tranb="T")
        return found / scale
    if m >= n:
        k = _between_blocks(R)
        below = _triangular(R[k:, k:], S, C[k:])
        return np.vstack([_triangular(R[:k, :k], S, C[:k] - R[:k, k:] @ below), below])
    k = _between_blocks(S)
    right = _triangular(R, S[k:, k:], C[:, k:])
    return np.hstack([_triangular(R, S[:k, :k], C[:, :k] - right @ S[:k, k:].T), right])


def _between_blocks(T):
    """Return about the middle of a quasi-triangular matrix, but not within one of its blocks."""
    k = len(T) // 2
    return k + int(T[k, k - 1] != 0)
