"""Sylvester's equation with quasi-triangular matrices, by matrix products.

LAPACK solves it column by column. Here its halves are solved, one after the other, down to small
blocks: nearly all of the work is in products. See Jonsson and Kagstrom, ACM Trans. Math. Softw. 28
(2002) 392.
"""

import numpy as np
from scipy.linalg.lapack import dtrsyl

_SMALL = 64  # chosen: blocks that LAPACK solves


def sylvester(R: np.ndarray, S: np.ndarray, C: np.ndarray) -> np.ndarray:
    """Solve R^T X + X S = C.

    Parameters
    ----------
    R, S, C : numpy.ndarray, shapes (m, m), (n, n), (m, n)
        Real. R and S are upper quasi-triangular: real Schur forms. No eigenvalue of R may be minus
        one of S.

    Returns
    -------
    numpy.ndarray, shape (m, n)
    """
    m, n = C.shape
    if max(m, n) <= _SMALL:
        found, scale, _ = dtrsyl(R, S, C, trana="T")
        return found / scale
    if m >= n:
        k = _between_blocks(R)
        above = sylvester(R[:k, :k], S, C[:k])
        return np.vstack([above, sylvester(R[k:, k:], S, C[k:] - R[:k, k:].T @ above)])
    k = _between_blocks(S)
    left = sylvester(R, S[:k, :k], C[:, :k])
    return np.hstack([left, sylvester(R, S[k:, k:], C[:, k:] - left @ S[:k, k:])])


def _between_blocks(T):
    """Return about the middle of a quasi-triangular matrix, but not within one of its blocks."""
    k = len(T) // 2
    return k + int(T[k, k - 1] != 0)
